"""Kinematics and dynamics of the tree: against plain matrices, closed forms, and the balance of power."""

from __future__ import annotations

from pathlib import Path

import casadi
import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform

from benchmarks.dynamics import opensim_variants as variants
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.inverse_dynamics import generalised_forces
from geocontact.dynamics.symbols import constant
from geocontact.dynamics.tree import Tree, tree_of
from geocontact.io.opensim.osim_multibody import read_multibody
from tests.dynamics.models import all_kinds, pendulum

STATES = 12


def states(tree: Tree, seed: int = 1) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    n = len(tree.names)
    return rng.uniform(-1.8, 1.8, (STATES, n)), rng.normal(size=(STATES, n)), rng.normal(size=(STATES, n))


def energy(tree: Tree) -> casadi.SX:
    """Kinetic and potential, from velocities alone."""
    total = casadi.SX(0)
    for body in tree.model.bodies:
        frame = tree.bodies[body.name]
        arm = frame.rotation @ constant(body.centre)
        fast = frame.speed + casadi.cross(frame.spin, arm)
        own = frame.rotation.T @ frame.spin
        total += 0.5 * body.mass * casadi.sumsqr(fast) + 0.5 * casadi.dot(own, constant(body.inertia) @ own)
        total -= body.mass * casadi.dot(constant(tree.model.gravity), frame.place + arm)
    return total


def poses(model: Multibody, q: np.ndarray) -> dict[str, RigidTransform]:
    """By the joints' own functions, one after the other."""
    names = [c.name for c in model.coordinates]
    values = {name: np.array([value]) for name, value in zip(names, q, strict=True)}
    found = {"ground": RigidTransform.identity()}
    for joint in model.joints:
        found[joint.child] = found[joint.parent] * joint.pose(values, 1)[0]
    return found


def test_bodies_are_where_the_joints_put_them() -> None:
    tree = tree_of(all_kinds())
    frames = [x for b in tree.model.bodies for x in (tree.bodies[b.name].rotation, tree.bodies[b.name].place)]
    at = casadi.Function("at", [tree.q], frames)
    for q in states(tree)[0]:
        ours = [np.array(x) for x in at(q)]
        for i, (name, pose) in enumerate((b.name, poses(tree.model, q)[b.name]) for b in tree.model.bodies):
            np.testing.assert_allclose(ours[2 * i], pose.rotation.as_matrix(), atol=1e-13, err_msg=name)
            np.testing.assert_allclose(ours[2 * i + 1].ravel(), pose.translation, atol=1e-13, err_msg=name)


def test_spin_is_what_turns_the_frames() -> None:
    tree = tree_of(all_kinds())
    for name, frame in tree.bodies.items():
        turned = casadi.reshape(casadi.jtimes(casadi.vec(frame.rotation), tree.q, tree.u), 3, 3)
        off = casadi.Function("off", [tree.q, tree.u], [turned - casadi.skew(frame.spin) @ frame.rotation])
        moved = casadi.Function("m", [tree.q, tree.u], [casadi.jtimes(frame.place, tree.q, tree.u) - frame.speed])
        for q, u, _ in zip(*states(tree), strict=True):
            np.testing.assert_allclose(np.array(off(q, u)), 0.0, atol=1e-12, err_msg=name)
            np.testing.assert_allclose(np.array(moved(q, u)), 0.0, atol=1e-12, err_msg=name)


@pytest.mark.parametrize("seed", range(3))
def test_power_of_the_forces_is_the_change_of_energy(seed: int) -> None:
    tree = tree_of(all_kinds(seed))
    change = casadi.jtimes(energy(tree), tree.q, tree.u) + casadi.jtimes(energy(tree), tree.u, tree.a)
    power = casadi.dot(generalised_forces(tree), tree.u)
    both = casadi.Function("both", [tree.q, tree.u, tree.a], [change, power])
    for state in zip(*states(tree), strict=True):
        ours, theirs = (float(x) for x in both(*state))
        assert ours == pytest.approx(theirs, rel=1e-11, abs=1e-9)


def test_power_of_a_load_is_its_force_along_the_velocity() -> None:
    tree = tree_of(all_kinds())
    force, moment = casadi.SX([3.0, -2.0, 5.0]), casadi.SX([0.3, 0.7, -0.4])
    free, loaded = generalised_forces(tree), generalised_forces(tree, {"shank": (force, moment)})
    frame = tree.bodies["shank"]
    about = moment - casadi.cross(frame.place, force)
    done = casadi.dot(force, frame.speed) + casadi.dot(about, frame.spin)
    off = casadi.Function("off", [tree.q, tree.u, tree.a], [casadi.dot(free - loaded, tree.u) - done])
    for state in zip(*states(tree), strict=True):
        assert float(off(*state)) == pytest.approx(0.0, abs=1e-11)


def test_a_pendulum_is_the_one_of_the_textbook() -> None:
    """m l² a + m g l sin q."""
    tree = tree_of(pendulum((0.7,), (1.3,)))
    force = casadi.Function("f", [tree.q, tree.u, tree.a], [generalised_forces(tree)])
    for q, u, a in zip(*states(tree), strict=True):
        expected = 1.3 * 0.7**2 * a[0] + 1.3 * 9.81 * 0.7 * np.sin(q[0])
        assert float(force(q, u, a)) == pytest.approx(expected, abs=1e-13)


def test_a_double_pendulum_is_the_one_of_the_textbook() -> None:
    """Lagrange's equations with the second angle counted from the first rod."""
    (l1, l2), (m1, m2), g = (0.7, 0.4), (1.3, 2.1), 9.81
    tree = tree_of(pendulum((l1, l2), (m1, m2)))
    force = casadi.Function("f", [tree.q, tree.u, tree.a], [generalised_forces(tree)])
    for (q1, q2), (u1, u2), (a1, a2) in zip(*states(tree), strict=True):
        c, s = np.cos(q2), np.sin(q2)
        m22, m12 = m2 * l2**2, m2 * (l2**2 + l1 * l2 * c)
        m11 = m1 * l1**2 + m2 * (l1**2 + l2**2 + 2 * l1 * l2 * c)
        first = m11 * a1 + m12 * a2 - m2 * l1 * l2 * s * (2 * u1 * u2 + u2**2)
        first += (m1 + m2) * g * l1 * np.sin(q1) + m2 * g * l2 * np.sin(q1 + q2)
        second = m12 * a1 + m22 * a2 + m2 * l1 * l2 * s * u1**2 + m2 * g * l2 * np.sin(q1 + q2)
        found = np.array(force([q1, q2], [u1, u2], [a1, a2])).ravel()
        np.testing.assert_allclose(found, [first, second], atol=1e-12)


def test_forces_by_velocity_are_those_of_the_mass_matrix(tmp_path: Path) -> None:
    """Lagrange's equations, for a hip whose three turns and shift depend on one coordinate, where OpenSim's are not."""
    once, bent = ("h1", variants.LINE), ("h1", variants.SPLINE)
    text = variants.model(variants.custom({"h1": ""}, (once, bent, bent), (bent,)))
    (tmp_path / "hip.osim").write_text(text, encoding="utf-8")
    tree = tree_of(read_multibody(tmp_path / "hip.osim"))
    whole = generalised_forces(tree)
    momentum = casadi.jacobian(whole, tree.a) @ tree.u
    wanted = casadi.jtimes(momentum, tree.q, tree.u) - casadi.gradient(0.5 * casadi.dot(tree.u, momentum), tree.q)
    still = casadi.substitute(whole, tree.a, 0 * tree.a)
    both = casadi.Function("f", [tree.q, tree.u], [wanted, still - casadi.substitute(still, tree.u, 0 * tree.u)])
    rng = np.random.default_rng(5)
    one, other = (np.array(each) for each in both(*(rng.uniform(-0.6, 0.6, len(tree.names)) for _ in range(2))))
    np.testing.assert_allclose(other, one, atol=1e-12 * np.abs(one).max())
