"""Numbers that no quantity of this field has, in whatever unit: a digit or an exponent was damaged or mistyped."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.plausible import LARGEST_MEANT


def too_large(values: Float[np.ndarray, "*shape"]) -> Bool[np.ndarray, "*shape"]:
    """Which of the finite values are; NaN and infinity are named where a value is used."""
    return np.asarray(np.isfinite(values) & (np.abs(values) > LARGEST_MEANT))
