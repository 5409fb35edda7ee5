"""Phase A of other tasks than the study's: sitting down, and standing up from a higher chair."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.dynamics.collocation.solve import SolverOptions, solve
from geocontact.standing_up.chain import PLANTED, Subject, feet_on_ground
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
    motions = judged(model.equations, range(3), model.turning, phase, found)
    assert all(each.certificate is not None and each.certificate.converged for each in motions), motions
    off = np.abs(found.p - PLANTED)[:3]
    assert off[0] < 0.1 and off[1:].max() < 4e-3, off
