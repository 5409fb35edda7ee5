"""Numbers that no quantity of this field has, in whatever unit: a digit or an exponent was damaged or mistyped."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

LARGEST_MEANT = 1e20
"""Beyond what is written anywhere, 64-bit clocks that count nanoseconds from 1970 (2e18) included."""
TOO_LARGE = "is larger than any number that is meant"


def too_large(values: Float[np.ndarray, "*shape"]) -> Bool[np.ndarray, "*shape"]:
    """Which of the finite values are; NaN and infinity are told of where a value is used."""
    return np.asarray(np.isfinite(values) & (np.abs(values) > LARGEST_MEANT))
