"""What differs from trial to trial beside base parameters: constants, zeros, gains, two clocks, the mains' hum.

A device is put on anew for every trial, sensors are zeroed and calibrated anew. The usual sizes are those of the
contract of a gap case: about a millimetre on a device of some 20 cm, half a degree, a per cent of a channel's
calibration. Lengths are in proportion to the device, so that a larger one is not put on more exactly. Each is a
direction in which the residual of a trial may lie, integrated out like the trial-to-trial variation of base parameters
(`identify.noise.trial_variation`), its size estimated from the trials together with what is usual.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.differentiated_inputs import DifferentiatedInputs
from geocontact.chain.links import LAST, Modifier
from geocontact.chain.system import FAR, System
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial
from geocontact.gap.case.noise_sources import error_of_rates, hum
from geocontact.gap.levels import DEVIATIONS, FLAT

LENGTH = 0.006  # of the device's largest length: 1 mm of 17 cm
ANGLE = 0.0087  # rad: half a degree
GAIN = 0.01  # of a channel, and of the half-range of an input that is neither a length nor an angle; half of it: zero
SHARE = 0.04  # of a base parameter that is neither a length nor an angle


def varies_by(system: System, parameter: Parameter, value: float) -> float:
    """Standard deviation that a base parameter usually has from trial to trial."""
    if parameter.unit == "m":
        return LENGTH * system.length
    return ANGLE if parameter.unit == "rad" else SHARE * abs(value)


def placement(
    system: System,
    trials: Sequence[Trial],
    values: Mapping[str, float],
    movable: Sequence[str],
    rough: Float[np.ndarray, " c"],
) -> tuple[Float[np.ndarray, "_ c k"], ...]:
    """Per trial, what one usual standard deviation of each changes in the outputs, in their units.

    Known lengths and angles, zeros of the inputs in `movable`, zeros of outputs, gains of outputs, the offset of
    two clocks, hum of the mains beside noise of the level `rough`, the numerical error of rates (both of
    `gap.case.noise_sources`), in this order; 0 where the model has no value.
    """
    return tuple(_of_trial(system, trial, values, movable, rough) for trial in trials)


def _of_trial(
    system: System,
    trial: Trial,
    values: Mapping[str, float],
    movable: Sequence[str],
    rough: Float[np.ndarray, " c"],
) -> Float[np.ndarray, "t c k"]:
    columns = []
    for name, by in put_on(system).items():
        at = system.known[name]
        above, below = (system.simulate(trial, {**values, name: at + s * by}) for s in (1.0, -1.0))
        columns.append(_half(above, below))
    for row, name in enumerate(system.inputs):
        if name in movable:
            by = zero_of_input(system, name)
            above, below = (shifted(system, row, s * by).simulate(trial, values) for s in (1.0, -1.0))
            columns.append(_half(above, below))
    told = system.simulate(trial, values)
    told = np.where(np.abs(told) < 0.5 * FAR, told, np.nan)
    predicted = np.nan_to_num(told)
    for c, name in enumerate(system.outputs):
        for column in (0.5 * GAIN * system.scale.of(name), GAIN * predicted[:, c]):
            own = np.zeros_like(predicted)
            own[:, c] = column
            columns.append(own)
    columns.append(clock_offset(trial.time, told))
    rates = error_of_rates(system, trial, values)[..., None]
    return np.concatenate([np.stack(columns, axis=-1), hum(trial.time, rough), rates], axis=-1)


def clock_offset(time: Float[np.ndarray, " t"], told: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "t c"]:
    """What inputs and outputs of two clocks differ by, which may begin up to half a sample apart.

    Such a delay, as likely anywhere in that, has a standard deviation of 1/√12 of a sample. That is the most that
    trials may show (DEVIATIONS of the usual one): most recorders have one clock. `told` is what is predicted, NaN where
    that has no value; 0 there and beside it.
    """
    usual = float(np.median(np.diff(time))) / FLAT / DEVIATIONS
    return np.asarray(np.nan_to_num(np.gradient(told, time, axis=0)) * usual)


def put_on(system: System) -> dict[str, float]:
    """Standard deviation of each known length or angle: constants, and parameters that are not fitted."""
    known = {name: LENGTH * system.length for name in system.lengths if name in system.known}
    fixed = (p for p in system.parameters if p.fixed and p.unit in ("m", "rad"))
    return known | {p.name: varies_by(system, p, p.start) for p in fixed}


def zero_of_input(system: System, name: str) -> float:
    """Standard deviation of the zero of an input from trial to trial."""
    unit = system.unit(name)
    if unit == "m":
        return LENGTH * system.length
    return ANGLE if unit == "rad" else GAIN * system.scale.span.get(name, 1.0)


def shifted(system: System, row: int, by: float) -> System:
    """A system that sees one input `by` so much higher."""

    def change(
        movement: DifferentiatedInputs, _: DifferentiatedInputs, __: Mapping[str, float]
    ) -> DifferentiatedInputs:
        position = movement.position.copy()
        position[row] += by
        return replace(movement, position=position)

    return replace(system, motion=system.motion.having(Modifier("zero", LAST, change)))


def _half(above: Float[np.ndarray, "t c"], below: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "t c"]:
    off = above - below
    return np.asarray(np.where(np.isfinite(off) & (np.abs(off) < 0.5 * FAR), 0.5 * off, 0.0))
