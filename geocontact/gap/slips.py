"""Where a channel of a trial begins to run ahead of its prediction, or behind it, by a whole number of samples.

Place and number are those of the least squared error over all places and numbers. Odds are those beyond no slip and
any constant delay, less the logarithm of what was tried, samples counted as far as they are independent (Bartlett 1935,
J. R. Stat. Soc. 98, 536).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.trial import Trial
from geocontact.effects.measurement.clock_slip import WHEN
from geocontact.gap.levels import SLIGHT


@dataclass(frozen=True)
class Slip:
    """By how many samples a trial runs ahead from a place on; its nats.

    Squared errors of the same samples: `after` with it, `before` at the best constant delay, `unmoved` at none.
    """

    samples: int
    place: int
    after: float
    before: float
    unmoved: float
    nats: float


def slip_of(measured: Float[np.ndarray, " n"], predicted: Float[np.ndarray, " n"], most: int) -> Slip | None:
    """The likeliest slip of a trial of at most so many samples; None where no slip is likelier. NaN: not measured."""
    n, at = len(measured), np.arange(len(measured))
    gone = np.insert(np.cumsum(~np.isfinite(predicted)), 0, 0)  # samples count that have a prediction at every move
    there = np.isfinite(measured) & (gone[np.minimum(at + most + 1, n)] == gone[np.maximum(at - most, 0)])

    def until(move: int) -> Float[np.ndarray, " n"]:
        left = measured - predicted[np.clip(at + move, 0, n - 1)]
        return np.cumsum(np.where(there, left, 0.0) ** 2)

    first, last = (round(share * (n - 1)) for share in WHEN)
    still = until(0)
    after, row, place, before = np.inf, 0, first, np.inf
    for move in range(-most, most + 1):
        own = until(move)
        whole = (still + own[-1] - own)[first:last]
        best = int(np.argmin(whole))
        if whole[best] < after:
            after, row, place = float(whole[best]), move, first + best
        before = min(before, float(own[-1]))
    if row == 0 or not after > 0.0:
        return None
    left = (measured - predicted[np.clip(at + np.where(at > place, row, 0), 0, n - 1)])[there]
    alike = float(np.clip((left[1:] @ left[:-1]) / max(float(left @ left), 1e-300), 0.0, 1.0 - SLIGHT))
    independent = len(left) * (1.0 - alike) / (1.0 + alike)
    nats = 0.5 * independent * float(np.log(before / after)) - float(np.log(n * (2 * most + 1)))
    return Slip(row, place, after, before, float(still[-1]), nats)


def share_of_time(trial: Trial, there: Bool[np.ndarray, " t"], place: int) -> float:
    """Share of a trial's time at a row; half-way to the next measured row where it is the last one of its piece.

    `there` are the measured rows. Between two pieces nothing shows where it was.
    """
    if not trial.pieces:
        return place / (len(trial) - 1)
    time, after = trial.time, np.flatnonzero(there[place + 1 :])
    at = time[place]
    if len(after):
        following = place + 1 + int(after[0])
        if not any(piece.start <= place and following < piece.stop for piece in trial.runs):
            at = 0.5 * (at + time[following])
    return float(at - time[0]) / float(time[-1] - time[0])
