"""Which of several quantities the spread of a result comes from.

Sobol' indices share out the variance between independent factors, whatever the shape of the function: the first-order
one is what knowing the factor would take away, the total one what is left when all others are known. Regression on
ranks asks for no independence, but sees only what rises or falls throughout, or with the distance from the median.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float

from geocontact.identify.intervals.quantile_intervals import ENDS

POINTS = 2**11
"""Samples of each of the matrices of Sobol' indices; a power of two, as their points ask for."""

REPEATS = 16
"""Independent scramblings of the points, whose scatter gives the intervals."""


@dataclass(frozen=True, eq=False)
class Indices:
    """First-order and total indices (f,) with intervals of 95 % (f, 2)."""

    first: Float[np.ndarray, " f"]
    total: Float[np.ndarray, " f"]
    first_interval: Float[np.ndarray, "f 2"]
    total_interval: Float[np.ndarray, "f 2"]


def variance_shares(
    of: Callable[[Float[np.ndarray, "n f"]], Float[np.ndarray, " n"]], factors: int, seed: int
) -> Indices | None:
    """Sobol' indices of a function of `factors` numbers between 0 and 1; None where it is constant or not finite.

    Estimators of Saltelli et al. (2010) on scrambled Sobol' points, as scipy has them; means of independent
    scramblings with Student's intervals.
    """
    from scipy.stats import sobol_indices, t, uniform

    spread: list[bool] = []

    def evaluated(shares: Float[np.ndarray, "f n"]) -> Float[np.ndarray, "1 n"]:
        found = of(np.ascontiguousarray(shares[:factors].T))
        spread.append(bool(np.isfinite(found).all() and (found != found[0]).any()))
        return (found if spread[-1] else shares[0])[None, :]

    dists: list[Any] = [uniform()] * max(factors, 2)  # scipy takes two or more; a second one may do nothing
    runs = [
        sobol_indices(func=evaluated, n=POINTS, dists=dists, rng=rng)
        for rng in np.random.default_rng(seed).spawn(REPEATS)
    ]
    if not all(spread):
        return None
    first, total = (
        np.array([np.ravel(getattr(run, each))[:factors] for run in runs]) for each in ("first_order", "total_order")
    )
    wide = float(t.ppf(ENDS[1], REPEATS - 1)) / np.sqrt(REPEATS)
    ends = [
        each.mean(axis=0)[:, None] + wide * each.std(axis=0, ddof=1)[:, None] * np.array([-1.0, 1.0])
        for each in (first, total)
    ]
    return Indices(first.mean(axis=0), total.mean(axis=0), *ends)


@dataclass(frozen=True, eq=False)
class RankRegression:
    """Standardised coefficients of the ranks (q,) and of those of the distance from the median (q,).

    `explained` is the share of the variance of the result's ranks that they explain; all are 0 where it is constant.
    """

    coefficients: Float[np.ndarray, " q"]
    of_distance: Float[np.ndarray, " q"]
    explained: float


def rank_regression(quantities: Float[np.ndarray, "n q"], result: Float[np.ndarray, " n"]) -> RankRegression:
    """Least squares on standardised ranks (Iman & Conover, Technometrics 21, 1979); infinite results are the last.

    Not theirs: the ranks of each quantity's distance from its median stand beside its own, for what acts either way.
    """
    from scipy.stats import rankdata

    distance = np.abs(quantities - np.median(quantities, axis=0))
    ranks = rankdata(np.column_stack([quantities, distance, result]), axis=0)
    spread = ranks.std(axis=0)
    ranks = (ranks - ranks.mean(axis=0)) / np.where(spread > 0.0, spread, 1.0)
    design, answer = ranks[:, :-1], ranks[:, -1]
    found = np.linalg.lstsq(design, answer, rcond=None)[0]
    own, far = np.split(found, 2)
    return RankRegression(own, far, float(np.mean(answer**2) - np.mean((answer - design @ found) ** 2)))
