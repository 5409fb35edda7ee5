"""Tails of usual distributions in nats: up to some 745, and infinite beyond, where a probability is 0.

`scipy.stats` has the same numbers; it takes 0.3 s to import, `scipy.special` is loaded already.
"""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.special import chdtr, chdtrc, fdtr, fdtrc, gammainc, gammaincc, pdtrc


def chi_square_nats(value: float, freedom: int) -> float:
    """-ln P(X >= value) of a χ² of `freedom` degrees of freedom.

    >>> round(chi_square_nats(10.0, 2), 12)
    5.0
    """
    return float(_nats(np.asarray(chdtr(freedom, value)), np.asarray(chdtrc(freedom, value))))


def f_nats(ratio: Float[np.ndarray, "*n"], above: int, below: int | Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
    """-ln P(X >= ratio) of Fisher's F with `above` and `below` degrees of freedom."""
    return _nats(np.asarray(fdtr(above, below, ratio)), np.asarray(fdtrc(above, below, ratio)))


def gamma_nats(value: float, shape: int) -> float:
    """-ln P(X >= value) of a gamma distribution of scale 1: of a sum of `shape` exponential ones."""
    return float(_nats(np.asarray(gammainc(shape, value)), np.asarray(gammaincc(shape, value))))


def poisson_nats(count: int, mean: float) -> float:
    """-ln P(N >= count) of a Poisson distribution, `count` 1 or more."""
    with np.errstate(divide="ignore"):
        return -float(np.log(pdtrc(count - 1, mean)))


def _nats(lower: Float[np.ndarray, "*n"], upper: Float[np.ndarray, "*n"]) -> Float[np.ndarray, "*n"]:
    """-ln of the upper tail, by the lower one where that is the smaller: 1 - upper is lost to rounding there."""
    with np.errstate(divide="ignore"):
        return np.asarray(np.where(lower < 0.5, -np.log1p(-lower), -np.log(upper)))
