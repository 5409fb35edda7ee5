"""What a model gains by passing less noise of its inputs on. The cases are synthetic."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.effects.catalogue import candidates
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.case.problem import Problem, evaluated
from geocontact.gap.case.refit import at
from geocontact.gap.selection.evidence import by_smoothing
from geocontact.gap.selection.model_comparison import base_contender
from geocontact.systems.catalogue import system_of
from tests.gap.cases import elbow_case


@pytest.fixture(scope="module")
def problem() -> Problem:
    case = elbow_case(seed=3)
    return problem_of(case, system_of(case))


def owed(problem: Problem, label: str, values: dict[str, float]) -> float:
    """By a candidate at some values, the base as it was fitted [nats]."""
    base = base_contender(problem).judged
    one = next(c for c in candidates(problem.system) if c.label == label)
    fitted = at(one.apply(problem.system), problem.calibration, None, {**base.model.values, **values})
    model = evaluated(problem, fitted)
    return float(by_smoothing(problem, model, problem.whitenings(base.noise, model)).sum())


def test_a_low_pass_owes_what_it_smooths(problem: Problem) -> None:
    little = owed(problem, "filter_lag", {"filter_lag.lag": 0.05, "filter_lag.order": 1.0})
    much = owed(problem, "filter_lag", {"filter_lag.lag": 0.3, "filter_lag.order": 1.0})
    assert 0.0 < little < much


def test_a_delay_smooths_nothing(problem: Problem) -> None:
    much = owed(problem, "filter_lag", {"filter_lag.lag": 0.3, "filter_lag.order": 1.0})
    assert owed(problem, "time_shift", {"time_shift.delay": 0.3}) < 0.2 * much


def test_who_passes_more_on_gains_nothing(problem: Problem) -> None:
    assert owed(problem, "sensor_gain.force", {"sensor_gain.force.gain": 0.5}) == 0.0
    assert owed(problem, "sensor_gain.force", {"sensor_gain.force.gain": -0.5}) > 0.0


def test_no_trial_gains_by_what_another_owes(problem: Problem) -> None:
    """All trials together owe something, so none gets anything, whatever it passes on by itself."""
    base = base_contender(problem).judged
    model = base.model
    uneven = tuple((1.1 if i < 2 else 0.0) * part for i, part in enumerate(problem.passed_on))
    owing = by_smoothing(problem, replace(model, passed_on=uneven), problem.whitenings(base.noise, model))
    assert (owing[:2] == 0.0).all()
    assert (owing[2:] > 0.0).all()


def test_a_simulation_that_fails_says_nothing(problem: Problem) -> None:
    base = base_contender(problem).judged
    whitenings = problem.whitenings(base.noise, base.model)
    failed = replace(base.model, passed_on=tuple(np.full(part.shape, np.nan) for part in problem.passed_on))
    assert not by_smoothing(problem, failed, whitenings).any()


def test_noise_that_is_added_is_that_of_the_inputs(problem: Problem) -> None:
    """Of the same size over all trials as what taking it off has left, by the levels of the residuals."""
    moved = np.concatenate(
        [
            noisy.column("beta") - clean.column("beta")
            for noisy, clean in zip(
                problem.shaken.trials, problem.calibration.trials + problem.evaluation.trials, strict=True
            )
        ]
    )
    level, kept = float(problem.weighed(problem.plain).levels.inputs[0]), problem.left["beta"]
    grid = np.linspace(0.0, 12.0, 600)
    power = problem.passed["beta"].power(grid)
    assert float(moved.std()) == pytest.approx(level * np.sqrt((power * kept(grid)).sum() / power.sum()), rel=0.3)
