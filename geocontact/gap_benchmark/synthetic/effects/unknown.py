"""Effects that no row of the vocabulary describes: what loads add, what a device does, what a recorder makes of it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from geocontact.gap_benchmark.synthetic.course import InputCourse
from geocontact.gap_benchmark.synthetic.hooks import Hooks, Outputs, Pull, Swing, Values
from geocontact.gap_benchmark.synthetic.plan import Draw, InjectionPlan, Rng, SyntheticMagnitudes

GOLDEN = 0.6180339887


def other_carrier(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Something else carries load over a part of the motion.

    A cable that snaps over at the elbow, the arch of the foot, a plica that pops over the condyle of a knee.
    Amplitude: load [N]. Foot: around the middle of stance, at a place of the sole. Else around an angle.
    """
    if scale.numbers.sides:
        return _popping(rng, scale)
    angle, wide = scale.middle + rng.uniform(-0.4, 0.4), rng.uniform(0.06, 0.15)
    at, spell, place = rng.uniform(0.35, 0.6), rng.uniform(0.05, 0.1), rng.uniform(0.06, 0.12)
    on_ground = scale.numbers.on_ground

    def hooks(size: float) -> Hooks:
        def snap(course: InputCourse, _: Mapping[str, float]) -> Outputs:
            return np.asarray(size * np.exp(-(((course.position[0] - angle) / wide) ** 2)))[None]

        def arch(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            more = size * np.exp(-(((course.time / course.duration - at) / spell) ** 2))
            vertical = np.maximum(outputs[1] + more, 1.0)
            out[2] = (outputs[2] * outputs[1] + more * place) / vertical
            out[1] = outputs[1] + more
            return out

        return Hooks(sensor=((1.0, arch),)) if on_ground else Hooks(load=(snap,))

    where = f"around {at:.0%} of stance" if on_ground else f"around {angle:.2g} rad"
    return Draw(1e-4 * scale.force, 0.4 * scale.force, hooks, lambda a: f"something else carries {a:.3g} N {where}")


def _popping(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Amplitude: load [N] of one side while flexion passes an angle, whichever way."""
    row = scale.load(rng)
    angle, wide = scale.middle + scale.span * rng.uniform(-0.5, 0.5), scale.span * rng.uniform(0.12, 0.3)
    name = tuple(scale.output)[row]

    def hooks(size: float) -> Hooks:
        def pop(course: InputCourse, _: Mapping[str, float]) -> Outputs:
            added = np.zeros((len(scale.output), len(course.time)))
            added[row] = size * np.exp(-(((course.position[0] - angle) / wide) ** 2))
            return added

        return Hooks(load=(pop,))

    words = f"more in {name} while flexion passes {angle:.2g} rad"
    return Draw(1e-4 * scale.force, 0.4 * scale.force, hooks, lambda a: f"a plica pops over, {a:.3g} N {words}")


def burst(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """Somebody or something else pushes for a part of the trial.

    Amplitude: push [N], at the same part of every trial.
    """
    row = scale.load(rng)
    at, wide = rng.uniform(0.25, 0.75), rng.uniform(0.03, 0.09)
    sign = rng.choice([-1.0, 1.0])

    def hooks(size: float) -> Hooks:
        def push(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            out[row] += sign * size * np.exp(-(((course.time / course.duration - at) / wide) ** 4))
            return out

        return Hooks(sensor=((5.0, push),))

    return Draw(1e-4 * scale.force, 0.5 * scale.force, hooks, lambda a: f"a push of {sign * a:.3g} N around {at:.0%}")


def tremor(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A narrow line in the force: tremor or a resonance of the frame, 3..9 Hz at arms and straps, higher elsewhere.

    A third of the sampling frequency at most. Amplitude: of the oscillation [N]; its phase differs between trials.
    """
    low, high = scale.numbers.pitch
    if not scale.numbers.on_ground:
        high = min(high, 0.35 / scale.step)
    pitch, swell = rng.uniform(low, high), rng.uniform(0.0, 0.4)
    row = scale.load(rng)

    def hooks(size: float) -> Hooks:
        def shake(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            grown = 1.0 + swell * np.sin(2.0 * np.pi * 2.0 * course.time / course.duration)
            out[row] += size * grown * np.sin(2.0 * np.pi * pitch * course.time + course.phase)
            return out

        return Hooks(sensor=((5.0, shake),))

    return Draw(1e-4 * scale.force, 0.3 * scale.force, hooks, lambda a: f"a tremor of {a:.3g} N at {pitch:.1f} Hz")


def ringing(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """The plate or the frame rings after every blow: decaying oscillation from the strike on.

    Amplitude: of the first swing [N]; from a fixed phase of the stance on.
    """
    pitch, at, decay = rng.uniform(25.0, 60.0), rng.uniform(0.05, 0.2), rng.uniform(0.03, 0.08)
    row = int(rng.choice([0, 1]))

    def hooks(size: float) -> Hooks:
        def rung(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            since = np.maximum(course.time - at * course.duration, 0.0)
            out[row] += size * np.exp(-since / decay) * np.sin(2.0 * np.pi * pitch * since)
            return out

        return Hooks(sensor=((5.0, rung),))

    return Draw(1e-4 * scale.force, 0.4 * scale.force, hooks, lambda a: f"ringing of {a:.3g} N at {pitch:.0f} Hz")


def jump(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """The stiffness changes at once in the middle of the trial: a strap that gives, a bumper that comes loose.

    Amplitude: share of the stiffness that goes [-].
    """
    at = rng.uniform(0.35, 0.65) * scale.duration
    sign = rng.choice([-1.0, 1.0])

    def hooks(share: float) -> Hooks:
        def changed(time: Values, u: Values, _: Values) -> Values:
            factor = 1.0 + sign * share * 0.5 * np.tanh((time - at) / (4.0 * scale.step))
            return np.asarray(factor[:, None] if u.ndim == 2 else factor)

        return Hooks(spring=(changed,))

    return Draw(1e-3, 0.5, hooks, lambda s: f"the stiffness changes by {sign * s:.2%} at {at:.2g} s")


def swelling(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A muscle swells under the strap while it works: the pad is pressed for the part of a trial in which one rises.

    Amplitude: bulge [m], pressed by the pad's own stiffness; from and to a share of the trial.
    """
    begin, end = rng.uniform(0.1, 0.35), rng.uniform(0.5, 0.75)
    rising, falling = rng.uniform(0.02, 0.05), rng.uniform(0.04, 0.09)
    stiffness = scale.force / scale.stroke

    def hooks(bulge: float) -> Hooks:
        def swollen(p: Pull) -> Values:
            share = p.time / scale.duration
            works = 0.5 * (np.tanh((share - begin) / rising) - np.tanh((share - end) / falling))
            return np.asarray(stiffness * bulge * works)

        return Hooks(beside=(swollen,))

    def words(bulge: float) -> str:
        return f"a muscle swells by {bulge:.3g} m from {begin:.0%} to {end:.0%} of a trial"

    return Draw(1e-4 * scale.stroke, 0.5 * scale.stroke, hooks, words)


def catch(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A hinge whose bearing catches: it is drawn to one angle from either side, as by a dent.

    Amplitude: torque over the lever [N] at either flank of the dent.
    """
    angle, wide = scale.middle + scale.span * rng.uniform(-0.5, 0.5), rng.uniform(0.06, 0.15)
    lever = scale.numbers.hinge

    def hooks(size: float) -> Hooks:
        def caught(p: Swing) -> Values:
            x = (p.angle - angle) / wide
            return np.asarray(size * lever * x * np.exp(0.5 - 0.5 * x * x))

        return Hooks(hinge=(caught,))

    words = f"the hinge catches at {angle:.2g} rad, by"
    return Draw(1e-3 * scale.force, 0.6 * scale.force, hooks, lambda a: f"{words} {a * lever:.3g} N m")


def wander(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A sensor that follows the temperature of the room up and down, other in every trial.

    Amplitude: of the drift in the channel's unit.
    """
    names = tuple(scale.output)
    row = int(rng.integers(len(names)))
    most = scale.output[names[row]]
    turns = rng.uniform(1.5, 3.0)

    def hooks(size: float) -> Hooks:
        def drifting(course: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            angle = 2.0 * np.pi * turns * course.time / course.duration + course.phase
            out[row] += size * (np.sin(angle) + 0.5 * np.sin(1.7 * angle + 2.0 * course.phase))
            return out

        return Hooks(sensor=((45.0, drifting),))

    return Draw(1e-4 * most, 0.2 * most, hooks, lambda a: f"{names[row]} wanders up and down by {a:.3g}")


def held_samples(rng: Rng, _: SyntheticMagnitudes) -> Draw:
    """Stretches in which the recorder repeats its last value.

    Amplitude: duration of a stretch as a share of the trial [-]; where they lie differs between trials.
    """
    count = int(rng.integers(3, 7))

    def hooks(share: float) -> Hooks:
        def held(course: InputCourse, outputs: Outputs) -> Outputs:
            begin = np.sort((course.phase / (2.0 * np.pi) + GOLDEN * np.arange(1, count + 1)) % 1.0) * course.duration
            given = np.arange(len(course.time))
            for one in begin:
                inside = (course.time >= one) & (course.time < one + share * course.duration)
                given[inside] = given[max(int(np.searchsorted(course.time, one)) - 1, 0)]
            return outputs[:, given]

        return Hooks(recorder=(held,))

    return Draw(0.002, 0.12, hooks, lambda s: f"{count} stretches of {s:.2%} of a trial in which values are repeated")


def quantisation(rng: Rng, scale: SyntheticMagnitudes) -> Draw:
    """A converter with too few steps; noise is rounded with the rest.

    Amplitude: height of a step in the channel's unit.
    """
    names = tuple(scale.output)
    row = scale.load(rng)
    most = scale.output[names[row]]
    zero = rng.uniform()

    def hooks(step: float) -> Hooks:
        def rounded(_: InputCourse, outputs: Outputs) -> Outputs:
            out = outputs.copy()
            out[row] = (np.round(outputs[row] / step + zero) - zero) * step
            return out

        return Hooks(recorder=(rounded,))

    return Draw(1e-3 * most, 0.3 * most, hooks, lambda s: f"{names[row]} comes in steps of {s:.3g}")


UNKNOWN: tuple[InjectionPlan, ...] = (
    InjectionPlan("tremor", "narrow line", "", tremor),
    InjectionPlan("held_samples", "held samples", "", held_samples),
    InjectionPlan("burst", "push in a part of the trial", "", burst),
    InjectionPlan("other_carrier", "load carried elsewhere", "", other_carrier),
    InjectionPlan("quantisation", "coarse steps", "", quantisation),
    InjectionPlan("jump", "stiffness changes mid trial", "", jump, placed=True),
    InjectionPlan("wander", "up and down, other in every trial", "", wander),
    InjectionPlan("ringing", "decaying oscillation", "", ringing),
    InjectionPlan("swelling", "bulge while a muscle works", "", swelling, placed=True),
    InjectionPlan("catch", "hinge drawn to an angle", "", catch),
)
