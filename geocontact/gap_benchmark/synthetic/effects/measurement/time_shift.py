"""Outputs come late, by a clock that drifts.

planted:   out(t - d (1 + e sin(2 pi m t/T + phi))), e = 0.28..0.38: buffers fill and empty while a trial runs
candidate: out(t - d)
"""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import ALL, Draw, InjectionPlan, Rng, SyntheticMagnitudes


def draw(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: delay d [s]."""
    unsteady = scale.departure * rng.uniform(0.28, 0.38)
    turns, phase = rng.uniform(2.0, 4.0), rng.uniform(0.0, 2.0 * np.pi)

    def hooks(delay: float) -> Hooks:
        def late(course: InputCourse, outputs: Outputs) -> Outputs:
            drift = unsteady * np.sin(2.0 * np.pi * turns * course.time / course.duration + phase)
            at = course.time - delay * (1.0 + drift)
            # before the trial began the output ran on straight
            first = outputs[:, :1] + (outputs[:, 1:2] - outputs[:, :1]) / (course.time[1] - course.time[0]) * at
            return np.where(at < 0.0, first, CubicSpline(course.time, outputs, axis=1)(np.maximum(at, 0.0)))

        return Hooks(sensor=((70.0, late),))

    longest = 0.05 if scale.system == "foot" else min(0.35, 0.06 * scale.duration)
    return Draw(0.0005, longest, hooks, lambda d: f"outputs recorded {d:.3g} s late by an unsteady clock")


TIME_SHIFT = InjectionPlan(
    "time_shift",
    ALL,
    "delay that wanders by a quarter through a trial",
    "constant delay",
    draw,
)
