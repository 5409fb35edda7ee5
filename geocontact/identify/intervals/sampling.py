"""Samples of quantities that differ from person to person: distributions, tables of measured people, correlation.

Everything is drawn as numbers between 0 and 1, one per factor, and turned into quantities by the factor's quantile
function. Correlated factors are correlated in their normal scores (Gaussian copula; Nelsen, An Introduction to Copulas,
2006), so that each keeps its own distribution.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.special import ndtr, ndtri


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
