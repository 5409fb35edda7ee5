"""What is put on and zeroed anew for every trial differs between trials, and is no effect."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.data.gap.case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.effects.catalogue import candidates
from geocontact.gap.case.preparation import problem_of
from geocontact.gap.case.problem import Problem
from geocontact.gap.selection.model_comparison import base_contender, singles
from geocontact.systems.elastic_joint.model import JOINT

EITHER = (0.35, -0.1, 0.3, -0.25, 0.2)
"""Zeros of the torque in five trials, three of them for calibration [N m]; its largest value is 21, its noise 0.2."""


def spring(zeros: tuple[float, ...]) -> Problem:
    """A spring that lacks nothing, whose torque had these zeros when it was recorded."""
    rng, trials = np.random.default_rng(3), []
    time = 0.04 * np.arange(120)
    for pace, zero in zip((0.35, 0.5, 0.7, 0.4, 0.6), zeros, strict=True):
        angle = 0.35 * np.sin(2.0 * np.pi * pace * time)
        torque = 60.0 * angle + zero + rng.normal(0.0, 0.2, len(time))
        signals = Signals(time, np.column_stack([angle, torque]), ("angle", "torque"), ("rad", "N m"))
        trials.append(Trial(f"{pace}", signals))
    stiffness = Parameter("k", "N m/rad", 50.0, 10.0, 200.0)
    told = {"torque": 0.2, "angle": 1e-6}
    name = "geocontact.systems.elastic_joint.model:JOINT"
    one = GapCase("swing", name, tuple(trials[:3]), tuple(trials[3:]), (stiffness,), noise=told)
    return problem_of(one, JOINT.build(one.parameters, one.constants, one.tables))


def test_zeros_of_either_sign_are_no_offset() -> None:
    problem = spring(EITHER)
    base = base_contender(problem)
    offered = [each for each in candidates(problem.system) if each.label == "sensor_offset.torque"]
    assert max(each.nats for each in singles(problem, base, offered)) - base.nats < 3.0
    noise = replace(base.judged.noise, varies=problem.usual)
    whiten, time = problem.whitenings(noise, base.judged.model)[0], 0.04 * np.arange(120)
    alike = np.full((120, 1), 0.4)
    moving = 0.4 * np.sign(np.sin(9.0 * time))[:, None]
    costs = [float((whiten(each[..., None]) ** 2).sum()) for each in (alike, moving)]
    assert costs[0] < 0.1 * costs[1], "a trial may have a zero of its own for next to nothing"
