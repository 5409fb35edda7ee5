"""Dynamic parameters of the exoskeleton alone, and the person's share of the torques of both."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.dynamics.tree import tree_of
from geocontact.standing_up.chain import Subject, leg_chain
from geocontact.standing_up.exoskeleton import EXO_JOINTS, coupled_chain, two_chains
from geocontact.standing_up.exoskeleton_torque import DeviceMotion, human_torque, identified, identified_from, regressor

SUBJECT = Subject()
VISCOUS, COULOMB = np.array([2.0, 3.0, 2.5]), np.array([1.5, 2.5, 2.0])


def excited(count: int = 400) -> list[np.ndarray]:
    """Angles, rates and accelerations of sums of sines."""
    time = np.linspace(0.0, 10.0, count)[:, None]
    rate = 2.0 * np.pi * np.array([[0.3, 0.5, 0.7], [0.8, 1.1, 0.4]])[:, None, :]
    size = np.array([[0.25, 0.5, 0.4], [0.1, 0.15, 0.2]])[:, None, :]
    q = (size * np.sin(rate * time)).sum(axis=0) + np.array([-0.2, 0.8, -0.6])
    return [q, (size * rate * np.cos(rate * time)).sum(axis=0), (-size * rate**2 * np.sin(rate * time)).sum(axis=0)]


def needed(model: object, names: tuple[str, ...], motion: list[np.ndarray]) -> np.ndarray:
    """Torques of a whole chain whose foot stays where it is, along some coordinates, by Newton and Euler."""
    from casadi import Function

    from geocontact.dynamics.inverse_dynamics import generalised_forces

    tree = tree_of(model)  # type: ignore[arg-type]
    at = [tree.names.index(name) for name in names]
    whole = [np.zeros((len(motion[0]), len(tree.names))) for _ in motion]
    for each, part in zip(whole, motion, strict=True):
        each[:, at] = part
    forces = Function("forces", [tree.q, tree.u, tree.a], [generalised_forces(tree)]).map(len(motion[0]))
    return np.asarray(forces(*(each.T for each in whole)).full().T[:, at])


def test_unloaded_motion_tells_torques_and_friction() -> None:
    """Bodies as they are give the torques of the chain to rounding; with noise friction is within its interval."""
    q, u, a = excited()
    exact = needed(two_chains(SUBJECT), EXO_JOINTS, [q, u, a])
    bodies = [body for body in two_chains(SUBJECT).bodies if body.name.startswith("exo_")]
    own = np.concatenate(
        [[b.mass, *(b.mass * b.centre[:2]), b.inertia[2, 2] + b.mass * b.centre @ b.centre] for b in bodies]
    )
    np.testing.assert_allclose(regressor(SUBJECT, q, u, a)[:, :, :12] @ own, exact, atol=1e-9 * np.abs(exact).max())
    motors = exact + VISCOUS * u + COULOMB * np.tanh(u / np.radians(1.0))
    noise = 0.2 * np.random.default_rng(3).normal(size=motors.shape)
    found = identified(SUBJECT, q, u, a, motors + noise)
    assert found.residual == pytest.approx(0.2, rel=0.05) and found.rank < len(found.names)
    off = found.values[12:] - np.column_stack([VISCOUS, COULOMB]).ravel()
    assert np.abs(off / found.deviations[12:]).max() < 3.0 and found.deviations[12:].max() < 0.1
    fresh = [-each for each in excited(150)]
    again = found.unloaded(*fresh) - found.friction(fresh[1])
    np.testing.assert_allclose(again, needed(two_chains(SUBJECT), EXO_JOINTS, fresh), atol=0.3)


def test_person_has_what_the_exoskeleton_leaves() -> None:
    """Both chains moving as one: coupled torques less those of the exoskeleton alone are those of the person alone."""
    motion = excited(60)
    names = ("ankle", "knee", "hip")
    coupled = coupled_chain(SUBJECT)
    assert sum(b.mass for b in coupled.bodies) == pytest.approx(two_chains(SUBJECT).mass, rel=1e-12)
    together = needed(coupled, names, motion)
    alone, device = needed(leg_chain(SUBJECT), names, motion), needed(two_chains(SUBJECT), EXO_JOINTS, motion)
    off = human_torque(together, device) - alone
    # the exoskeleton's knee is higher, which moves the torque of what is above it from one hinge to another
    above = 9.0 * (9.81 + np.abs(motion[2]).max() * 1.5 + np.abs(motion[1]).max() ** 2 * 1.5)
    assert np.abs(off).max() < SUBJECT.device.knee_above * above, np.abs(off).max()


def test_friction_comes_back_through_the_filter() -> None:
    """A slow motion at 100 Hz, a cut-off of 6 Hz on both sides: within three deviations; intervals are 1.96 of them."""
    time = np.linspace(0.0, 10.0, 1001)
    q, u, a = excited(1001)
    motors = needed(two_chains(SUBJECT), EXO_JOINTS, [q, u, a]) + VISCOUS * u + COULOMB * np.tanh(u / np.radians(1.0))
    noise = 0.2 * np.random.default_rng(3).normal(size=motors.shape)
    motion = DeviceMotion.smoothed(time, q, motors + noise, 6.0)
    assert motion.step == pytest.approx(0.01) and motion.independent(6.0) == pytest.approx(0.12)
    inner = motion.inner(6.0)
    assert inner.sum() == pytest.approx(1001 - 2 * 100 / 6.0, abs=2.0) and not inner[0]
    np.testing.assert_allclose(motion.a[inner], a[inner], atol=0.05 * np.abs(a).max())
    found = identified_from(SUBJECT, motion, 6.0)
    off = found.values[12:] - np.column_stack([VISCOUS, COULOMB]).ravel()
    assert np.abs(off).max() < 0.3 and found.alone[12:].all()
    low, high = found.intervals(0.95)
    np.testing.assert_allclose((high - low)[12:], 2.0 * 1.95996 * found.deviations[12:], rtol=1e-5)
    assert np.isnan(low[~found.alone]).all()
    left = motion.smooth(motors + noise, 6.0) - found.friction(motion.u)
    np.testing.assert_array_equal(found.in_trial(motion, 6.0), left)
