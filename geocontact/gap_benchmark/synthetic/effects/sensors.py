"""What sensors and amplifiers make of the outputs, sample by sample or slowly: gain, zero, drift, rails, crosstalk."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.effects.kernels import settled
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes


def sensor_gain(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A sensor that is off in gain, a little more at high loads.

    planted:   y (1 + g (1 + e (|y|/Y - 1/2))), e = 0.54..0.72; 0.8..1.1 at knee and shoulder; 1.2..1.6 for cop_x;
               0.08..0.11 for force_y, because base parameters nearly take a plain gain of it away
    candidate: (1 + g) y
    amplitude: gain error g [-], of either sign; of one channel, or both forces where base parameters take it
    """
    rows = _gained(rng, scale)
    names = tuple(scale.output)
    sign = rng.choice([-1.0, 1.0])
    bend = scale.departure * rng.uniform(0.9, 1.2) * scale.numbers.gains[rows[-1]]

    def hooks(gain: float) -> Hooks:
        def scaled(_: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            for row in rows:
                load = np.abs(outputs[row]) / scale.output[names[row]]
                out[row] = outputs[row] * (1.0 + sign * gain * (1.0 + bend * (load - 0.5)))
            return out

        return Hooks(sensor=((20.0, scaled),))

    which = " and ".join(names[row] for row in rows)
    return Draw(1e-4, 0.4, hooks, lambda g: f"{which} read {sign * g:+.2%}", "forces" if len(rows) > 1 else which)


def small_loads(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Gain error of the second family: larger at small loads.

    planted:   y (1 + g (1 + e exp(-3 |y|/Y))), e = 0.3..0.6
    amplitude: gain error g [-] of large loads, of either sign; as of which channel see the first family
    """
    rows = _gained(rng, scale)
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


def _gained(rng: Rng, scale: SyntheticMagnitudes) -> list[int]:
    rows = [scale.load_of(rng, scale.numbers.gained)]
    return [0, 1] if scale.numbers.gained_together and scale.departure < 1.0 else rows


def sensor_offset(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A zero error that drifts slowly.

    planted:   y + o (1 + e sin(2 pi m t/T + phi)), e = 0.16..0.3 (straps 0.05..0.08, where base parameters take most of
               a plain offset away), m = 1..2.5
    candidate: y + o
    amplitude: offset o in the channel's unit, of either sign
    """
    names = tuple(scale.output)
    row = int(rng.integers(len(names)))
    most = scale.output[names[row]]
    sign, drift = rng.choice([-1.0, 1.0]), scale.departure * rng.uniform(*scale.numbers.wander)
    turns, phase = rng.uniform(1.0, 2.5), rng.uniform(0.0, 2.0 * np.pi)

    def hooks(offset: float) -> Hooks:
        def shifted(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            slow = np.sin(2.0 * np.pi * turns * course.time / course.duration + phase)
            out[row] += sign * offset * (1.0 + drift * slow)
            return out

        return Hooks(sensor=((40.0, shifted),))

    top = scale.numbers.zero
    return Draw(1e-4 * most, top * most, hooks, lambda o: f"{names[row]} reads {sign * o:.3g} too much", names[row])


def sensor_drift(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Warm-up that is neither linear nor exponential.

    planted:   a ((t/T)^p + e sin(2 pi m t/T + phi)), p = 0.7..1.3, e = 0.07..0.11
    candidate: r T (1 - exp(-c t/T))/c
    amplitude: drift at the end of a trial in the channel's unit, of either sign
    """
    names = tuple(scale.output)
    row = int(rng.integers(len(names)))
    most = scale.output[names[row]]
    sign, p, drift = rng.choice([-1.0, 1.0]), rng.uniform(0.7, 1.3), rng.uniform(0.07, 0.11)
    turns, phase = rng.uniform(1.5, 2.5), rng.uniform(0.0, 2.0 * np.pi)

    def hooks(size: float) -> Hooks:
        def drifted(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            share = course.time / scale.duration
            out[row] += sign * size * (share**p + drift * (np.sin(2.0 * np.pi * turns * share + phase) - np.sin(phase)))
            return out

        return Hooks(sensor=((50.0, drifted),))

    def words(size: float) -> str:
        return f"{names[row]} drifts by {sign * size:.3g} in a trial"

    return Draw(1e-4 * most, scale.numbers.zero * most, hooks, words, names[row])


def leaning(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Drift of the second family: quick at first.

    planted:   a log(1 + c t/T)/log(1 + c), c = 1..4
    amplitude: drift at the end of a trial in the channel's unit, of either sign
    """
    names = tuple(scale.output)
    row = int(rng.integers(len(names)))
    most, sign, bend = scale.output[names[row]], rng.choice([-1.0, 1.0]), rng.uniform(1.0, 4.0)

    def hooks(size: float) -> Hooks:
        def drifted(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            out[row] += sign * size * np.log1p(bend * course.time / scale.duration) / np.log1p(bend)
            return out

        return Hooks(sensor=((50.0, drifted),))

    top = scale.numbers.zero
    return Draw(1e-4 * most, top * most, hooks, lambda size: f"{names[row]} drifts by {sign * size:.3g}", names[row])


def saturation(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """An amplifier that compresses towards rails which are not alike, and is slow to recover.

    planted:   c(y) = q + r (y - q) + (1 - r) (L - q) tanh((y - q)/(L - q)) beyond a knee q = 0.75..0.88 L,
               r = 0.06..0.12; of what is cut off, y - c(y), a share of 0.25..0.6 follows with a lag
    candidate: y (1 + |y/L|^(1/s))^(-s), s <= 0.3, alike on both sides, at once
    amplitude: how far the rail lies below the largest output, as a share of it [-]
    """
    names = tuple(scale.output)
    row = scale.load_of(rng, scale.numbers.clipped)
    most = scale.output[names[row]]
    knee, other, give = rng.uniform(0.75, 0.88), rng.uniform(1.0, 1.3), rng.uniform(0.06, 0.12)
    slow = rng.uniform(*scale.numbers.slow)
    lag = rng.uniform(*scale.numbers.recovery)

    def hooks(cut: float) -> Hooks:
        rail = (1.0 - cut) * most / (0.5 + 0.5 * knee)

        def limited(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            cut_off = outputs[row] + _compressed(-_compressed(outputs[row], rail, knee, give), other * rail, knee, give)
            late = settled(cut_off[:, None], float(course.time[1] - course.time[0]), lag)[:, 0]
            out[row] = outputs[row] - (1.0 - slow) * cut_off - slow * late
            return out

        return Hooks(sensor=((60.0, limited),))

    def words(cut: float) -> str:
        return f"{names[row]} is compressed from {(1.0 - cut) * most * knee / (0.5 + 0.5 * knee):.3g} on"

    return Draw(0.002, 0.6, hooks, words, names[row])


def _compressed(y: Values, rail: float, knee: float, give: float) -> Values:
    """y below `knee` rail, towards `rail` above."""
    begin = knee * rail
    room = max(rail - begin, 1e-12)
    beyond = y - begin
    return np.where(y > begin, begin + give * beyond + (1.0 - give) * room * np.tanh(beyond / room), y)


def one_sided(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Saturation of the second family: a rounded limit, alike on both sides.

    planted:   |y| - w log(1 + exp((|y| - L)/w)), w = 0.02..0.06 of the largest
    amplitude: how far the rail lies below the largest output, as a share of it [-]
    """
    names = tuple(scale.output)
    row = scale.load_of(rng, scale.numbers.clipped)
    most, soft = scale.output[names[row]], rng.uniform(0.02, 0.06)

    def hooks(cut: float) -> Hooks:
        rail, width = (1.0 - cut) * most, soft * most

        def limited(_: InputCourse, outputs: Outputs) -> Outputs:
            out, size = outputs.copy(), np.abs(outputs[row])
            out[row] = np.sign(outputs[row]) * (size - width * np.logaddexp(0.0, (size - rail) / width))
            return out

        return Hooks(sensor=((60.0, limited),))

    return Draw(0.002, 0.6, hooks, lambda cut: f"{names[row]} levels off at {(1.0 - cut) * most:.3g}", names[row])


def crosstalk(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Channels couple more at slow than at quick loads.

    planted:   a += chi (s c + (1 - s) low-pass of c with 20..40 ms; knee 50..80, straps 40..70), c = b; straps
               c = b (1 + e (|b|/B - 1/2)), e = 0.6..0.9
    candidate: a += chi b
    amplitude: share chi [-], of either sign
    """
    numbers = scale.numbers
    to, source = (0, 1) if rng.random() < 0.7 else (1, 0)
    if not numbers.on_ground:
        to, source = (int(row) for row in rng.choice(scale.loads, 2, replace=False))
    sign, prompt, tau = rng.choice([-1.0, 1.0]), rng.uniform(0.1, 0.3), rng.uniform(*numbers.coupling)
    names = tuple(scale.output)
    most = scale.output[names[source]]
    bend = rng.uniform(*numbers.uneven_coupling) if numbers.uneven_coupling else 0.0

    def hooks(share: float) -> Hooks:
        def coupled(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            h = float(course.time[1] - course.time[0])
            felt = outputs[source] * (1.0 + bend * (np.abs(outputs[source]) / most - 0.5))
            late = settled(felt[:, None], h, tau)[:, 0]
            out[to] += sign * share * (prompt * felt + (1.0 - prompt) * late)
            return out

        return Hooks(sensor=((10.0, coupled),))

    words = names[source], names[to]
    variant = f"{words[0]}_in_{words[1]}"
    return Draw(1e-4, 0.3, hooks, lambda x: f"{sign * x:.2%} of {words[0]} shows in {words[1]}", variant)


SENSOR_GAIN = InjectionPlan("sensor_gain", "gain that changes with load", "constant gain", sensor_gain)
SMALL_LOADS = replace(SENSOR_GAIN, planted="y (1 + g (1 + e exp(-3 |y|/Y))), e = 0.3..0.6", draw=small_loads)
SENSOR_OFFSET = InjectionPlan("sensor_offset", "offset that wanders", "constant offset", sensor_offset)
SENSOR_DRIFT = InjectionPlan("sensor_drift", "power of time with a wander", "linear or exponential", sensor_drift)
LEANING = replace(SENSOR_DRIFT, planted="a log(1 + c t/T)/log(1 + c), c = 1..4", draw=leaning)
SATURATION = InjectionPlan("saturation", "soft knee, uneven rails, slow recovery", "rounded symmetric clip", saturation)
ONE_SIDED = replace(
    SATURATION, planted="|y| - w log(1 + exp((|y| - L)/w)), w = 0.02..0.06 of the largest", draw=one_sided
)
CROSSTALK = InjectionPlan("crosstalk", "frequency-dependent coupling", "constant coupling", crosstalk)
