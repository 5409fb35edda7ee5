"""Many cycles together: mean and spread."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def mean_and_sd(trials: Float[np.ndarray, "trials t"]) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, " t"]]:
    """Mean and sample standard deviation (n - 1) at each instant over the trials that have a value there.

    NaN where no trial has one, and as SD where only one has. Where trials drop out, the mean may jump.
    """
    there = np.isfinite(trials)
    count = there.sum(axis=0)
    mean = np.where(there, trials, 0.0).sum(axis=0) / np.where(count > 0, count, np.nan)
    squares = np.where(there, trials - mean, 0.0) ** 2
    return mean, np.sqrt(squares.sum(axis=0) / np.where(count > 1, count - 1.0, np.nan))
