"""How much of a change of a prediction the residuals of some trials hold: whether their error falls or grows by it.

With b the residual of a model and m what a change makes of its prediction, the squared error falls by

    sum b² - sum (b - m)² = (2 a - 1) sum m²,   a = sum b m / sum m².

The standard error of a is from blocks of the trials, whatever the noise within and between neighbouring blocks is
(Newey & West 1987, Econometrica 55:703), no less than that of independent samples: few blocks that hold the change
tell little, however many samples they have. What a trial differs by from the others lies in all of its blocks with one
sign, so where that is known its part of the work is squared as a whole.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int
from scipy.special import stdtrit

from geocontact.gap.levels import SLIGHT
from geocontact.identify.intervals.quantile_intervals import CONFIDENCE
from geocontact.identify.optimise.bounded_gauss_newton import ROUNDING

BLOCKS = 16  # per trial


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
        return self.low > 0.5

    @property
    def words(self) -> str:
        """With its interval."""
        return f"amplitude there {self.value:.2f} [{self.low:.2f}, {self.high:.2f}], 1 where the change is right"

    @property
    def worse(self) -> bool:
        """Whether the error surely grows, by more than what makes no difference."""
        return self.high < 0.5 and self.grown > SLIGHT


def block_edges(count: int) -> Int[np.ndarray, " b"]:
    """Where the blocks of a trial of so many rows begin; a short trial has fewer."""
    return np.unique(np.linspace(0, count, BLOCKS + 1).astype(int)[:-1])


def amplitude(
    before: Sequence[Float[np.ndarray, "_ c"]],
    change: Sequence[Float[np.ndarray, "_ c"]],
    deviation: Sequence[Float[np.ndarray, "_ c"]] = (),
) -> Amplitude | None:
    """Amplitude of a change of a prediction in trials with the residuals `before`, both weighed; None where there is
    none.

    `deviation` is what of these residuals the trials differ by, nothing where that is not to count as chance.
    """
    works, powers, squares = [], [], 0.0
    for own, moved in zip(before, change, strict=True):
        edges = block_edges(len(own))
        works.append(np.add.reduceat((own * moved).sum(axis=1), edges))
        powers.append(np.add.reduceat((moved**2).sum(axis=1), edges))
        squares += float((own**2).sum())
    power, work = float(np.sum(powers)), float(np.sum(works))
    if not ROUNDING * squares < power < np.inf:
        return None
    value = work / power
    off = [w - value * p for w, p in zip(works, powers, strict=True)]
    pairs = zip(before, change, strict=True)
    alone = sum(float(((moved * (own - value * moved)).sum(axis=1) ** 2).sum()) for own, moved in pairs)
    spread = max(sum(float(each @ each) + float(each[1:] @ each[:-1]) for each in off), alone)
    spread += sum(float((own * moved).sum()) ** 2 for own, moved in zip(deviation, change, strict=False))
    count = power**2 / float(np.sum(np.square(powers)))
    freedom = max(count - 1.0, 0.5)
    error = float(np.sqrt(spread * (count / freedom))) / power
    reach = float(stdtrit(freedom, 0.5 + 0.5 * CONFIDENCE)) * error
    return Amplitude(value, value - reach, value + reach, (power - 2.0 * work) / max(squares, 1e-300))
