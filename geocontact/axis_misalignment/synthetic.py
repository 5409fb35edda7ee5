"""Synthetic recordings of an exoskeleton at an elbow, after the design of the explicit model's experiment.

The paper's design (sec. III.B, III.C): 60 s of tracking a multisine of random frequencies from 0.05 to 0.35 Hz, 1 kHz,
12 bits, cuff pressures of 10 to 60 mmHg at random, the compensation joint locked or free. It does not print everything
that a recording needs. At each number below stands whether it is the paper's or assumed; docs/how-to/elbow.md has the
table. Assumed throughout: the person adds an Ornstein-Uhlenbeck force. The true numbers of the law are those given.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from itertools import accumulate

import numpy as np
from jaxtyping import Float

from geocontact.axis_misalignment.compensation import taken_up
from geocontact.axis_misalignment.explicit import Offsets, constraint_force, displacement
from geocontact.axis_misalignment.law import Yielded, yielded
from geocontact.data.elbow_recording import ElbowRecording

PAPER = {"k": 222.43, "x": 0.048, "y": 0.059, "l": 0.169, "z": 0.127, "b": 0.0, "s": 0.0, "c": 0.0}
"""What the explicit model's paper identified (sec. IV.C): one point of the line on which forces do not change.

Its fit has no damping (sec. III.D), no stiffness that follows the pressure and a rigid fixation of the upper arm (sec.
II.B), so b, s and c are 0.
"""
SINES = 6
"""Sines of the tracking signal. Assumed: the paper gives their band, not their number."""
AMPLITUDES = (0.3, 1.0)
"""Least and largest amplitude of a sine before all are scaled to the reach [-]. Assumed: the paper says 0 to pi."""
FULL_SCALE = {"beta": np.pi, "force": 100.0, "displacement": 0.2}
"""What the converter's steps divide [rad, N, m]. Assumed: the paper gives the 12 bits only."""


@dataclass(frozen=True)
class Design:
    """How recordings are made; sections are the paper's.

    Parameters
    ----------
    seconds, rate
        Length [s] and sampling rate [Hz]; sec. III.B.
    band
        Frequencies of the multisine [Hz]; sec. III.B.
    reach
        Least and largest angle of each trial [rad]. Width: the 42 bins of 2 degrees of sec. III.C. Ends: assumed; the
        paper says only that 0 was not reached with the joint locked (sec. IV.C).
    noise
        Standard deviation of what the person adds to the force [N]. Assumed: the paper's residuals, of bins' means,
        have 0.782 N (sec. IV.C).
    memory
        Its correlation time [s]. Assumed; the paper has none.
    donning
        Standard deviation of the offsets x and y from trial to trial [m]. Assumed: the device was put on before each
        task (sec. III.B), by how much it moved is not reported.
    bits
        Of the converter, 0 for none; sec. III.C.
    pressures
        Range from which each trial's cuff pressure is drawn [Pa]; None where none is recorded. 10 to 60 mmHg in
        sec. III.B.
    sines, amplitudes
        Of the tracking signal, and the least and largest of their relative amplitudes.
    full_scale
        What the converter's steps divide, by channel [rad, N, m].
    """

    seconds: float = 60.0
    rate: float = 1000.0
    band: tuple[float, float] = (0.05, 0.35)
    reach: tuple[float, float] = (np.radians(8.0), np.radians(92.0))
    noise: float = 0.8
    memory: float = 0.3
    donning: float = 0.0
    bits: int = 12
    pressures: tuple[float, float] | None = None
    sines: int = SINES
    amplitudes: tuple[float, float] = AMPLITUDES
    full_scale: Mapping[str, float] = field(default_factory=lambda: dict(FULL_SCALE))


@dataclass(frozen=True, eq=False)
class SyntheticElbowTrial:
    """A recording that was made, and the law's numbers in it: the offsets differ from trial to trial by donning."""

    recording: ElbowRecording
    numbers: Mapping[str, float]


def multisine(time: Float[np.ndarray, " t"], design: Design, rng: np.random.Generator) -> Float[np.ndarray, " t"]:
    """Angle of one trial [rad]: sines of random frequencies, amplitudes and phases, from end to end of the reach."""
    count = design.sines
    frequency = rng.uniform(*design.band, count)
    size, phase = rng.uniform(*design.amplitudes, count), rng.uniform(0.0, 2.0 * np.pi, count)
    sum_of = size @ np.sin(2.0 * np.pi * frequency[:, None] * time + phase[:, None])
    low, high = float(sum_of.min()), float(sum_of.max())
    first, last = design.reach
    return np.asarray(first + (last - first) * (sum_of - low) / (high - low))


def synthetic(
    name: str,
    numbers: Mapping[str, float],
    design: Design,
    rng: np.random.Generator,
    stroke: tuple[float, float] | None = None,
    mean_pressure: float = 0.0,
    torque: float | None = None,
    turning: float = 0.0,
) -> SyntheticElbowTrial:
    """One synthetic recording with its own numbers.

    With a stroke of the compensation joint [m] the joint is free and its displacement recorded.

    Parameters
    ----------
    numbers
        k, x, y, l, z, b, s, c in SI units, as `law`.
    mean_pressure
        Pressure at which the stiffness is k [Pa].
    torque, turning
        Of the actuator [N m], None where there is none; stiffness of the cuff against turning [N m/rad].
    """
    time = np.arange(round(design.seconds * design.rate) + 1) / design.rate
    beta = multisine(time, design, rng)
    pressure = None if design.pressures is None else float(rng.uniform(*design.pressures))
    shift = design.donning * rng.standard_normal(2)
    moved = {**numbers, "x": numbers["x"] + shift[0], "y": numbers["y"] + shift[1]}
    tight = 0.0 if pressure is None else pressure - mean_pressure
    force, joint = ideal(time, beta, moved, stroke, tight, torque or 0.0, turning)
    noisy = force + _remembered(len(time), design, rng)
    recording = ElbowRecording(
        name,
        time,
        _converted(beta, "beta", design),
        _converted(noisy, "force", design),
        None if stroke is None else _converted(joint, "displacement", design),
        None if pressure is None else np.full(len(time), pressure),
        None if torque is None else np.full(len(time), torque),
    )
    return SyntheticElbowTrial(recording, moved)


def ideal(
    time: Float[np.ndarray, " t"],
    beta: Float[np.ndarray, " t"],
    numbers: Mapping[str, float],
    stroke: tuple[float, float] | None = None,
    pressure: float | Float[np.ndarray, " t"] = 0.0,
    torque: float | Float[np.ndarray, " t"] = 0.0,
    turning: float = 0.0,
) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]]:
    """Force [N] by the explicit model and displacement of the compensation joint [m] along recorded angles.

    ValueError where the model has a pole or folds. Damping acts on what is left for the cuff. The actuator's torque
    [N m] and the cuff's stiffness against turning [N m/rad] reach the force through a fixation that yields only.
    """
    offsets = offsets_in(numbers)
    if numbers["c"] != 0.0:
        return _yielding(time, beta, numbers, stroke, pressure, torque, turning)
    stiffness = numbers["k"] * (1.0 + numbers["s"] * np.asarray(pressure))
    if stroke is None:
        rate = np.gradient(beta, time)
        unit = constraint_force(beta, rate, offsets, 1.0)
        speed = constraint_force(beta, rate, offsets, 0.0, 1.0)
        return np.asarray(stiffness * unit + numbers["b"] * speed), np.zeros_like(beta)
    joint, left = taken_up(displacement(beta, offsets).total, stroke)
    return np.asarray(stiffness * left + numbers["b"] * np.gradient(left, time)), joint


def at_rest(
    time: Float[np.ndarray, " t"],
    beta: Float[np.ndarray, " t"],
    numbers: Mapping[str, float],
    stroke: tuple[float, float] | None = None,
    pressure: float | Float[np.ndarray, " t"] = 0.0,
    torque: float | Float[np.ndarray, " t"] = 0.0,
    turning: float = 0.0,
) -> Yielded:
    """Force and offsets under load along recorded angles, the fixation of the upper arm yielding by `numbers["c"]`."""
    return yielded(
        beta,
        np.gradient(beta, time),
        offsets_in(numbers),
        numbers["k"] * (1.0 + numbers["s"] * np.asarray(pressure)),
        damping=numbers["b"],
        turning=turning,
        compliance=numbers["c"],
        torque=torque,
        stroke=stroke or (0.0, 0.0),
    )


def _yielding(
    time: Float[np.ndarray, " t"],
    beta: Float[np.ndarray, " t"],
    numbers: Mapping[str, float],
    stroke: tuple[float, float] | None,
    pressure: float | Float[np.ndarray, " t"],
    torque: float | Float[np.ndarray, " t"],
    turning: float,
) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]]:
    """`ideal` with a fixation that yields."""
    found = at_rest(time, beta, numbers, stroke, pressure, torque, turning)
    joint = np.zeros_like(beta) if stroke is None else taken_up(found.deflection(beta, offsets_in(numbers)), stroke)[0]
    return found.force, joint


def offsets_in(numbers: Mapping[str, float]) -> Offsets:
    """Lengths among the numbers."""
    return Offsets(l=numbers["l"], z=numbers["z"], x=numbers["x"], y=numbers["y"])


def _remembered(count: int, design: Design, rng: np.random.Generator) -> Float[np.ndarray, " t"]:
    """An Ornstein-Uhlenbeck force [N]."""
    white = rng.standard_normal(count)
    if design.memory <= 0.0:
        return design.noise * white
    keep = float(np.exp(-1.0 / (design.rate * design.memory)))
    new = np.sqrt(1.0 - keep**2) * white
    new[0] = white[0]
    return design.noise * np.fromiter(accumulate(new.tolist(), lambda last, each: each + keep * last), float, count)


def _converted(values: Float[np.ndarray, " t"], channel: str, design: Design) -> Float[np.ndarray, " t"]:
    """What the converter makes of it."""
    if design.bits == 0:
        return values
    step = design.full_scale[channel] / 2.0**design.bits
    return np.asarray(np.round(values / step) * step)
