"""What a sample is of its channel: the value at its time, or a mean over an interval, or what a filter lets through."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.signal import lfilter


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
