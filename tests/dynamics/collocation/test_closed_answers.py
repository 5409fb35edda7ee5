"""Collocation on problems with closed answers: orders of convergence, derivatives, refinement, how a search ends."""

from __future__ import annotations

import os
import signal
from dataclasses import replace

import numpy as np
import pytest
from casadi import SX, sin

from geocontact.data.errors import InputError
from geocontact.dynamics.collocation.blocks import sparse_program
from geocontact.dynamics.collocation.motion import scheme
from geocontact.dynamics.collocation.multipliers import carried
from geocontact.dynamics.collocation.problem import ControlProblem
from geocontact.dynamics.collocation.solve import SolverOptions, solve
from geocontact.dynamics.collocation.transcription import Transcription, scales_from
from tests.dynamics.collocation.closed_problems import (
    brachistochrone,
    cycloid_time,
    exponential,
    move_to_rest,
    quickest_move,
    system,
    trial,
)


@pytest.mark.parametrize(("kind", "degree", "order"), [("radau", 2, 3), ("legendre", 2, 4), ("radau", 3, 5)])
def test_order_at_the_nodes(kind: str, degree: int, order: int) -> None:
    """A linear system with a quadratic cost: errors fall with 2 d (Legendre) and 2 d - 1 (Radau)."""
    problem, exact = exponential()
    errors = []
    for count in (2, 4, 8):
        found = solve(problem, SolverOptions(kind, degree, count, 1e-12))
        assert found.solved, found.ending
        errors.append(abs(found.motions[0].end[0] - exact))
    found = np.log2(errors[:-1]) - np.log2(errors[1:])
    assert found[-1] == pytest.approx(order, abs=0.3), (found, errors)


@pytest.mark.parametrize(("kind", "order"), [("radau", 3), ("legendre", 4)])
def test_order_of_the_brachistochrone_s_time(kind: str, order: int) -> None:
    errors = []
    for count in (4, 8):
        found = solve(brachistochrone(), SolverOptions(kind, 2, count, 1e-11))
        assert found.solved, found.ending
        errors.append(abs(found.objective - cycloid_time()))
    assert np.log2(errors[0] / errors[1]) > order - 0.3, errors


def test_what_is_a_polynomial_is_exact() -> None:
    """The move to rest is a cubic: one interval of degree 3 has it everywhere."""
    for kind in ("radau", "legendre"):
        found = solve(move_to_rest(), SolverOptions(kind, 3, 1, 1e-11))
        t = np.linspace(0.0, 1.0, 11)
        np.testing.assert_allclose(found.motions[0].state(t)[:, 0], 3 * t**2 - 2 * t**3, atol=1e-9)
        np.testing.assert_allclose(found.motions[0].control(t)[:, 0], 6 - 12 * t, atol=1e-7)
        assert found.objective == pytest.approx(6.0, abs=1e-9)


def test_quickest_move_takes_two_seconds() -> None:
    found = solve(quickest_move(), SolverOptions(intervals=10))
    assert found.objective == pytest.approx(2.0, abs=1e-6)
    push = found.motions[0].control(np.array([0.3, 0.9, 1.1, 1.7]))
    np.testing.assert_allclose(push[:, 0], [1, 1, -1, -1], atol=1e-4)


def shared_parameter() -> ControlProblem:
    """Two trials of x' = p sin(x) + u w + p x^2 with a path that a second control makes up for, p shared."""
    x, u, p, w = SX.sym("x"), SX.sym("u", 2), SX.sym("p", 2), SX.sym("w")
    rate = p[0] * sin(x) + u[0] * w + p[1] * x * x
    path = u[1] - p[0] * x * u[0] + w
    one = system(x, u, rate, cost=u[0] ** 4 + x * x * p[1] + u[1] ** 2, p=p, w=w, path=path, path_at_start=(0,))
    one = replace(one, prior=(p[0] - 1) ** 4 + p[1] ** 2, end_cost=x**4 * p[0] * one.duration)
    bare = [trial([s], [np.nan], (d, d), [0.3, 0.1]) for s, d in ((1, 1.0), (2, 0.7))]
    each = [replace(one_trial, inputs=lambda t: np.cos(t)[:, None]) for one_trial in bare]
    return ControlProblem(one, tuple(each), (np.full(2, -9.0), np.full(2, 9.0)), np.array([2.0, 0.5]))


def test_gradient_and_hessian_against_differences() -> None:
    """With shared parameters, inputs, a path and a duration among the variables; values beside them are the values."""
    problem = shared_parameter()
    meshes = np.array([0.0, 0.3, 1.0]), np.array([0.0, 0.5, 0.6, 1.0])
    on = Transcription(problem, scheme("radau", 2), meshes, scales_from(problem), by_all=True)
    program = sparse_program(on.blocks(), on.size)
    rng = np.random.default_rng(0)
    z, weights, h = on.guess() + 0.1 * rng.normal(size=on.size), rng.normal(size=len(program.lower)), 1e-5

    def lagrangian_slope(at: np.ndarray) -> np.ndarray:
        slope = np.array(program.gradient(at, [])[1]).ravel()
        return 0.7 * slope + np.array(program.jacobian(at, [])[1]).T @ weights

    value = lambda at: np.r_[tuple(np.array(each).ravel() for each in program.value(at, []))]  # noqa: E731
    cost, constraints = value(z)[0], value(z)[1:]
    assert float(program.gradient(z, [])[0]) == pytest.approx(cost, rel=1e-12)
    np.testing.assert_allclose(np.array(program.jacobian(z, [])[0]).ravel(), constraints, rtol=1e-12, atol=1e-12)
    steps = h * np.eye(on.size)
    rows = np.array([(value(z + s) - value(z - s)) / (2 * h) for s in steps]).T
    np.testing.assert_allclose(np.array(program.gradient(z, [])[1]).ravel(), rows[0], atol=1e-8)
    np.testing.assert_allclose(np.array(program.jacobian(z, [])[1]), rows[1:], atol=1e-8)
    curves = np.array([(lagrangian_slope(z + s) - lagrangian_slope(z - s)) / (2 * h) for s in steps])
    upper = np.array(program.hessian(z, [], 0.7, weights).full())
    assert not np.tril(upper, -1).any()
    np.testing.assert_allclose(upper + np.triu(upper, 1).T, curves, atol=1e-7)


def test_a_search_derives_by_what_it_moves_alone() -> None:
    """Without entries of a parameter and of durations that are given; all others as with them."""
    whole = shared_parameter()
    problem = replace(whole, p=(np.array([-9.0, 0.5]), np.array([9.0, 0.5])))
    meshes, points = (np.array([0.0, 0.3, 1.0]), np.array([0.0, 1.0])), scheme("radau", 2)
    every, on = (
        Transcription(problem, points, meshes, scales_from(problem), by_all=by_all) for by_all in (True, False)
    )
    low, high = on.bounds()
    held = np.r_[1, on.first[:-1]]  # the second parameter and both durations; first states are given too
    moves = ~np.isin(np.arange(on.size), held)
    assert (low[held] == high[held]).all()
    z = on.guess() + 0.1 * np.random.default_rng(0).normal(size=on.size)
    derived = []
    for each in (every, on):
        program = sparse_program(each.blocks(), each.size)
        weights = np.linspace(-1.0, 1.0, len(program.lower))
        slopes = np.array(program.gradient(z, [])[1]).ravel(), program.jacobian(z, [])[1].full()
        derived.append((*slopes, program.hessian(z, [], 0.7, weights).full()))
    (slope, rows, curves), (by_few, rows_of_few, curves_of_few) = derived
    np.testing.assert_allclose(by_few, np.where(moves, slope, 0.0))
    np.testing.assert_allclose(rows_of_few, np.where(moves, rows, 0.0))
    np.testing.assert_allclose(curves_of_few, np.where(np.outer(moves, moves), curves, 0.0))
    assert np.abs(rows[:, held]).max() > 0.1 and np.abs(slope[held]).max() > 0.1


def test_multipliers_carried_to_a_finer_mesh_are_nearly_its_own() -> None:
    """Two trials, a path, parameters: as good as sought anew, and nearer by the order than a mesh twice as coarse."""
    problem = shared_parameter()
    off = []
    for count in (3, 6):
        coarse = tuple(np.linspace(0.0, 1.0, count + 1) ** power for power in (1.0, 1.2))
        options = SolverOptions("radau", 3, tolerance=1e-11)
        found = solve(problem, options, meshes=coarse)
        fine = tuple(np.sort(np.r_[mesh, 0.5 * (mesh[:-1] + mesh[1:])[::2]]) for mesh in coarse)
        again = solve(problem, options, meshes=fine, warm=found)
        assert found.solved and again.solved
        on = Transcription(problem, scheme("radau", 3), fine, scales_from(problem))
        bounds, rows = carried(on, found.meshes, found.multipliers)
        assert bounds.shape == (on.size,) and rows.shape == again.multipliers[1].shape
        off.append(np.abs(rows - again.multipliers[1]).max() / np.abs(rows).max())
    assert off[1] < 0.01 and off[1] < 0.3 * off[0], off


def test_multipliers_of_bounds_stay_where_intervals_do() -> None:
    """The quickest move: full ahead on all intervals of the first half, of which one is cut."""
    problem = quickest_move()
    found = solve(problem, SolverOptions("radau", 2, 4))
    on = Transcription(problem, scheme("radau", 2), (np.array([0, 0.125, 0.25, 0.5, 0.75, 1]),), scales_from(problem))
    bounds = carried(on, found.meshes, found.multipliers)[0]
    pushes = lambda of, m: of[1:-2].reshape(m, 8)[:, [4, 7]]  # noqa: E731
    before, after = pushes(found.multipliers[0], 4), pushes(bounds, 5)
    assert np.abs(before).min() > 1e-3
    np.testing.assert_array_equal(after[2:], before[1:])
    assert not after[:2].any() and bounds[0] == found.multipliers[0][0]


def test_refinement_halves_where_the_residual_is() -> None:
    """Three intervals of degree 2 leave a residual between their points; halving follows it."""
    options = SolverOptions(degree=2, intervals=3, refinements=3, residual=1e-6)
    problem, exact = exponential()
    coarse, fine = solve(problem, replace(options, refinements=0)), solve(problem, options)
    assert len(fine.meshes[0]) > len(coarse.meshes[0])
    assert abs(fine.motions[0].end[0] - exact) < 0.02 * abs(coarse.motions[0].end[0] - exact)


def test_a_warm_start_takes_fewer_iterations() -> None:
    cold = solve(brachistochrone(), SolverOptions(intervals=10))
    again = solve(brachistochrone(), SolverOptions(intervals=10), warm=cold)
    assert again.solved and again.iterations < cold.iterations / 2, (cold.iterations, again.iterations)
    assert again.objective == pytest.approx(cold.objective, rel=1e-7)


def test_ctrl_c_keeps_the_last_iterate() -> None:
    told = []

    def progress(iteration: int, objective: float, violation: float) -> None:
        told.append((iteration, objective, violation))
        if iteration == 3:
            os.kill(os.getpid(), signal.SIGINT)

    before = signal.getsignal(signal.SIGINT)
    found = solve(brachistochrone(), SolverOptions(intervals=10), progress=progress)
    assert not found.solved and "interrupted" in found.ending
    assert 4 <= len(told) <= 6 and found.objective == pytest.approx(told[-1][1]) and found.violation > 0.0
    assert signal.getsignal(signal.SIGINT) is before


def test_how_a_search_ends_is_said_in_words() -> None:
    late = solve(brachistochrone(), SolverOptions(intervals=40, seconds=1e-3))
    few = solve(brachistochrone(), SolverOptions(iterations=2))
    problem = quickest_move()
    short = replace(problem, trials=(replace(problem.trials[0], duration=(1.0, 1.0)),))
    never = solve(short, SolverOptions(intervals=5))
    assert (late.ending, few.ending) == ("out of time", "out of iterations")
    assert not never.solved and "constraints" in never.ending, never.ending


def test_a_search_that_only_rounding_keeps_from_its_tolerance_is_solved() -> None:
    """A last state drawn to 0.3 by 1e9: its digits alone leave 1e-8 of the Lagrangian's slope."""
    problem = shared_parameter()
    s = problem.system
    drawn = replace(problem, system=replace(s, end_cost=1e9 * (s.x - 0.3) ** 2))
    found = solve(drawn, SolverOptions("radau", 2, 6, 1e-10))
    assert found.solved and "digits" in found.ending, found.ending
    held = [replace(one, end=(np.array([0.3]), np.array([0.3]))) for one in problem.trials]
    ended = replace(problem, system=replace(s, end_cost=SX(0)), trials=tuple(held))
    ended = solve(ended, SolverOptions("radau", 2, 6), warm=found)
    np.testing.assert_allclose(found.p, ended.p, rtol=1e-6)
    on = Transcription(drawn, scheme("radau", 2), found.meshes, scales_from(problem))
    program, z = sparse_program(on.blocks(), on.size), on.again(found.p, found.motions)
    beside = z * (1.0 + 1e-12 * np.random.default_rng(0).uniform(-1.0, 1.0, on.size))
    of_bounds, of_rows = found.multipliers
    assert program.at_minimum(z, of_bounds, of_rows, on.bounds(), 1e-10)
    assert not program.at_minimum(beside, of_bounds, of_rows, on.bounds(), 1e-10)
    assert program.at_minimum(beside, of_bounds, of_rows, on.bounds(), 1.0)
    low, high = on.bounds()
    pushed = of_bounds + 1e-3 * (np.arange(on.size) == 0)  # a parameter that is nowhere near its bounds
    assert not program.at_minimum(z, pushed, of_rows, (low, high), 1e-10)
    missed = replace(program, lower=program.lower + 1e-6, upper=program.upper + 1e-6)
    assert not missed.at_minimum(z, of_bounds, of_rows, (low, high), 1e-10)


def test_problems_that_cannot_be_meant_are_refused() -> None:
    problem = quickest_move()
    one = problem.trials[0]
    wrong = {
        "trial u0: the search starts at 7": replace(one, guess_u=lambda t: np.full((len(t), 1), 7.0)),
        "trial x0: the search starts at no number": replace(one, guess_x=lambda t: np.full((len(t), 2), np.nan)),
        "trial end x1: no room between 3 and 2": replace(one, end=(np.array([0.0, 3.0]), np.array([0.0, 2.0]))),
        "trial duration: 2 to 1 s is not a time": replace(one, duration=(2.0, 1.0)),
    }
    for words, each in wrong.items():
        with pytest.raises(InputError, match=words):
            solve(replace(problem, trials=(each,)))
    with pytest.raises(ValueError, match="not lobatto of degree 3"):
        solve(problem, SolverOptions(kind="lobatto"))
