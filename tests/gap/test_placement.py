"""What is put on and zeroed anew for every trial: directions in which the residual of a trial may lie."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.data.diagnosis import Diagnosis
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.gap.case.noise_sources import wave_count
from geocontact.gap.case.placement import ANGLE, GAIN, clock_offset, placement, put_on
from geocontact.gap.diagnose import diagnose
from geocontact.gap.selection.held_out_rules import TrialWeight
from geocontact.systems.catalogue import system_of
from geocontact.systems.elastic_joint import JOINT
from tests.elsewhere import Elsewhere
from tests.gap.cases import TRUE, elbow_case

LENGTH, TURN, SHARE = 1e-3, np.radians(0.5), 0.01
"""Standard deviations of what is put on anew: a length [m], the zero of an angle [rad], a gain."""
NOISE = 0.2
"""Of the torque [N m]."""


def swing(zero: float) -> Trial:
    """A spring of 60 N m/rad that swings, its torque recorded with this zero [N m]."""
    time = 0.04 * np.arange(120)
    angle = 0.35 * np.sin(3.0 * time)
    return Trial("", Signals(time, np.column_stack([angle, 60.0 * angle + zero]), ("angle", "torque"), ("rad", "N m")))


def test_a_zero_of_its_own_costs_a_trial_next_to_nothing() -> None:
    system = JOINT.build((Parameter("k", "N m/rad", 60.0, 10.0, 200.0),), {}, {})
    trials = (swing(0.1), swing(-0.1))
    system = system.scaled(trials, {"k": 60.0})
    columns = placement(system, trials, {"k": 60.0}, ["angle"], np.array([NOISE]))[0]
    predicted = system.simulate(trials[0], {"k": 60.0})
    largest = float(np.abs(trials[0].column("torque")).max())
    assert columns.shape == (120, 1, 5 + wave_count(1))
    assert columns[..., 0] == pytest.approx(60.0 * ANGLE), "zero of the angle"
    assert columns[..., 1] == pytest.approx(0.5 * GAIN * largest, rel=0.02), "zero of the torque"
    assert columns[..., 2] == pytest.approx(GAIN * predicted), "gain of the torque"
    rate = 60.0 * 0.35 * 3.0 * np.cos(3.0 * trials[0].time)[1:-1]
    assert columns[1:-1, 0, 3] == pytest.approx(rate * 0.04 / 12.0, abs=0.001), "two clocks"
    assert not columns[..., -1].any(), "a spring feels no rate"
    weigh = TrialWeight.of(np.ones((120, 1), bool), np.array([NOISE]), columns)
    alike = np.full((120, 1), 0.1)
    quick = 0.1 * np.sign(np.sin(40.0 * trials[0].time))[:, None]
    costs = [float((weigh(each) ** 2).sum()) for each in (alike, quick)]
    assert costs[0] < 0.05 * costs[1]
    assert costs[1] > 0.9 * float((quick**2).sum()) / NOISE**2


def test_a_clock_that_begins_later_is_a_delay_within_half_a_sample() -> None:
    time = 0.01 * np.arange(300)
    told = np.sin(5.0 * time)[:, None]
    late = np.sin(5.0 * (time - 0.003))[:, None]
    own = clock_offset(time, told)
    size = -0.003 / (0.01 / 12.0)
    assert np.abs((told + size * own - late)[1:-1]).max() < 2e-4
    told[100:103] = np.nan
    assert np.array_equal(np.flatnonzero(clock_offset(time, told)[:, 0] == 0.0), np.arange(99, 104))


def test_a_length_that_is_not_fitted_is_put_on_anew_like_a_constant() -> None:
    case = elbow_case(duration=2.0)
    told = Parameter("l", "m", case.constants["l"], 0.0, 1.0, fixed=True)
    constants = {name: value for name, value in case.constants.items() if name != "l"}
    other = replace(case, parameters=(*case.parameters, told), constants=constants)
    systems = [system_of(each).scaled(each.calibration, TRUE) for each in (case, other)]
    expected, found = (placement(each, case.calibration[:1], TRUE, ["beta"], np.array([NOISE]))[0] for each in systems)
    assert put_on(systems[1]) == put_on(systems[0]) and "l" in put_on(systems[1])
    assert sorted(np.abs(found).sum(axis=(0, 1))) == pytest.approx(sorted(np.abs(expected).sum(axis=(0, 1))))


def put_on_anew() -> Diagnosis:
    """Of an elbow that lacks nothing: a constant length, the zero of its angle and the gain of its force are a trial's
    own."""
    case, rng = elbow_case(seed=3, duration=8.0), np.random.default_rng(8)
    system = system_of(case)
    for trial in (*case.calibration, *case.evaluation):
        moved = {**case.constants, "l": case.constants["l"] + LENGTH * rng.standard_normal()}
        other = system_of(replace(case, constants=moved))
        values = trial.signals.values
        angle, force = 0, 1
        values[:, force] += (other.simulate(trial, TRUE) - system.simulate(trial, TRUE))[:, 0]
        values[:, force] *= 1.0 + SHARE * rng.standard_normal()
        values[:, angle] += TURN * rng.standard_normal()
    return diagnose(case, system).diagnosis


@pytest.mark.slow
def test_what_is_put_on_anew_is_no_gap(elsewhere: Elsewhere) -> None:
    found = elsewhere(put_on_anew)
    assert (found.verdict, found.effects) == ("no_gap", ())
