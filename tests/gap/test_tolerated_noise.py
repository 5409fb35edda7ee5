"""No more noise is believed of an input than may be taken off it without harm to the base model."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.gap_case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.gap.case.plain_fit import plain_fit
from geocontact.gap.case.preparation import problem_of, worse_somewhere
from geocontact.gap.case.problem import Problem
from geocontact.gap.levels import SLIGHT
from geocontact.systems.elastic_joint import JOINT

STEP = 0.04


def swing(pace: float, noise: float, rng: np.random.Generator) -> Trial:
    """Two sines, of which the quicker one ends where a low-pass filter might; spring, damper, noise of 0.2 N m."""
    phase = 2.0 * np.pi * pace * (time := STEP * np.arange(160))
    angle = 0.3 * np.sin(phase) + 0.08 * np.sin(2.7 * phase)
    rate = 2.0 * np.pi * pace * (0.3 * np.cos(phase) + 0.216 * np.cos(2.7 * phase))
    torque = 60.0 * angle + 3.0 * rate + rng.normal(0.0, 0.2, len(time))
    measured = angle + rng.normal(0.0, noise, len(time))
    return Trial(f"{pace}", Signals(time, np.column_stack([measured, torque]), ("angle", "torque"), ("rad", "N m")))


def case(noise: float, told: dict[str, float]) -> GapCase:
    rng = np.random.default_rng(3)
    trials = tuple(swing(pace, noise, rng) for pace in (0.35, 0.5, 0.7, 0.4, 0.6))
    stiffness = Parameter("k", "N m/rad", 50.0, 10.0, 200.0)
    name = "geocontact.systems.elastic_joint:JOINT"
    return GapCase("swing", name, trials[:3], trials[3:], (stiffness,), noise=told)


@pytest.fixture(scope="module", params=[0.0, pytest.param(0.01, marks=pytest.mark.slow)])
def problem(request: pytest.FixtureRequest) -> Problem:
    one = case(request.param, {"torque": 0.2})
    return problem_of(one, JOINT.build(one.parameters, one.constants, one.tables))


def test_the_base_misses_no_more_once_noise_is_taken_off(problem: Problem) -> None:
    """It missed 13 instead of 3 N m where nearly the whole movement was taken off a recording without noise."""
    recorded, floor = problem.recorded, problem.floor_of_noise
    first = replace(recorded, trials=recorded.trials[:3], outputs=recorded.outputs[:3])
    before, after = (plain_fit(problem.system, some, floor, [{}], 20).cost for some in (first, problem.calibration))
    assert after < (1.0 + SLIGHT) * before


def test_a_damper_has_the_size_that_was_planted(problem: Problem) -> None:
    """Least squares of the trials that models are judged on."""
    (damper,) = [one for one in candidates(problem.system) if one.name == "damping"]
    found = plain_fit(damper.apply(problem.system), problem.calibration, problem.floor_of_noise, damper.starts, 40)
    assert found.values["damping.b"] == pytest.approx(3.0, rel=0.05)


def test_a_channel_that_grows_counts_however_little_of_the_error_it_has() -> None:
    """The larger channel loses half of its error, the smaller one gains half: in the sum the error falls."""
    rng = np.random.default_rng(4)
    before = [rng.standard_normal((300, 2)) * [40.0, 3.0] for _ in range(2)]
    better = [part * [0.7, 1.0] for part in before]
    assert not worse_somewhere(before, better)
    wave = np.sin(np.linspace(0.0, 30.0, 300))
    assert worse_somewhere(before, [part + np.column_stack([0.0 * wave, 3.0 * wave]) for part in better])
