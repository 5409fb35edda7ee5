"""How a trial is recorded: when samples are taken, what one is of its channel, and what becomes of noise.

An uneven clock loses rows; a sample may be a mean over an interval; noise may grow with what is measured, a quotient
divides it, numbers have steps.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float, Int
from scipy.signal import lfilter

Rng = np.random.Generator


@dataclass(frozen=True)
class Clock:
    """An even clock that now and then loses rows by default.

    Parameters
    ----------
    uneven
        Most that a sample is early or late, as a share of the time between two; below 0.5.
    losing
        Share of recordings that lose rows.
    alone
        Share of rows that such a recording loses one by one.
    longest
        Most rows of a stretch that it loses, a fifth of a trial at most; there are two stretches at most.
    interrupted
        Chance of an output, in a trial, that a stretch of it is missing, a tenth to a fifth of the trial.
    trigger
        Most by which the inputs of a trial are recorded late or early against its outputs, as a share of the time
        between two samples: they have a clock each, started by one signal.
    """

    uneven: float = 0.0
    losing: float = 0.2
    alone: float = 0.01
    longest: int = 5
    interrupted: float = 0.0
    trigger: float = 0.0

    def late(self, rng: Rng, count: int, fine: int) -> Int[np.ndarray, " s"]:
        """How late each sample is, in steps of which there are `fine` between two; the first and last are in time."""
        most = int(self.uneven * fine)
        late = rng.integers(-most, most + 1, count) if most else np.zeros(count, int)
        late[[0, -1]] = 0
        return late

    def apart(self, rng: Rng) -> float:
        """By which share of a step the inputs of a trial are late; nothing is drawn for clocks that are one."""
        return float(rng.uniform(-self.trigger, self.trigger)) if self.trigger else 0.0

    def kept(self, rng: Rng, count: int) -> Int[np.ndarray, " s"]:
        """Rows that are left when some were lost, single ones and a few stretches; the first and last stay."""
        keep, longest = rng.random(count) > self.alone, min(self.longest, count // 5)
        for _ in range(int(rng.integers(0, 3))):
            begin = int(rng.integers(1, count - longest - 1))
            keep[begin : begin + int(rng.integers(2, longest + 1))] = False
        keep[0] = keep[-1] = True
        return np.flatnonzero(keep)

    def heard(self, rng: Rng, outputs: Float[np.ndarray, "c s"]) -> Float[np.ndarray, "c s"]:
        """Outputs with stretches of single ones missing (NaN); nothing is drawn where none is ever missing."""
        if not self.interrupted:
            return outputs
        left, count = outputs.copy(), outputs.shape[1]
        for row in left:
            lasting = max(int(rng.uniform(0.1, 0.2) * count), 1)
            begin, missing = int(rng.integers(0, count - lasting + 1)), rng.random() < self.interrupted
            if missing:
                row[begin : begin + lasting] = np.nan
        return left


USUAL = Clock()
"""Even, and loses rows now and then."""


@dataclass(frozen=True)
class Sampler:
    """One for all channels, inputs and outputs alike, so that no channel is late against another.

    Parameters
    ----------
    over
        Share of the time between two samples over which a sample is the mean, in whole steps to either side of its
        time, which is the middle. Less at the ends of a trial, where that would reach beyond it; the first and last
        sample are taken at once.
    lag
        Time constant of a first-order low-pass in front of it, in times between two samples; before a trial the
        channels moved on as they began.
    at_once
        Rows of inputs that it reads as they are, since they are switches.
    """

    over: float = 0.0
    lag: float = 0.0
    at_once: tuple[int, ...] = ()

    def __bool__(self) -> bool:
        """Whether it does anything."""
        return bool(self.over or self.lag)

    def inputs(self, rows: Float[np.ndarray, "i t"], fine: int, at: Int[np.ndarray, " s"]) -> Float[np.ndarray, "i s"]:
        """Samples number `at` of inputs along `fine` steps between two samples."""
        found = self.outputs(rows, fine, at)
        found[list(self.at_once)] = rows[list(self.at_once)][:, at]
        return found

    def outputs(
        self,
        rows: Float[np.ndarray, "c t"],
        fine: int,
        at: Int[np.ndarray, " s"],
        quotients: Mapping[int, int] | None = None,
    ) -> Float[np.ndarray, "c s"]:
        """The same of outputs; of one that comes by a division (row: row of the divisor) both parts are sampled."""
        parts = rows.copy()
        for row, by in (quotients or {}).items():
            parts[row] *= rows[by]
        if self.lag:
            parts = _lagging(parts, self.lag * fine)
        found = _mean(parts, round(0.5 * self.over * fine), at)
        for row, by in (quotients or {}).items():
            found[row] = np.divide(found[row], found[by], out=np.zeros(len(at)), where=found[by] != 0.0)
        return found


def _lagging(rows: Float[np.ndarray, "c t"], lasting: float) -> Float[np.ndarray, "c t"]:
    """First-order low-pass of a time constant in steps, exact for rows that are straight between two steps."""
    old = float(np.exp(-1.0 / lasting))
    held = lasting * (1.0 - old)
    slope = 1.5 * (rows[:, 1] - rows[:, 0]) - 0.5 * (rows[:, 2] - rows[:, 1])
    bend = rows[:, 2] - 2.0 * rows[:, 1] + rows[:, 0]
    begin = rows[:, 0] - lasting * slope + lasting**2 * bend
    state = begin - (1.0 - held) * rows[:, 0]
    return np.asarray(lfilter([1.0 - held, held - old], [1.0, -old], rows, axis=1, zi=state[:, None])[0])


def _mean(rows: Float[np.ndarray, "c t"], half: int, at: Int[np.ndarray, " s"]) -> Float[np.ndarray, "c s"]:
    """Mean over `half` steps to either side of places, by the trapezoidal rule."""
    if not half:
        return rows[:, at]
    total = np.zeros(rows.shape)
    np.cumsum(0.5 * (rows[:, 1:] + rows[:, :-1]), axis=1, out=total[:, 1:])
    reach = np.minimum(half, np.minimum(at, rows.shape[1] - 1 - at))
    whole = total[:, at + reach] - total[:, at - reach]
    return np.asarray(np.where(reach > 0, whole / np.maximum(2 * reach, 1), rows[:, at]))


AT_ONCE = Sampler()
"""A sample is the value at its time."""


Outputs = Float[np.ndarray, "c t"]


@dataclass(frozen=True)
class Quotient:
    """An output that is computed as a moment over another output, `divisor`, both of them noisy.

    The noise that is stated for the channel is its own where the divisor is `reference`.
    """

    divisor: int
    reference: float


@dataclass(frozen=True)
class Recorder:
    """By row of outputs or inputs; nothing of the kind where a row is missing.

    Parameters
    ----------
    growth
        Noise grows by sqrt(1 + (growth y)²); in one over the output's unit.
    hurry
        It grows by sqrt(1 + (hurry Δy)²), Δy the output's change from sample to sample; in one over its unit.
    quotients
        Outputs that are computed from others.
    output_steps, input_steps
        What numbers are multiples of, noise and all.
    """

    growth: Mapping[int, float] = field(default_factory=dict)
    hurry: Mapping[int, float] = field(default_factory=dict)
    quotients: Mapping[int, Quotient] = field(default_factory=dict)
    output_steps: Mapping[int, float] = field(default_factory=dict)
    input_steps: Mapping[int, float] = field(default_factory=dict)

    def noisy(self, clean: Outputs, noise: Outputs) -> Outputs:
        """Outputs with noise as it arises; that of a quotient is in `noise` as if it divided by the reference."""
        out = np.asarray(clean + self._grown(clean) * noise)
        for row, one in self.quotients.items():
            moment = clean[row] * clean[one.divisor] + one.reference * noise[row]
            by = out[one.divisor]
            out[row] = np.divide(moment, by, out=np.full_like(moment, np.nan), where=by != 0.0)
        return out

    def mixing(self, clean: Outputs) -> Float[np.ndarray, "c c t"]:
        """How much of each channel's noise is in each output, as far as it is linear; 0 where there is no value."""
        mixed = np.eye(len(clean))[:, :, None] * self._grown(clean)
        for row, one in self.quotients.items():
            by = np.where(clean[one.divisor] != 0.0, clean[one.divisor], np.nan)
            mixed[row] = -clean[row] / by * mixed[one.divisor]
            mixed[row, row] = one.reference / by
        return np.asarray(np.nan_to_num(mixed))

    def rounded(self, values: Outputs, steps: Mapping[int, float]) -> Outputs:
        """The nearest numbers that it can write."""
        out = values.copy()
        for row, step in steps.items():
            out[row] = np.round(values[row] / step) * step
        return out

    def _grown(self, clean: Outputs) -> Outputs:
        factor = np.ones_like(clean)
        for row, slope in self.growth.items():
            factor[row] = np.sqrt(1.0 + (slope * clean[row]) ** 2)
        for row, slope in self.hurry.items():
            factor[row] *= np.sqrt(1.0 + (slope * np.nan_to_num(np.gradient(clean[row]))) ** 2)
        return factor


EXACT = Recorder()
"""Noise is as large everywhere, and numbers are written in full."""
