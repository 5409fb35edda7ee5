"""When samples are taken, and which of them are kept."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

Rng = np.random.Generator


@dataclass(frozen=True)
class Clock:
    """An even clock that now and then loses rows, unless told otherwise.

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
