"""Errors on held-out trials: how much of a change they hold, and which share of them is gone.

With b the residual of a model and m what a change makes of its prediction, the squared error falls by

    sum b² - sum (b - m)² = (2 a - 1) sum m²,   a = sum b m / sum m².

The standard error of a is from blocks of the trials, whatever the noise within and between neighbouring blocks is
(Newey & West 1987, Econometrica 55:703), no less than that of independent samples: few blocks that hold the change
tell little, however many samples they have.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.gap.case.plain_fit import Plain
from geocontact.gap.case.whitening import Whitening

BLOCKS = 16  # per trial
SURE = 0.975  # one-sided
HALF = 0.5  # amplitude below which a change makes the error larger
NOTHING = 1e-12  # of the squared residual, below which a prediction is not changed
HARM = 0.02  # of a channel's squared error, that it may surely grow by; the sum over the channels may not grow at all


@dataclass(frozen=True)
class Amplitude:
    """How much of a change the held-out trials have: 1 all of it, 0 nothing.

    Parameters
    ----------
    value, low, high
        With its interval of 95 %.
    grown
        What the change adds to the squared error, as a share of it; negative where the error falls.
    """

    value: float
    low: float
    high: float
    grown: float

    @property
    def better(self) -> bool:
        """Whether the error surely falls."""
        return self.low > HALF

    @property
    def words(self) -> str:
        """With its interval."""
        return f"amplitude there {self.value:.2f} [{self.low:.2f}, {self.high:.2f}], 1 where the change is right"

    @property
    def worse(self) -> bool:
        """Whether the error surely grows, by more than what makes no difference."""
        return self.high < HALF and self.grown > HARM


def block_edges(count: int) -> Int[np.ndarray, " b"]:
    """Where the blocks of a trial of so many rows begin; a short trial has fewer."""
    return np.unique(np.linspace(0, count, BLOCKS + 1).astype(int)[:-1])


def amplitude(
    before: Sequence[Float[np.ndarray, "_ c"]], change: Sequence[Float[np.ndarray, "_ c"]]
) -> Amplitude | None:
    """Of a change of a prediction in trials with the residuals `before`, both weighed; None where there is none."""
    from scipy.stats import t

    works, powers, squares = [], [], 0.0
    for own, moved in zip(before, change, strict=True):
        edges = block_edges(len(own))
        works.append(np.add.reduceat((own * moved).sum(axis=1), edges))
        powers.append(np.add.reduceat((moved**2).sum(axis=1), edges))
        squares += float((own**2).sum())
    power, work = float(np.sum(powers)), float(np.sum(works))
    if not NOTHING * squares < power < np.inf:
        return None
    value = work / power
    off = [w - value * p for w, p in zip(works, powers, strict=True)]
    pairs = zip(before, change, strict=True)
    alone = sum(float(((moved * (own - value * moved)).sum(axis=1) ** 2).sum()) for own, moved in pairs)
    spread = max(sum(float(each @ each) + float(each[1:] @ each[:-1]) for each in off), alone)
    count = power**2 / float(np.sum(np.square(powers)))
    freedom = max(count - 1.0, 0.5)
    error = float(np.sqrt(spread * (count / freedom))) / power
    reach = float(t.ppf(SURE, freedom)) * error
    return Amplitude(value, value - reach, value + reach, (power - 2.0 * work) / max(squares, 1e-300))


@dataclass(frozen=True)
class TrialWeight:
    """What a residual of one trial weighs: (I + B Q Bᵀ)^(-1/2) D⁻¹, D the floor, B Q Bᵀ what trials differ by."""

    present: Bool[np.ndarray, "t c"]
    whitening: Whitening

    @classmethod
    def of(
        cls, present: Bool[np.ndarray, "t c"], floor: Float[np.ndarray, " c"], varied: Float[np.ndarray, "t c q"]
    ) -> TrialWeight:
        """From derivatives with respect to what varies, times its standard deviation."""
        return cls(present, Whitening.of(Plain(present, floor), varied))

    def __call__(self, values: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "t c"]:
        """Weighed; 0 where nothing was measured."""
        out = np.zeros(values.shape)
        out[self.present] = self.whitening(values[..., None])[:, 0]
        return out

    def cleared(self, values: Float[np.ndarray, "t c"]) -> Float[np.ndarray, "t c"]:
        """What is left of a residual r, in units of the floor, once the trial's own deviation d is taken out.

        The most probable d is that of the least |r - B d|² + dᵀ Q⁻¹ d; what it leaves is r - B d = (I + B Q Bᵀ)⁻¹ r.
        """
        w, out = self.whitening, np.zeros(values.shape)
        white = w.whitener(values[..., None])[:, 0]
        out[self.present] = white - w.directions @ ((1.0 - (1.0 - w.gains) ** 2) * (w.directions.T @ white))
        return out


def taken_away(before: Sequence[Float[np.ndarray, "_ c"]], after: Sequence[Float[np.ndarray, "_ c"]]) -> float:
    """The largest share of a channel's squared error that is gone, below 0 where all grow; 0 where nothing is there."""
    old, new = (np.sum([(part**2).sum(axis=0) for part in parts], axis=0) for parts in (before, after))
    return float(np.max(1.0 - new[old > 0.0] / old[old > 0.0], initial=-np.inf)) if (old > 0.0).any() else 0.0
