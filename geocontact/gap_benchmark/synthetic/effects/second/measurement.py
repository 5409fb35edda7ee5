"""What sensors make of outputs in the second family."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.integrate import cumulative_trapezoid

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.effects.measurement.filter_lag import FILTER_LAG
from geocontact.gap_benchmark.synthetic.effects.measurement.saturation import SATURATION
from geocontact.gap_benchmark.synthetic.effects.measurement.sensor_drift import SENSOR_DRIFT
from geocontact.gap_benchmark.synthetic.effects.measurement.sensor_gain import SENSOR_GAIN
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs
from geocontact.gap_benchmark.synthetic.plan import Draw, Rng, SyntheticMagnitudes


def averaged(u: Float[np.ndarray, " t"], h: float, length: float) -> Float[np.ndarray, " t"]:
    """Mean over the last `length` [s]; before it begins a straight line."""
    before = int(np.ceil(length / h)) + 1
    ahead = u[0] + (u[1] - u[0]) * np.arange(-before, 0)
    whole = np.concatenate([ahead, u])
    time = h * np.arange(-before, len(u))
    total = cumulative_trapezoid(whole, dx=h, initial=0)
    now = h * np.arange(len(u))
    return np.asarray((np.interp(now, time, total) - np.interp(now - length, time, total)) / length)


def averaging(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: lag T [s] of slow signals."""
    share = rng.uniform(0.4, 0.6)

    def hooks(lag: float) -> Hooks:
        def passed(course: InputCourse, outputs: Outputs) -> Outputs:
            h = float(course.time[1] - course.time[0])
            lengths = (2.0 * share * lag, 2.0 * (1.0 - share) * lag)
            return np.array([averaged(averaged(row, h, lengths[0]), h, lengths[1]) for row in outputs])

        return Hooks(sensor=((30.0, passed),))

    longest = 0.05 if scale.system == "foot" else min(0.35, 0.06 * scale.duration)
    return Draw(0.001, longest, hooks, lambda t: f"running means twice, with a lag of {t:.3g} s")


def leaning(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: drift at the end of a trial in the channel's unit, of either sign."""
    names = tuple(scale.output)
    row = int(rng.integers(len(names)))
    most, sign, bend = scale.output[names[row]], rng.choice([-1.0, 1.0]), rng.uniform(1.0, 4.0)

    def hooks(size: float) -> Hooks:
        def drifted(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            out[row] += sign * size * np.log1p(bend * course.time / scale.duration) / np.log1p(bend)
            return out

        return Hooks(sensor=((50.0, drifted),))

    top = {"elbow": 0.4, "sit_to_stand": 0.4}.get(scale.system, 0.15)
    return Draw(1e-4 * most, top * most, hooks, lambda size: f"{names[row]} drifts by {sign * size:.3g}", names[row])


def one_sided(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: how far the rail lies below the largest output, as a share of it [-]."""
    names = tuple(scale.output)
    row = int(rng.choice([0, 1, 1])) if scale.system == "foot" else scale.load(rng)
    most, soft = scale.output[names[row]], rng.uniform(0.02, 0.06)

    def hooks(cut: float) -> Hooks:
        rail, width = (1.0 - cut) * most, soft * most

        def limited(_: InputCourse, outputs: Outputs) -> Outputs:
            out, size = outputs.copy(), np.abs(outputs[row])
            out[row] = np.sign(outputs[row]) * (size - width * np.logaddexp(0.0, (size - rail) / width))
            return out

        return Hooks(sensor=((60.0, limited),))

    return Draw(0.002, 0.6, hooks, lambda cut: f"{names[row]} levels off at {(1.0 - cut) * most:.3g}", names[row])


def small_loads(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: gain error g [-] of large loads, of either sign; as of which channel see the first family."""
    rows = [int(rng.choice([0, 0, 1, 2]))] if scale.system == "foot" else [scale.load(rng)]
    if scale.system in ("foot", "knee") and scale.departure < 1.0:
        rows = [0, 1]
    names, sign = tuple(scale.output), rng.choice([-1.0, 1.0])
    more = scale.departure * rng.uniform(0.3, 0.6)

    def hooks(gain: float) -> Hooks:
        def scaled(_: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            for row in rows:
                load = np.abs(outputs[row]) / scale.output[names[row]]
                out[row] = outputs[row] * (1.0 + sign * gain * (1.0 + more * np.exp(-3.0 * load)))
            return out

        return Hooks(sensor=((20.0, scaled),))

    which = " and ".join(names[row] for row in rows)
    return Draw(1e-4, 0.4, hooks, lambda g: f"{which} read {sign * g:+.2%}", "forces" if len(rows) > 1 else which)


AVERAGING = replace(FILTER_LAG, planted="running means over two windows", draw=averaging)
LEANING = replace(SENSOR_DRIFT, planted="a log(1 + c t/T)/log(1 + c), c = 1..4", draw=leaning)
ONE_SIDED = replace(
    SATURATION, planted="|y| - w log(1 + exp((|y| - L)/w)), w = 0.02..0.06 of the largest", draw=one_sided
)
SMALL_LOADS = replace(SENSOR_GAIN, planted="y (1 + g (1 + e exp(-3 |y|/Y))), e = 0.3..0.6", draw=small_loads)
