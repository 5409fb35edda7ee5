"""The written model against OpenSim itself: it loads, and moves by the same forces."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.sit_to_stand.model_file import write_standing_model
from geocontact.analyses.sit_to_stand.solution_file import write_solution
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import STRAP_PLANTED, WORN_PARAMETERS, with_exoskeleton
from geocontact.standing_up.feet import EVERY_PLANTED
from geocontact.standing_up.judged import JudgedMotion
from geocontact.standing_up.trials import seen_in, standing_up
from tests import opensim_oracle
from tests.elsewhere import Elsewhere

P = np.r_[EVERY_PLANTED, STRAP_PLANTED]


NAMES = with_exoskeleton(Subject()).equations.names
POSTURE = np.array([0.0, 0.083, 0.0, -0.3, 1.2, -1.6, -0.3, 1.2, -1.6])


def written(file: Path) -> Path:
    """The model of planted parameters."""
    values = {each.name: each.value(float(p)) for each, p in zip(WORN_PARAMETERS, P, strict=True)}
    write_standing_model(file, Subject(), values, worn=True)
    return file


@pytest.mark.oracle
def test_opensim_accelerates_the_written_chains_as_the_equations_do(opensim: Elsewhere, tmp_path: Path) -> None:
    """On a standing foot and on one that slides, sinks and turns, with the strap displaced and turned."""
    file, rng = written(tmp_path / "standing.osim"), np.random.default_rng(4)
    q = POSTURE + rng.normal(size=(4, 9)) * np.r_[np.full(3, 1e-3), np.full(6, 1e-2)]
    u = 0.1 * rng.normal(size=(4, 9))
    still = u.copy()
    still[:, :3] = 0.0
    theirs = opensim(opensim_oracle.accelerations, file, NAMES, np.vstack([q, q]), np.vstack([still, u]))

    own = with_exoskeleton(Subject()).equations.accelerations()
    rates = zip(np.vstack([q, q]), np.vstack([still, u]), strict=True)
    ours = np.array([own(a, b, [], np.zeros(6), P).full().ravel() for a, b in rates])
    np.testing.assert_allclose(theirs, ours, rtol=1e-6, atol=1e-5)


@pytest.mark.oracle
def test_what_is_written_solves_the_model_that_is_written(opensim: Elsewhere, tmp_path: Path) -> None:
    """A rise of both chains on few intervals: at its points OpenSim's accelerations are those of the file."""
    model = with_exoskeleton(Subject())
    _, found = standing_up(model, Subject(), planted=P, intervals=12)
    (motion,), n = found.motions, model.count
    points = seen_in(model, motion, P, motion.held_times[:-1], "T1")
    none = np.zeros(len(points.time))
    trial = TrialResult(
        recorded=points,
        model=points,
        points=points,
        acceleration=motion.state(points.time)[:, 2 * n : 3 * n],
        judged=JudgedMotion(None, points.time, none, none),
    )
    write_solution(tmp_path / "solution_T1.sto", trial, found.solved)
    told, theirs = opensim(opensim_oracle.solved, written(tmp_path / "model.osim"), tmp_path / "solution_T1.sto")
    assert len(told) == 49 and np.abs(told).max() > 5.0
    np.testing.assert_allclose(theirs, told, rtol=0.0, atol=1e-6)
