"""Quantiles and exceedance of independent samples with intervals that hold for any distribution.

A value may be infinite: a sample that is worse than anything is still a sample.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.special import betaincinv

CONFIDENCE = 0.95
ENDS = (0.5 * (1.0 - CONFIDENCE), 0.5 * (1.0 + CONFIDENCE))  # of an interval, as shares of a distribution


@dataclass(frozen=True)
class IntervalEstimate:
    """A number and its interval of 95 %."""

    value: float
    lower: float
    upper: float


def quantile(ordered: Float[np.ndarray, " n"], share: float) -> IntervalEstimate:
    """Value that `share` of the population does not exceed, from samples in rising order.

    The interval is between two of the samples: the number of samples under the true quantile is binomial (David &
    Nagaraja, Order Statistics, 2003, 7.1). An end is infinite where there are too few samples for it.
    """
    from scipy.stats import binom

    n, tail = len(ordered), 0.5 * (1.0 - CONFIDENCE)
    first, last = int(binom.ppf(tail, n, share)), int(binom.ppf(1.0 - tail, n, share)) + 1
    lower = float(ordered[first - 1]) if first >= 1 else -np.inf
    upper = float(ordered[last - 1]) if last <= n else np.inf
    return IntervalEstimate(float(ordered[max(int(np.ceil(share * n)), 1) - 1]), lower, upper)


def probability(count: int, of: int) -> IntervalEstimate:
    """Probability of what happened `count` times in `of`, with the exact interval of Clopper and Pearson (1934)."""
    tail = 0.5 * (1.0 - CONFIDENCE)
    lower = float(betaincinv(count, of - count + 1, tail)) if count else 0.0
    upper = float(betaincinv(count + 1, of - count, 1.0 - tail)) if count < of else 1.0
    return IntervalEstimate(count / of, lower, upper)
