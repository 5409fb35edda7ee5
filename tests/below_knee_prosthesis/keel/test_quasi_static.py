"""The keel without inertia against the tree's equations, the elastica, and differences of its own torques."""

from __future__ import annotations

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.balance_kernel import balance
from geocontact.below_knee_prosthesis.keel.keel import elastica
from geocontact.below_knee_prosthesis.keel.on_tree import (
    along_keel,
    coordinates,
    joint_numbers,
    keel_bodies,
    sole_wrenches,
)
from geocontact.below_knee_prosthesis.keel.quasi_static import OUTPUTS, QuasiStaticKeel
from geocontact.below_knee_prosthesis.keel.sole import KeelSole, law_of, sole_of
from geocontact.below_knee_prosthesis.keel.vsf import vsf_keel
from geocontact.contact.sphere_foot import normal_force
from geocontact.data.multibody.joint import free
from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.dynamics.equations import Equations, equations_of_motion
from geocontact.dynamics.tree import tree_of
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.resultant import pose_rate
from geocontact.loads.sphere_set import SoleLaw, SphereSet, sphere_loads

FULCRUM, SLOPE = 0.1, HalfSpace((0.0, 0.002, 0.0), (0.05, 1.0, -0.03))
GRAVITY = np.array([0.3, -9.7, 0.2])
AT = RigidTransform.identity()


def foot(*, torsion: bool = True) -> QuasiStaticKeel:
    keel = replace(vsf_keel(), twists=torsion)
    sole = sole_of(keel)
    return QuasiStaticKeel(keel, FULCRUM, sole, law_of(sole))


def on_tip(joints: int, series: float = 1e9) -> QuasiStaticKeel:
    """A plate that presses on the tip through a spring."""
    keel = vsf_keel(joints=joints)
    tip = SphereSet(np.array([[keel.length, 0.0, 0.0]]), np.array([1e-9]), ("tip",))
    law = SoleLaw(np.array([series]), np.zeros(1), 1.0, 1e-3, np.zeros(1), np.zeros(1), 0.01)
    return QuasiStaticKeel(keel, 0.066, KeelSole(tip, (joints,)), law)


def state(rng: np.random.Generator) -> dict[str, Any]:
    """Of a foot that presses and slides on a slope."""
    n = np.array(SLOPE.normal) / np.linalg.norm(SLOPE.normal)
    return {
        "y": rng.normal(0.0, 0.04, 9),
        "before": rng.normal(0.0, 0.04, 9),
        "per_time": 3.0,
        "plane": np.append(n, 0.027),
        "twist": rng.normal(0.0, 0.3, 6) - np.array([0.0, 0.0, 0.0, 0.0, 0.5, 0.0]),
        "gravity": GRAVITY,
    }


def torques(one: QuasiStaticKeel, at: dict[str, Any]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    torque, slope, outputs = np.empty(9), np.empty((9, 9)), np.empty((24, OUTPUTS))
    springs, *arrays = one.arrays(static=False, falling=True)
    balance(
        at["y"],
        at["before"],
        at["per_time"],
        springs,
        np.stack([at["before"], np.linspace(-0.9, 0.9, 9)]),
        *arrays,
        np.repeat(at["plane"][None], 24, axis=0),
        at["twist"],
        at["gravity"],
        torque,
        slope,
        outputs,
    )
    return torque, slope, outputs


@pytest.mark.parametrize("seed", range(5))
def test_derivatives_are_exact(seed: int) -> None:
    one, at, step = foot(), state(np.random.default_rng(seed)), 1e-7
    one = replace(one, keel=replace(one.keel, hysteresis=0.2, friction=0.03))
    _, slope, outputs = torques(one, at)
    assert ((outputs[:, 0] > 0.0) & (outputs[:, 1] > 0.0)).sum() >= 4
    differences = []
    for unit in np.eye(9):
        ends = [torques(one, at | {"y": at["y"] + sign * step * unit})[0] for sign in (1.0, -1.0)]
        differences.append((ends[0] - ends[1]) / (2.0 * step))
    assert np.abs(np.array(differences).T - slope).max() < 1e-6 * np.abs(slope).max()


@lru_cache(maxsize=1)
def equations() -> Equations:
    """The same chain as a tree on a foot that is prescribed; segments weigh nothing."""
    one = foot()
    keel = replace(one.keel, density=1e-9)
    bodies, joints = keel_bodies(keel, "foot", AT)
    whole = (Body("foot", 1.0, np.zeros(3), np.eye(3)), *bodies)
    tree = tree_of(Multibody("keel", whole, (free("root", GROUND, "foot"), *joints), (), GRAVITY))
    names = coordinates(keel)
    return equations_of_motion(
        tree,
        loads=sole_wrenches(tree, "foot", AT, keel, one.sole, one.law, SLOPE),
        along=along_keel(tree, names, *(np.asarray(each) for each in joint_numbers(keel, FULCRUM))),
        prescribed=[name for name in tree.names if name.startswith("root")],
    )


def test_torques_are_those_of_the_tree() -> None:
    """One frame of a moving foot, its twist by hand from the rates of the tree's root."""
    from casadi import DM, Function

    e, rng = equations(), np.random.default_rng(4)
    assert e.names[0] == "keel_torsion"
    torque_of = Function("torque", [e.q, e.u, e.w], [e.force])
    turn, shift = rng.normal(0.0, 0.1, 3), np.array([0.1, 0.018, 0.02])
    turn_rate, speed = rng.normal(0.0, 0.5, 3), rng.normal(0.0, 0.2, 3)
    R = Rotation.from_euler("XYZ", turn)
    step = 1e-6
    ends = [Rotation.from_euler("XYZ", turn + sign * step * turn_rate).as_matrix() for sign in (1.0, -1.0)]
    spin = R.as_matrix().T @ (ends[0] - ends[1]) / (2.0 * step)
    n = np.array(SLOPE.normal) / np.linalg.norm(SLOPE.normal)
    at = state(rng) | {
        "plane": np.append(R.inv().apply(n), (shift - np.array(SLOPE.point)) @ n),
        "twist": np.concatenate([[spin[2, 1], spin[0, 2], spin[1, 0]], R.inv().apply(speed)]),
        "gravity": np.zeros(3),
    }
    found, _, outputs = torques(foot(), at)
    assert (outputs[:, 0] > 0.0).sum() >= 4
    w = np.concatenate([turn, shift, turn_rate, speed, np.zeros(6)])
    wanted = np.array(torque_of(DM(at["y"]), DM(at["per_time"] * (at["y"] - at["before"])), DM(w))).ravel()
    assert found == pytest.approx(wanted, rel=1e-6, abs=1e-5)


def test_tip_converges_to_the_elastica_at_second_order() -> None:
    """400 N bend the softest keel by 35 mm and 0.24 rad; the plate is where the elastica's tip is."""
    counts, force, error = np.array([8, 16, 32, 64, 128]), 400.0, []
    keel = vsf_keel()
    deep = elastica(keel, 0.066, force)
    for joints in counts:
        pose = RigidTransform.from_translation([[0.0, -deep.y[-1] - force / 1e9, 0.0]])
        found = on_tip(int(joints)).solve(pose, HalfSpace(), gravity=(0.0, 0.0, 0.0))
        error.append(abs(found.force[0, 1] / force - 1.0))
    assert error[0] < 2e-4
    assert -np.polyfit(np.log(counts[1:]), np.log(error[1:]), 1)[0] == pytest.approx(2.0, abs=0.2), error


@pytest.mark.parametrize(("load", "deflection"), [(1.0, 0.30172), (2.0, 0.49346), (10.0, 0.81061)])
def test_elastica_is_bisshopps_and_druckers(load: float, deflection: float) -> None:
    """Their cantilever: F a²/EI against y/a, here with a root that hardly turns."""
    keel = replace(vsf_keel(), range=(1e-9, 0.1))
    found = elastica(keel, 1e-9, load * keel.bending / keel.length**2)
    assert found.y[-1] / keel.length == pytest.approx(deflection, abs=1e-5)


def test_loads_are_those_of_a_rigid_foot_where_the_keel_is_stiff() -> None:
    one = foot(torsion=False)
    stiff = replace(one, keel=replace(one.keel, bending=1e9))
    time = np.linspace(0.0, 0.1, 21)
    tilt = Rotation.from_euler("z", 0.1 - 2.0 * time[:, None])
    poses = RigidTransform.from_components(np.stack([time, 0.027 + 0.0 * time, 0.0 * time], axis=1), tilt)
    rate = pose_rate(time, poses)
    found = stiff.solve(poses, HalfSpace(), rate=rate, time=time, gravity=(0.0, 0.0, 0.0))
    wanted = sphere_loads(one.sole.spheres, one.law, poses, rate, HalfSpace())
    assert wanted.pressing.max() > 10.0
    assert found.loads.force == pytest.approx(wanted.force, rel=1e-3, abs=1e-2)
    assert found.loads.point == pytest.approx(wanted.point, abs=1e-6, nan_ok=True)
    # and the law holds between what is told
    again = normal_force(
        found.loads.depth, found.rate, one.law.stiffness, one.law.exponent, one.law.damping, one.law.full_depth
    )
    assert again == pytest.approx(found.loads.pressing, rel=1e-12)


def test_static_frames_do_not_know_each_other() -> None:
    one = foot()
    tilt = Rotation.from_euler("z", np.radians([[-5.0], [-20.0], [0.0]]))
    poses = RigidTransform.from_components(np.array([[0, 0.035, 0], [0, 0.075, 0], [0, 0.02, 0]], float), tilt)
    forwards = one.solve(poses, HalfSpace()).force
    backwards = one.solve(poses[::-1], HalfSpace()).force
    assert forwards == pytest.approx(backwards[::-1], rel=1e-8)
    assert forwards[:, 1].min() > 100.0
