"""What makes outputs late: a clock that drifts, filters of the measuring chain."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.integrate import cumulative_trapezoid
from scipy.interpolate import CubicSpline

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.effects.kernels import follow
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def time_shift(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Outputs come late, by a clock that drifts.

    planted:   out(t - d (1 + e sin(2 pi m t/T + phi))), e = 0.28..0.38: buffers fill and empty while a trial runs
    candidate: out(t - d)
    amplitude: delay d [s]
    """
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

    return Draw(0.0005, scale.latest, hooks, lambda d: f"outputs recorded {d:.3g} s late by an unsteady clock")


def filter_lag(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Outputs pass a low-pass that follows a rise and a fall differently.

    planted:   y' = (u - y)/tau(u - y), tau = T (1 + e) rising, T (1 - e) falling, e = 0.3..0.4, then a second-order
               Butterworth with a fifth of that lag
    candidate: two linear first-order stages
    amplitude: lag T [s] of slow signals
    """
    uneven = scale.departure * rng.uniform(0.3, 0.4) * rng.choice([-1.0, 1.0])

    def hooks(lag: float) -> Hooks:
        def passed(course: InputCourse, outputs: Outputs) -> Outputs:
            first, corner = 0.8 * lag, np.sqrt(2.0) / (0.2 * lag)
            h = float(course.time[1] - course.time[0])
            rows = [follow(row, h, first * (1.0 + uneven), first * (1.0 - uneven), corner) for row in outputs]
            return np.array(rows)

        return Hooks(sensor=((30.0, passed),))

    return Draw(0.001, scale.latest, hooks, lambda t: f"low-pass with a lag of {t:.3g} s, uneven by {uneven:.0%}")


def averaging(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Lag of the second family: running means.

    planted:   running means over two windows
    amplitude: lag T [s] of slow signals
    """
    share = rng.uniform(0.4, 0.6)

    def hooks(lag: float) -> Hooks:
        def passed(course: InputCourse, outputs: Outputs) -> Outputs:
            h = float(course.time[1] - course.time[0])
            lengths = (2.0 * share * lag, 2.0 * (1.0 - share) * lag)
            return np.array([_averaged(_averaged(row, h, lengths[0]), h, lengths[1]) for row in outputs])

        return Hooks(sensor=((30.0, passed),))

    return Draw(0.001, scale.latest, hooks, lambda t: f"running means twice, with a lag of {t:.3g} s")


def _averaged(u: Float[np.ndarray, " t"], h: float, length: float) -> Float[np.ndarray, " t"]:
    """Mean over the last `length` [s]; before it begins a straight line."""
    before = int(np.ceil(length / h)) + 1
    ahead = u[0] + (u[1] - u[0]) * np.arange(-before, 0)
    whole = np.concatenate([ahead, u])
    time = h * np.arange(-before, len(u))
    total = cumulative_trapezoid(whole, dx=h, initial=0)
    now = h * np.arange(len(u))
    return np.asarray((np.interp(now, time, total) - np.interp(now - length, time, total)) / length)


TIME_SHIFT = InjectionPlan(
    "time_shift", "delay that wanders by a quarter through a trial", "constant delay", time_shift
)
FILTER_LAG = InjectionPlan(
    "filter_lag", "direction-dependent first order, then Butterworth", "two linear stages", filter_lag
)
AVERAGING = replace(FILTER_LAG, planted="running means over two windows", draw=averaging)
