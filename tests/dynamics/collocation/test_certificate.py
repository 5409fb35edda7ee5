"""The certificate: it passes what holds between its points, fails what does not, and knows how fast errors grow."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from casadi import SX
from scipy.linalg import expm

from geocontact.dynamics.collocation.certificate import Certificate, certificate
from geocontact.dynamics.collocation.multibody import jerk_controlled
from geocontact.dynamics.collocation.problem import ControlledTrial, ControlProblem
from geocontact.dynamics.collocation.resimulation import resimulation
from geocontact.dynamics.collocation.solve import CollocationResult, SolverOptions, solve
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
    assert seen.converged, seen
