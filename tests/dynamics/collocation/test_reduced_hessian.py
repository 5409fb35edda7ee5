"""How sharply a cost tells its parameters, against a linear-quadratic problem in closed form."""

from __future__ import annotations

import numpy as np
import pytest
from casadi import SX, vertcat

from geocontact.dynamics.collocation.optimality import inverse_reduced_hessian, optimality_system
from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.solve import SolverOptions, solve
from geocontact.dynamics.collocation.transcription import Transcription, scales_from
from tests.dynamics.collocation.closed_problems import system, trial

R, T = 0.3, 1.5


def drift(prior: float = 0.0, held: bool = False) -> ControlProblem:
    """x' = p + u from 0, least integral of (x - d)^2 + R u^2, and a second parameter that only its prior knows.

    With r x'' = x the least cost is p^2 (R T - R^1.5 tanh(T / sqrt R)) for d = 0; d moves the minimum only.
    """
    x, u, p = SX.sym("x"), SX.sym("u"), SX.sym("p", 2)
    one = system(x, u, p[0] + u, cost=(x - 0.4) ** 2 + R * u**2, p=p, prior=prior * p[1] ** 2)
    wide = np.array([5.0, 0.0 if held else 5.0])
    return ControlProblem(one, (trial([0.0], [np.nan], (T, T), [0.0]),), (-wide, wide), np.zeros(2))


def test_curvature_is_that_of_the_closed_form() -> None:
    problem = drift(prior=7.0)
    found = solve(problem, SolverOptions("radau", 4, 12, 1e-12))
    inverse = inverse_reduced_hessian(problem, found)
    curvature = 2.0 * (R * T - R**1.5 * np.tanh(T / np.sqrt(R)))
    np.testing.assert_allclose(inverse, np.diag([1.0 / curvature, 1.0 / 14.0]), rtol=1e-7, atol=1e-9)


def test_held_parameters_do_not_count_and_untold_ones_are_refused() -> None:
    fixed, untold = drift(held=True), drift()
    options = SolverOptions("radau", 3, 6)
    found = solve(fixed, options)
    inverse = inverse_reduced_hessian(fixed, found)
    assert inverse[0, 0] > 0.0 and (inverse[1] == 0.0).all()
    both = solve(untold, options)
    assert inverse_reduced_hessian(untold, both, (False, True))[0, 0] == pytest.approx(inverse[0, 0], rel=1e-9)
    with pytest.raises(ValueError, match="not identified"):
        inverse_reduced_hessian(untold, both)


def two_moves(p: tuple[float, float] | None = None) -> ControlProblem:
    """x'' = (1 + p0) u - p1 x' from rest to rest, twice, in times that are sought; u counts with its fourth power too.

    Parameters are sought by default.
    """
    x, u, q, T = SX.sym("x", 2), SX.sym("u"), SX.sym("p", 2), SX.sym("T")
    rate = vertcat(x[1], (1.0 + q[0]) * u - q[1] * x[1])
    prior = 3.0 * (q[0] - 0.1) ** 2 + (q[1] - 0.4) ** 2
    cost = 1.0 + u**2 + 0.1 * u**4 + 0.2 * q[0] * x[1] ** 2
    one = system(x, u, rate, cost=cost, p=q, prior=prior, duration=T)
    trials = tuple(trial([0, 0], [far, 0], (0.3, 6.0), [0.5]) for far in (1.0, 2.5))
    wide = np.array([0.5, 0.9])
    bounds = (-wide, wide) if p is None else (np.array(p), np.array(p))
    return ControlProblem(one, trials, bounds, np.array([0.1, 0.4]) if p is None else np.array(p))


EXACT = SolverOptions("radau", 3, 5, 1e-12)


def test_variables_of_a_motion_are_its_own_again() -> None:
    """Radau's last point lies where the next interval begins, whose control is another."""
    problem = two_moves()
    found = solve(problem, EXACT)
    on = Transcription(problem, found.motions[0].scheme, found.meshes, scales_from(problem))
    p, motions = on.unpacked(on.again(found.p, found.motions))
    np.testing.assert_array_equal(p, found.p)
    for one, other in zip(motions, found.motions, strict=True):
        np.testing.assert_allclose(one.controls, other.controls, rtol=1e-14, atol=1e-14)
        np.testing.assert_allclose(one.states, other.states, rtol=1e-14, atol=1e-14)
    at_end = found.motions[0].controls[:-1, -1] - found.motions[0].control(found.motions[0].breaks[1:-1])
    assert np.abs(at_end).max() > 1e-4


def test_curvature_with_free_times_and_two_trials_is_that_of_problems_solved_again() -> None:
    problem, h = two_moves(), 1e-3
    found = solve(problem, EXACT)
    inverse = inverse_reduced_hessian(problem, found)

    def least(*by: float) -> float:
        return solve(two_moves((found.p[0] + by[0], found.p[1] + by[1])), EXACT, warm=found).objective

    middle, corners = least(0.0, 0.0), [[least(a, b) for b in (-h, h)] for a in (-h, h)]
    twice = [(least(*by) + least(*(-x for x in by)) - 2.0 * middle) / h**2 for by in ((h, 0.0), (0.0, h))]
    mixed = (corners[0][0] + corners[1][1] - corners[0][1] - corners[1][0]) / (4.0 * h**2)
    again = np.array([[twice[0], mixed], [mixed, twice[1]]])
    assert all(motion.breaks[-1] > 1.0 for motion in found.motions)
    np.testing.assert_allclose(np.linalg.inv(inverse), again, rtol=2e-4, atol=1e-4)


def test_banded_order_gives_the_answer_of_a_dense_factorisation() -> None:
    """Two trials, sought durations, parameters among what moves or not."""
    problem = two_moves()
    found = solve(problem, EXACT)
    kkt = optimality_system(problem, found)
    for with_parameters in (True, False):
        moves = np.ones(kkt.on.size, bool)
        low, high = kkt.on.bounds()
        moves &= low < high
        moves[: kkt.on.np] &= with_parameters
        hessian, slope = kkt.hessian.toarray()[np.ix_(moves, moves)], kkt.slope.toarray()[:, moves]
        whole = np.block([[hessian, slope.T], [slope, np.zeros((len(slope), len(slope)))]])
        right = np.random.default_rng(2).normal(size=(len(whole), 3))
        np.testing.assert_allclose(kkt.solved(moves, right), np.linalg.solve(whole, right), rtol=1e-7, atol=1e-7)
