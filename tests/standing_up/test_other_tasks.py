"""Phase A of other tasks than the study's: sitting down, a squat, and standing up from a higher chair."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.dynamics.collocation.solve import SolverOptions, refined, solve
from geocontact.standing_up.chain import PLANTED, Subject, feet_on_ground
from geocontact.standing_up.movements import hip_height
from geocontact.standing_up.phase import judged
from geocontact.standing_up.phases import phase_a
from geocontact.standing_up.trials import StandingNoise, recorded, standing_up

HIGHER = np.radians([12.0, 50.0, 30.0])
"""Leans of shank, thigh and trunk at seat-off; invented."""


@pytest.mark.slow
def test_sitting_down_and_a_higher_chair_give_the_feet_back() -> None:
    """Both in one problem: solved, certified, and the three numbers that one trial tells near what was planted."""
    subject, noise, model, trials = Subject(), StandingNoise(), feet_on_ground(Subject()), []
    for k, task in enumerate(({"seconds": 1.2, "down": True}, {"seconds": 1.0, "seated": HIGHER})):
        _, true = standing_up(model, subject, intervals=25, **task)  # type: ignore[arg-type]
        assert true.solved, task
        trials.append(recorded(model, true.motions[0], PLANTED, 100.0, noise, 34 + k, f"task {k}"))
    hip, higher = trials[0].q[:, 5], trials[1].q[0, 4]
    assert hip[0] > hip[-1] and abs(higher) < abs(trials[0].q[-1, 4]), "it sits down, and the chair is higher"
    phase = phase_a(model, subject, trials, noise)
    meshes = tuple(np.linspace(0.0, 1.0, count + 1) for count in (36, 30))
    found = solve(phase.control, SolverOptions("radau", 4, 1, 1e-7, 300), meshes=meshes)
    motions = judged(model.stepper, range(3), model.turning, phase, found)
    assert model.stepper is model.stepper and model.stepper.equations is model.equations
    assert all(each.certificate is not None and each.certificate.converged for each in motions), motions
    off = np.abs(found.p - PLANTED)[:3]
    assert off[0] < 0.1 and off[1:].max() < 4e-3, off


@pytest.mark.slow
@pytest.mark.parametrize("task", ["squat", "down"])
def test_one_trial_of_another_task_gives_the_feet_back(task: str) -> None:
    """Down alone, or down and up in 2.4 s: solved, certified, the three numbers near what was planted."""
    subject, noise, model = Subject(), StandingNoise(), feet_on_ground(Subject())
    kinds: dict[str, dict[str, bool | float]] = {
        "squat": {"seconds": 2.4, "squat": True},
        "down": {"seconds": 1.4, "down": True},
    }
    _, true = standing_up(model, subject, intervals=40, **kinds[task])  # type: ignore[arg-type]
    assert true.solved
    trial = recorded(model, true.motions[0], PLANTED, 100.0, noise, 36, task)
    height = hip_height(subject, trial.q)
    lowest = len(height) // 2 if task == "squat" else len(height) - 1
    assert height.argmin() == pytest.approx(lowest, abs=8) and np.ptp(height) > 0.25
    phase = phase_a(model, subject, [trial], noise)
    mesh = np.linspace(0.0, 1.0, round(30.0 * float(trial.time[-1])) + 1)
    options = SolverOptions("radau", 4, 1, 1e-7, 300)
    found = refined(phase.control, solve(phase.control, options, meshes=(mesh,)), options, model.turning)
    (motion,) = judged(model.stepper, range(3), model.turning, phase, found)
    assert motion.certificate is not None and motion.certificate.converged, motion.certificate
    off = np.abs(found.p - PLANTED)[:3]
    assert off[0] < 0.2 and off[1:].max() < 6e-3, off
