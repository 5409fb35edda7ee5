"""The certificate: it passes what holds between its points, fails what does not, and knows how fast errors grow."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from casadi import SX, Function
from scipy.integrate import solve_ivp
from scipy.linalg import expm

from geocontact.dynamics.collocation import certificate as certifying
from geocontact.dynamics.collocation import solve as solving
from geocontact.dynamics.collocation import transcription
from geocontact.dynamics.collocation.blocks import BlockFunctions, block_functions
from geocontact.dynamics.collocation.certificate import (
    Certificate,
    CertificateLimits,
    certificate,
    fine_residual,
    residuals,
    resimulation,
)
from geocontact.dynamics.collocation.motion import MotionSamples
from geocontact.dynamics.collocation.multibody import jerk_controlled
from geocontact.dynamics.collocation.problem import ControlledTrial, ControlProblem
from geocontact.dynamics.collocation.solve import (
    MOST_HALVINGS,
    ROUGH,
    CollocationResult,
    SolverOptions,
    halved,
    refined,
    rough,
    solve,
)
from geocontact.dynamics.equations import equations_of_motion
from geocontact.dynamics.simulate import Stepper
from geocontact.dynamics.tree import tree_of
from tests.dynamics.models import pendulum

LENGTHS, MASSES, SECONDS = (0.4, 0.5), (2.0, 1.0), 0.8
WIDE = 1e3


def swing(end: tuple[float, float]) -> tuple[ControlProblem, Stepper]:
    """Two links under two torques, from hanging rest to rest elsewhere, with the least integral of torque squared."""
    tree, torque = tree_of(pendulum(LENGTHS, MASSES)), SX.sym("torque", 2)
    equations = equations_of_motion(tree, along={"q0": torque[0], "q1": torque[1]}, inputs=[torque])
    jerk = SX.sym("jerk", 2)
    cost = torque.T @ torque + 1e-4 * jerk.T @ jerk
    system = jerk_controlled(equations, controlled=(0, 1), control_names=("t0", "t1"), jerk=jerk, cost=cost)
    at, to = np.zeros(6), np.r_[end, np.zeros(4)]
    free = np.r_[np.zeros(4), np.full(2, WIDE)]
    trial = ControlledTrial(
        "swing",
        0.0,
        (SECONDS, SECONDS),
        (np.full(6, -WIDE), np.full(6, WIDE)),
        (np.full(4, -1e6), np.full(4, 1e6)),
        (at - free, at + free),
        (to - free, to + free),
        lambda t: np.outer(t / SECONDS, to),
        lambda t: np.ones((len(t), 4)),
    )
    return ControlProblem(system, (trial,)), Stepper(equations)


def judged(problem: ControlProblem, stepper: Stepper, found: CollocationResult) -> Certificate:
    trial = problem.trials[0]
    again = resimulation(stepper, found.motions[0], found.p, trial.inputs, (0, 1))
    return certificate(found.solved, problem.system, trial, again, (True, True))


@pytest.fixture(scope="module")
def swung() -> tuple[ControlProblem, Stepper]:
    return swing((1.5, -0.7))


@pytest.mark.parametrize("kind", ["radau", "legendre"])
def test_a_solution_on_a_fine_mesh_passes(swung, kind: str) -> None:
    found = solve(swung[0], SolverOptions(kind, 4, 10))
    seen = judged(*swung, found)
    assert seen.converged, seen
    assert seen.moment < 0.05 and seen.interval < 1e-5 and seen.open_loop < 1e-4, seen


def test_a_coarse_mesh_fails_although_the_solver_is_content(swung) -> None:
    found = solve(swung[0], SolverOptions("radau", 3, 2))
    seen = judged(*swung, found)
    assert found.solved and found.violation < 1e-7
    assert not seen.converged and any("residual" in words for words in seen.failed), seen


def left_at(stepper: Stepper, found: CollocationResult, where: np.ndarray) -> np.ndarray:
    """Largest of the balance [N m] at parts of every interval, (m, s), by polynomials that NumPy puts through the
    points, with the acceleration as the state has it and as the derivative of the rate.
    """
    motion, e = found.motions[0], stepper.equations
    balance = Function("balance", [e.q, e.u, e.a, e.w], [e.balance])
    points, sizes = motion.scheme.points, []
    for x, u, length in zip(motion.states, motion.controls, np.diff(motion.breaks), strict=True):
        states = [np.polyfit(np.r_[0.0, points], of, len(points)) for of in x.T]
        torques = [np.polyfit(points, of, len(points) - 1) for of in u[:, 2:].T]
        q, v, a = np.split(np.array([np.polyval(of, where) for of in states]), 3)
        slope = np.array([np.polyval(np.polyder(of), where) for of in states[2:4]]) / length
        torque = np.array([np.polyval(of, where) for of in torques])
        both = [balance.map(len(where))(q, v, each, torque).full() for each in (a, slope)]
        sizes.append(np.abs(both).max(axis=(0, 1)))
    return np.array(sizes)


@pytest.mark.parametrize("intervals", [3, 12])
def test_it_looks_where_radau_leaves_most(swung, intervals: int) -> None:
    """The starts of the intervals: midpoints of a five times finer grid see two thirds of what is left there."""
    found = solve(swung[0], SolverOptions("radau", 3, intervals))
    seen = judged(*swung, found)
    grid = left_at(swung[1], found, np.linspace(0.0, 1.0, 201))
    between = left_at(swung[1], found, (np.arange(15) + 0.5) / 15.0)
    assert seen.moment == pytest.approx(grid.max(), rel=1e-6)
    assert grid[:, 0].max() == grid.max() and between.max() < 0.8 * grid.max()
    time = fine_residual(swung[0].system, swung[0].trials[0], found.motions[0], found.p, (True, True)).time
    assert len(time) >= 101 and set(found.motions[0].breaks) <= set(time)


@pytest.mark.parametrize("kind", ["radau", "legendre"])
def test_the_balance_is_held_where_it_is_said_to_be(swung, kind: str) -> None:
    problem = swung[0]
    motion = solve(problem, SolverOptions(kind, 3, 4)).motions[0]
    time = motion.held_times[: None if kind == "radau" else -1]
    samples = MotionSamples(time, motion.state(time), motion.rate(time), motion.control(time))
    _, left = residuals(problem.system, problem.trials[0], samples, np.zeros(0))
    assert len(time) == (10 if kind == "radau" else 13) and np.abs(left).max() < 1e-7
    (grid,) = left_at(swung[1], solve(problem, SolverOptions(kind, 3, 1)), np.linspace(0.0, 1.0, 21))
    assert grid.max() > 1e-2


def test_only_intervals_that_leave_too_much_are_halved(swung) -> None:
    """Until none does: each new node is the middle of an interval that left more than is let pass."""
    problem, stepper = swung
    limits = CertificateLimits(moment=0.25)
    coarse = solve(problem, SolverOptions("radau", 3, 5))
    over = left_at(stepper, coarse, np.linspace(0.0, 1.0, 101)).max(axis=1) > limits.moment
    assert 0 < over.sum() < len(over)
    (mesh,) = halved(problem, coarse, (True, True), limits)
    middles = (0.1 + 0.2 * np.arange(5))[over]
    np.testing.assert_allclose(mesh, np.sort(np.r_[np.linspace(0.0, 1.0, 6), middles]), atol=1e-12)
    fine = refined(problem, coarse, SolverOptions("radau", 3), (True, True), limits)
    assert fine.solved and left_at(stepper, fine, np.linspace(0.0, 1.0, 101)).max() <= limits.moment
    assert len(coarse.meshes[0]) < len(fine.meshes[0]) < 80 and fine.iterations > coarse.iterations
    assert len(halved(problem, fine, (True, True), limits)[0]) == len(fine.meshes[0])


def test_meshes_on_the_way_are_solved_roughly_the_last_as_asked(swung) -> None:
    """The same mesh and answer as from meshes that are all solved to the tolerance, in fewer iterations."""
    problem, options = swung[0], SolverOptions("radau", 3, 5)
    limits = CertificateLimits(moment=0.05)
    coarse = solve(problem, rough(options))
    assert coarse.tolerance == ROUGH and coarse.solved
    found = refined(problem, coarse, options, (True, True), limits)
    assert found.solved and found.tolerance == options.tolerance
    each = solve(problem, options)
    iterations = each.iterations
    while len((meshes := halved(problem, each, (True, True), limits))[0]) > len(each.meshes[0]):
        each = solve(problem, options, meshes=meshes)
        iterations += each.iterations
    np.testing.assert_array_equal(found.meshes[0], each.meshes[0])
    assert len(found.meshes[0]) > 8 and found.iterations < iterations, (found.iterations, iterations)
    assert found.objective == pytest.approx(each.objective, rel=1e-6)
    np.testing.assert_allclose(found.motions[0].states, each.motions[0].states, atol=1e-5)


def test_a_mesh_that_may_be_the_last_is_solved_once(swung, monkeypatch: pytest.MonkeyPatch) -> None:
    """To the tolerance where fewer than a quarter of the intervals are new, roughly and again where more are."""
    searched = []

    def counted(problem: ControlProblem, options: SolverOptions, **given: Any) -> CollocationResult:
        searched.append((len(given["meshes"][0]) - 1, options.tolerance))
        return solve(problem, options, **given)

    monkeypatch.setattr(solving, "solve", counted)
    options = SolverOptions("radau", 3, 16)
    coarse = solve(swung[0], rough(options))
    left = fine_residual(swung[0].system, swung[0].trials[0], coarse.motions[0], coarse.p, (True, True)).moment
    most = np.sort(left.reshape(16, -1).max(axis=1))[::-1]
    assert refined(swung[0], coarse, options, (True, True), CertificateLimits(moment=most[2])).solved
    assert refined(swung[0], coarse, options, (True, True), CertificateLimits(moment=most[4])).solved
    once, twice = (18, options.tolerance), (20, options.tolerance)
    assert searched == [once, (20, ROUGH), twice]


def test_halving_comes_to_an_end(swung) -> None:
    never = refined(
        swung[0],
        solve(swung[0], SolverOptions("radau", 2, 1)),
        SolverOptions("radau", 2),
        (True, True),
        CertificateLimits(moment=1e-9),
    )
    assert never.solved and len(never.meshes[0]) == 1 + 2**MOST_HALVINGS
    assert min(np.diff(never.meshes[0])) == pytest.approx(2.0**-MOST_HALVINGS)


def test_other_masses_than_those_solved_for_fail(swung) -> None:
    """The simulation, not the residual, sees that another model moves otherwise."""
    found = solve(swung[0], SolverOptions("radau", 4, 10))
    tree, torque = tree_of(pendulum(LENGTHS, (2.0, 1.1))), SX.sym("torque", 2)
    other = Stepper(equations_of_motion(tree, along={"q0": torque[0], "q1": torque[1]}, inputs=[torque]))
    seen = judged(swung[0], other, found)
    assert not seen.converged and any("departure after 0.2 s" in words for words in seen.failed), seen


def test_radau_s_first_acceleration_is_free_unless_held(swung) -> None:
    """Without the balance at the start the first acceleration is wrong there, and only there."""
    problem, stepper = swung
    bare = replace(problem.system, path_at_start=())
    free = solve(replace(problem, system=bare), SolverOptions("radau", 4, 10))
    held = solve(problem, SolverOptions("radau", 4, 10))
    sizes = []
    for found in (free, held):
        motion = found.motions[0]
        x, torque = motion.states[0, 0], motion.control(np.zeros(1))[0, 2:]
        a = np.array(stepper.equations.accelerations()(x[:2], x[2:4], [], torque, [])).ravel()
        sizes.append(np.abs(a - x[4:]).max())
    assert sizes[1] < 1e-6 < 1e-3 < sizes[0], sizes


def test_growth_of_an_upright_pendulum_is_that_of_its_linear_equation() -> None:
    """At rest upside down: deviations grow by exp(A T), sqrt(g / l) in the end."""
    length, g = 0.7, 9.81
    tree, torque = tree_of(pendulum((length,), (1.0,))), SX.sym("torque")
    equations = equations_of_motion(tree, along={"q0": torque}, inputs=[torque])
    system = jerk_controlled(equations, controlled=(0,), control_names=("t",))
    x = np.array([np.pi, 0.0, 0.0])
    trial = ControlledTrial(
        "upright",
        0.0,
        (1.0, 1.0),
        (x - 5, x + 5),
        (np.full(2, -9.0), np.full(2, 9.0)),
        (x, x),
        (x, x),
        lambda t: np.tile(x, (len(t), 1)),
        lambda t: np.zeros((len(t), 2)),
    )
    found = solve(ControlProblem(system, (trial,)), SolverOptions(intervals=5))
    again = resimulation(Stepper(equations), found.motions[0], found.p, trial.inputs, (0,))
    seen = certificate(found.solved, system, trial, again, (True,))
    flow = expm(np.array([[0.0, 1.0], [g / length, 0.0]]))
    assert seen.growth == pytest.approx(np.linalg.norm(flow, 2), rel=1e-3)
    left = fine_residual(system, trial, again.motion, again.p, (True,))
    assert certificate(found.solved, system, trial, again, (True,), left=left) == seen
    more = certificate(found.solved, system, trial, again, (True,), left=replace(left, moment=left.moment + 2.0))
    assert more.moment == pytest.approx(seen.moment + 2.0) and not more.converged
    assert seen.converged, seen


def test_departures_over_a_window_are_known_far_better_than_they_are_limited(
    swung, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Against steps a million times as strict, on a coarse mesh."""
    found = solve(swung[0], SolverOptions("radau", 3, 3))
    quick = judged(*swung, found).window
    monkeypatch.setattr(certifying, "COARSER", 1e-12)
    assert 1e-4 < quick == pytest.approx(judged(*swung, found).window, abs=1e-3 * CertificateLimits().window)


def test_tangents_are_those_of_scipy_s_simulations(swung) -> None:
    """Central differences of DOP853 from states that are 1e-5 apart, with the torques of each interval's polynomial."""
    problem, stepper = swung
    motion = solve(problem, SolverOptions("radau", 4, 10)).motions[0]
    again = resimulation(stepper, motion, np.zeros(0), problem.trials[0].inputs, (0, 1))
    accelerations, points = stepper.equations.accelerations(), motion.scheme.points
    found = again.tangents()
    assert found.shape == (10, 4, 4)
    for k in (0, 4, 9):
        begin, end = motion.breaks[k : k + 2]
        torque = [np.polyfit(points, of, len(points) - 1) for of in motion.controls[k, :, 2:].T]

        def rate(t: float, x: np.ndarray, torque=torque, begin=begin, end=end) -> np.ndarray:
            given = [np.polyval(of, (t - begin) / (end - begin)) for of in torque]
            return np.r_[x[2:], accelerations(x[:2], x[2:], [], given, []).full().ravel()]

        def after(x: np.ndarray, span=(begin, end), rate=rate) -> np.ndarray:
            return solve_ivp(rate, span, x, method="DOP853", rtol=1e-11, atol=1e-12).y[:, -1]

        x = motion.states[k, 0, :4]
        columns = [(after(x + h) - after(x - h)) / 2e-5 for h in 1e-5 * np.eye(4)]
        np.testing.assert_allclose(found[k], np.stack(columns, axis=1), atol=2e-6)


def test_derivatives_are_taken_once_for_all_meshes(swung, monkeypatch: pytest.MonkeyPatch) -> None:
    """Of intervals, starts and ends; with other points, or of another problem, they are taken anew."""
    made = []

    def counted(*expressions: SX) -> BlockFunctions:
        made.append(expressions)
        return block_functions(*expressions)

    monkeypatch.setattr(transcription, "block_functions", counted)
    problem = replace(swung[0])
    coarse = solve(problem, SolverOptions("radau", 3, 5))
    assert len(made) == 3
    again = solve(problem, SolverOptions("radau", 3, 10), warm=coarse)
    assert len(made) == 3 and len(again.meshes[0]) == 11
    fresh = solve(replace(problem), SolverOptions("radau", 3, 10))
    assert len(made) == 6 and again.objective == pytest.approx(fresh.objective, rel=1e-7)
    solve(problem, SolverOptions("radau", 2, 5))
    assert len(made) == 9
