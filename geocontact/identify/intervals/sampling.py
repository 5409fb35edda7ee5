"""Quantities that differ from person to person: samples of them, and what the spread of a result comes from.

Everything is drawn as numbers between 0 and 1, one per factor, and turned into quantities by the factor's quantile
function. Correlated factors are correlated in their normal scores (Gaussian copula; Nelsen, An Introduction to Copulas,
2006), so that each keeps its own distribution.

Sobol' indices share out the variance between independent factors, whatever the shape of the function: the first-order
one is what knowing the factor would take away, the total one what is left when all others are known. Regression on
ranks asks for no independence, but sees only what rises or falls throughout, or with the distance from the median.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Float
from scipy.special import ndtr, ndtri

from geocontact.identify.intervals.quantile_intervals import ENDS


@dataclass(frozen=True)
class Normal:
    """A quantity of that mean and standard deviation before it is cut off at `lower` and `upper`."""

    name: str
    mean: float
    sd: float
    lower: float = -np.inf
    upper: float = np.inf

    @property
    def names(self) -> tuple[str, ...]:
        """Quantities of the factor."""
        return (self.name,)

    def quantile(self, share: Float[np.ndarray, " n"]) -> Float[np.ndarray, "n q"]:
        """Value below which that share of people is."""
        first, last = (float(ndtr((end - self.mean) / self.sd)) for end in (self.lower, self.upper))
        drawn = self.mean + self.sd * ndtri(first + share * (last - first))
        return np.asarray(np.clip(drawn, self.lower, self.upper))[:, None]


@dataclass(frozen=True)
class Uniform:
    """A quantity that is anywhere between `lower` and `upper`."""

    name: str
    lower: float
    upper: float

    @property
    def names(self) -> tuple[str, ...]:
        """Quantities of the factor."""
        return (self.name,)

    def quantile(self, share: Float[np.ndarray, " n"]) -> Float[np.ndarray, "n q"]:
        """Value below which that share of people is."""
        return np.asarray(self.lower + share * (self.upper - self.lower))[:, None]


@dataclass(frozen=True, eq=False)
class People:
    """Quantities that were measured on people, a row each; a row is drawn whole, with the correlation that it has."""

    names: tuple[str, ...]
    rows: Float[np.ndarray, "m q"]

    def quantile(self, share: Float[np.ndarray, " n"]) -> Float[np.ndarray, "n q"]:
        """The row at that share of the table."""
        return np.asarray(self.rows[np.minimum((share * len(self.rows)).astype(int), len(self.rows) - 1)])


Factor = Normal | Uniform | People


@dataclass(frozen=True, eq=False)
class Sampling:
    """Factors, the correlation of their normal scores, and quantities that are the same for everybody."""

    factors: Sequence[Factor]
    correlation: Float[np.ndarray, "f f"]
    fixed: dict[str, float]

    @property
    def independent(self) -> bool:
        """Whether no two factors are correlated."""
        return not (self.correlation - np.eye(len(self.factors))).any()

    def shares(self, count: int, seed: int) -> Float[np.ndarray, "n f"]:
        """Numbers between 0 and 1, correlated as asked for."""
        rng = np.random.default_rng(seed)
        if self.independent:
            return rng.random((count, len(self.factors)))
        return np.asarray(ndtr(rng.standard_normal((count, len(self.factors))) @ root(self.correlation).T))

    def quantities(self, shares: Float[np.ndarray, "n f"], names: Sequence[str]) -> Float[np.ndarray, "n q"]:
        """Quantities in the order of `names`."""
        columns = {name: np.full(len(shares), value) for name, value in self.fixed.items()}
        for factor, share in zip(self.factors, shares.T, strict=True):
            columns |= dict(zip(factor.names, factor.quantile(share).T, strict=True))
        return np.column_stack([columns[name] for name in names])


def root(correlation: Float[np.ndarray, "f f"]) -> Float[np.ndarray, "f f"]:
    """Matrix whose product with its transpose is the correlation; ValueError where no quantities can have it."""
    try:
        return np.linalg.cholesky(correlation)
    except np.linalg.LinAlgError:
        raise ValueError("no quantities can be correlated like that (the matrix is not positive definite)") from None


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
