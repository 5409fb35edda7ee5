"""Muscle forces of least squared activation: one and two muscles by hand, many beside another solver, contact held."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import minimize

from geocontact.dynamics.inverse_dynamics import force_across
from geocontact.dynamics.static_optimisation import LEAST, RESERVE, Contact, static_optimisation
from geocontact.dynamics.tree import tree_of
from geocontact.io.opensim.osim_multibody import read_multibody
from tests.cli.calls import MESHES

RNG = np.random.default_rng(7)


def test_two_muscles_share_a_moment_by_their_moments() -> None:
    """By Lagrange: a_i in proportion to r_i F_i; the reserve has the share 1 / (1 + Σ (r F)²), each by hand."""
    strongest, arms = np.array([1000.0, 500.0]), np.array([0.04, 0.05])
    full = arms * strongest  # N m
    found = static_optimisation(strongest, arms[None, :, None], np.array([[20.0]]))
    by_hand = 20.0 * full / (RESERVE**2 + full @ full)
    np.testing.assert_allclose(found.activations[0], by_hand, rtol=1e-9)
    assert found.missed[0, 0] == pytest.approx(20.0 / (1.0 + full @ full), rel=1e-6)


def test_a_moment_beyond_all_muscles_is_missed() -> None:
    """40 N m at full activation, and an antagonist that stays at rest: 100 less 40, and its 0.01 of 25 N m."""
    arms = np.array([[[0.04], [-0.05]]])
    found = static_optimisation(np.array([1000.0, 500.0]), arms, np.array([[100.0]]))
    np.testing.assert_allclose(found.activations[0], [1.0, LEAST], rtol=1e-9)
    assert found.missed[0, 0] == pytest.approx(100.0 - 40.0 + 0.25, rel=1e-9)


def test_a_contact_force_that_is_held_needs_the_antagonist() -> None:
    """The extensor alone presses with its 500 N; 900 N need 200 N more of both: moments of 0.04 m cancel."""
    strongest, arms = np.array([2000.0, 2000.0]), np.array([[[0.04], [-0.04]]])
    moments, net, pulls = np.array([[20.0]]), np.array([100.0]), np.ones((1, 2))
    alone = static_optimisation(strongest, arms, moments, Contact(pulls, net))
    assert alone.compression is not None
    assert alone.compression[0] == pytest.approx(100.0 + 500.0 + 2.0 * LEAST * 2000.0, abs=1.0), "the antagonist rests"
    held = static_optimisation(strongest, arms, moments, Contact(pulls, net, np.array([1000.0])))
    np.testing.assert_allclose(held.activations[0] * strongest, [700.0, 200.0], atol=0.5)
    unknown = static_optimisation(strongest, arms, moments, Contact(pulls, net, np.array([np.nan])))
    np.testing.assert_array_equal(unknown.activations, alone.activations)


def test_many_muscles_lie_where_no_step_lowers_the_cost() -> None:
    """Conditions of Karush, Kuhn and Tucker of a convex cost, its slope by hand; another solver gets no lower."""
    strongest = RNG.uniform(200.0, 3000.0, 12)
    arms, moments = 0.04 * RNG.normal(size=(3, 12, 4)), 30.0 * RNG.normal(size=(3, 4))
    pulls, net, held = RNG.uniform(0.0, 1.0, (3, 12)), np.full(3, 500.0), np.array([1500.0, 2200.0, 900.0])
    found = static_optimisation(strongest, arms, moments, Contact(pulls, net, held))

    def cost(a: np.ndarray, t: int) -> float:
        off = moments[t] - (a * strongest) @ arms[t]
        press = net[t] + pulls[t] @ (a * strongest) - held[t]
        return float(a @ a + off @ off + press**2)

    for t, a in enumerate(found.activations):
        off = moments[t] - (a * strongest) @ arms[t]
        press = net[t] + pulls[t] @ (a * strongest) - held[t]
        slope = 2.0 * (a - strongest * (arms[t] @ off) + strongest * pulls[t] * press)
        low, high = a <= LEAST * (1.0 + 1e-9), a >= 1.0 - 1e-9
        assert (slope[low] >= -1e-6).all() and (slope[high] <= 1e-6).all()
        np.testing.assert_allclose(slope[~(low | high)], 0.0, atol=1e-6)
        best = minimize(cost, np.full(12, 0.2), (t,), "SLSQP", bounds=[(LEAST, 1.0)] * 12, options={"maxiter": 900})
        assert cost(a, t) <= best.fun * (1.0 + 1e-9)


def test_the_force_across_a_joint_at_rest_is_the_weight_beyond_it() -> None:
    """Four kg of shank and one of foot hang from the knee; a body in the ground's axes."""
    tree = tree_of(read_multibody(MESHES / "leg.osim"))
    time = np.linspace(0.0, 1.0, 21)
    force, turn = force_across(tree, "tibia_r", time, np.zeros((21, len(tree.names))), time[5:8], {})
    np.testing.assert_allclose(force, np.tile([0.0, 5.0 * 9.80665, 0.0], (3, 1)), atol=0.01)
    np.testing.assert_allclose(turn, np.tile(np.eye(3), (3, 1, 1)), atol=1e-12)


def test_the_force_across_a_joint_adds_the_acceleration_of_what_it_carries() -> None:
    """The whole leg is lifted with 2 m/s²: 5 kg need 10 N more; bent joints only turn the body."""
    tree = tree_of(read_multibody(MESHES / "leg.osim"))
    time = np.linspace(0.0, 1.0, 41)
    values = np.zeros((41, len(tree.names)))
    values[:, tree.names.index("ty")] = time**2
    values[:, tree.names.index("knee")] = -0.6
    force, turn = force_across(tree, "tibia_r", time, values, time[10:12], {})
    np.testing.assert_allclose(force, np.tile([0.0, 5.0 * (9.80665 + 2.0), 0.0], (2, 1)), atol=0.02)
    axis = turn[:, :, 1]
    assert np.linalg.norm(axis, axis=1) == pytest.approx(1.0) and np.all(np.abs(axis[:, 1] - np.cos(0.6)) < 1e-9)
