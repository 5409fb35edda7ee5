"""Mistakes in some of many trials: found without trying every set of them."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.gap_case import GapCase
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.gap import data_errors as faults
from geocontact.gap.case.preparation import problem_of
from geocontact.systems.catalogue import system_of
from tests.elsewhere import Elsewhere
from tests.gap.cases import elbow_case


def many_trials() -> GapCase:
    """Six calibration trials, two held out."""
    one, other = elbow_case(duration=6.0, seed=1), elbow_case(duration=6.0, seed=2)
    more = tuple(replace(trial, name=f"u{trial.name}") for trial in other.calibration)
    return replace(one, calibration=(*one.calibration, *more))


def in_millinewtons(trial: Trial) -> Trial:
    values = trial.signals.values.copy()
    values[:, trial.signals.channels.index("force")] *= 1000.0
    return replace(trial, signals=replace(trial.signals, values=values))


def found(wrong: tuple[str, ...]) -> tuple[str, tuple[str, ...], int]:
    """Label and trials of the mistake that is found, and how many sets of trials were tried for it."""
    case = many_trials()
    calibration = tuple(in_millinewtons(t) if t.name in wrong else t for t in case.calibration)
    problem = problem_of(replace(case, calibration=calibration), system_of(case))
    data_error = faults.data_error_of(problem, candidates(problem.system))
    assert data_error is not None
    return data_error.candidate.label, data_error.trials, len(faults._subsets(problem))


@pytest.mark.parametrize("wrong", [("t02",), ("t01", "ut03"), ("t01", "t02", "ut01", "ut02", "ut03")])
@pytest.mark.slow
def test_a_wrong_unit_in_some_of_many_trials(elsewhere: Elsewhere, wrong: tuple[str, ...]) -> None:
    label, trials, tried = elsewhere(found, wrong)
    assert label.startswith("unit_error.force")
    assert trials == tuple(sorted(wrong))
    assert tried <= 2 * 6


def test_of_a_few_trials_every_set_is_tried() -> None:
    case = elbow_case(duration=2.0)
    sets = faults._subsets(problem_of(case, system_of(case)))
    assert len(sets) == 7 and len(sets[0]) == 3 and np.all(np.diff([len(s) for s in sets]) <= 0)
