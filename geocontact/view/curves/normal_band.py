"""Quantiles of a sample against the normal distribution, with a band that holds for all of them at once.

The band is the tail-sensitive one of Aldor-Noiman, Brown, Buja, Rolke and Stine (2013), "The Power to See: A New
Graphical Test of Normality", The American Statistician 67(4), 249-260: each order statistic of a uniform sample is
beta-distributed, and the pointwise level is lowered until all n points lie within with the probability asked for.
Here the simulated samples are standardised by their own mean and SD, as the drawn line is, so that the level holds
where both are estimated. It holds for independent samples only: neighbours in a time series are not.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from jaxtyping import Float, Int
from scipy.stats import beta, norm

SIMULATED = 2000  # samples; the level of a 95 % band is then known to ± 0.5 % (one standard error)
RANKS = 400  # of a large sample that are simulated; between them the band follows the same formula


@dataclass(frozen=True)
class NormalQuantiles:
    """Sorted sample beside the quantiles of the standard normal distribution.

    theoretical
        Medians of the standard normal order statistics.
    ordered
        Sample, sorted.
    lower, upper
        Band around `mean` + `sd` × `theoretical`, simultaneous over all points.
    p
        Share of normal samples whose worst point is at least as far out as the worst one here.
    """

    theoretical: Float[np.ndarray, " n"]
    ordered: Float[np.ndarray, " n"]
    lower: Float[np.ndarray, " n"]
    upper: Float[np.ndarray, " n"]
    mean: float
    sd: float
    p: float


def normal_quantiles(sample: Float[np.ndarray, " n"], level: float = 0.95) -> NormalQuantiles:
    """Compare a sample with the normal distribution of its own mean and SD (n - 1).

    The simulation has a fixed seed: the same number of values gives the same band.
    """
    n = len(sample)
    mean, sd = float(np.mean(sample)), float(np.std(sample, ddof=1))
    if sd <= 1e-12 * abs(mean):
        raise ValueError(f"residual: all {n} values are {mean:g}; a constant has no distribution to compare")
    ordered, rank = np.sort(sample), np.arange(1, n + 1)
    worst = _worst_of_normal_samples(n)
    depth = float(np.quantile(worst, 1.0 - level))
    found = _depth((ordered - mean) / sd, rank, n).min()
    lowest = np.asarray(norm.ppf(beta.ppf(depth / 2.0, rank, n + 1 - rank)))
    return NormalQuantiles(
        theoretical=np.asarray(norm.ppf(beta.median(rank, n + 1 - rank))),
        ordered=ordered,
        lower=mean + sd * lowest,
        upper=mean - sd * lowest[::-1],
        mean=mean,
        sd=sd,
        p=float((1 + np.sum(worst <= found)) / (1 + SIMULATED)),
    )


def _depth(standardised: Float[np.ndarray, "*s r"], rank: Int[np.ndarray, " r"], n: int) -> Float[np.ndarray, "*s r"]:
    """Two-sided p-value of each order statistic of n."""
    below = beta.cdf(norm.cdf(standardised), rank, n + 1 - rank)
    above = beta.sf(norm.cdf(standardised), rank, n + 1 - rank)
    return np.asarray(2.0 * np.minimum(below, above))


@lru_cache(maxsize=16)
def _worst_of_normal_samples(n: int) -> Float[np.ndarray, " simulated"]:
    """Smallest p-value over the order statistics of each of many normal samples."""
    rng = np.random.default_rng(20130667)
    tail = np.unique(np.geomspace(1, (n + 1) // 2, min(n, RANKS // 2)).astype(int))
    rank = np.unique(np.r_[tail, n + 1 - tail]) if n > RANKS else np.arange(1, n + 1)
    worst = np.empty(SIMULATED)
    for k in range(SIMULATED):
        drawn = np.sort(rng.standard_normal(n))
        worst[k] = _depth((drawn[rank - 1] - drawn.mean()) / drawn.std(ddof=1), rank, n).min()
    return worst
