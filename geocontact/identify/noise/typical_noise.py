"""Standard deviation of noise from medians, which a few large values do not move, and from differences."""

from __future__ import annotations

from math import comb
from statistics import NormalDist

import numpy as np
from jaxtyping import Float

QUARTILE = NormalDist().inv_cdf(0.75)  # that half of the magnitudes of standard normal numbers lie below


def typical_noise(values: Float[np.ndarray, " n"], differences: int = 0) -> float:
    """Standard deviation of normal noise, in the unit of `values`, that has their median magnitude; 0 without values.

    `values` are its differences of that order k: of white noise these have (2k over k) times its variance, the sum of
    the squared binomial coefficients.
    """
    if not len(values):
        return 0.0
    return float(np.median(np.abs(values))) / QUARTILE / float(np.sqrt(comb(2 * differences, differences)))
