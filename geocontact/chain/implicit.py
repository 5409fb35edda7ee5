"""Root of a load that feeds back on the deflection that makes it: one unknown per sample."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.geometry.kernels.compile import kernel

TOLERANCE = 1e-10
"""Largest residual of a solved load, over the load (or over the load scale where the load is smaller)."""
ATTEMPTS = 100
FINEST = 1e-8
"""Distance of two attempts, over the load and one unit more, below which rounding makes the slope between them."""
BELOW, ABOVE, LAST, RESIDUAL, COUNT, SLOPE = range(6)


@kernel
def nothing_known() -> Float[np.ndarray, " six"]:
    """State of a search before the first sample."""
    return np.array([-np.inf, np.inf, np.nan, np.nan, 0.0, 1.0])


@kernel
def start_over(search: Float[np.ndarray, " six"]) -> None:
    """Forget the last root, but not how steep the residual was there."""
    search[BELOW], search[ABOVE] = -np.inf, np.inf
    search[LAST] = search[RESIDUAL] = np.nan
    search[COUNT] = 0.0


@kernel
def next_load(load: float, residual: float, search: Float[np.ndarray, " six"]) -> float:
    """Where to look after `load` left `residual` = load - what the law gives for it.

    Secant through the last two attempts, at first with the slope found at the sample before; once the root lies between
    two attempts, a guess outside is replaced by their middle, and so is every fourth, which bounds the number of
    attempts whatever the law looks like. The residual rises with the load wherever more load means less deflection.
    """
    if residual < 0.0:
        search[BELOW] = max(search[BELOW], load)
    else:
        search[ABOVE] = min(search[ABOVE], load)
    apart = load - search[LAST]
    slope = (residual - search[RESIDUAL]) / apart
    if np.isfinite(slope) and slope > 0.0 and abs(apart) > FINEST * (1.0 + abs(load)):
        search[SLOPE] = slope
    search[LAST], search[RESIDUAL] = load, residual
    search[COUNT] += 1.0
    guess = load - residual / search[SLOPE]
    low, high = search[BELOW], search[ABOVE]
    stuck = search[COUNT] % 4.0 == 0.0
    if low < high and np.isfinite(low) and np.isfinite(high) and (stuck or not low < guess < high):
        return float(0.5 * (low + high))
    return float(guess)


class NotConverged(ArithmeticError):  # noqa: N818
    """A load could not be found at some samples; nothing that depends on it can be trusted."""


def require_convergence(unsolved: int, samples: int, compliance: float) -> None:
    """Raise when samples are left without a solution."""
    if unsolved:
        raise NotConverged(
            f"series compliance {compliance:g}: {unsolved} of {samples} samples have no load within {TOLERANCE:g}; "
            "a smaller compliance has one"
        )
