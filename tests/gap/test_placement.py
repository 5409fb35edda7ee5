"""What is put on and zeroed anew for every trial: directions in which the residual of a trial may lie."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.gap.case.placement import ANGLE, GAIN, ZERO, placement
from geocontact.gap.selection.held_out_error import TrialWeight
from geocontact.systems.elastic_joint.model import JOINT

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
    columns = placement(system, trials, {"k": 60.0}, ["angle"])[0]
    predicted = system.simulate(trials[0], {"k": 60.0})
    largest = float(np.abs(trials[0].column("torque")).max())
    assert columns.shape == (120, 1, 3)
    assert columns[..., 0] == pytest.approx(60.0 * ANGLE), "zero of the angle"
    assert columns[..., 1] == pytest.approx(ZERO * largest, rel=0.02), "zero of the torque"
    assert columns[..., 2] == pytest.approx(GAIN * predicted), "gain of the torque"
    weigh = TrialWeight.of(np.ones((120, 1), bool), np.array([NOISE]), columns)
    alike = np.full((120, 1), 0.1)
    quick = 0.1 * np.sign(np.sin(40.0 * trials[0].time))[:, None]
    costs = [float((weigh(each) ** 2).sum()) for each in (alike, quick)]
    assert costs[0] < 0.05 * costs[1]
    assert costs[1] > 0.9 * float((quick**2).sum()) / NOISE**2
