"""The one weighted centre: of areas, of normal forces, of pressures times cell areas."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def weighted_centre(
    points: Float[np.ndarray, "*t n 3"], weights: Float[np.ndarray, "*t n"], what: str = "centre"
) -> Float[np.ndarray, "*t 3"]:
    """Sum of w x over sum of w, for one set of points or a stack of sets.

    Weights are areas, normal forces or pressures times areas: not negative, and not all zero. A point of weight zero
    may be NaN. It lies within the convex hull of the points, moves with them and does not depend on their order or on
    the unit of the weights.

    Parameters
    ----------
    what
        What it is the centre of, for the message when there is none.
    """
    if (weights < 0.0).any() or not np.isfinite(weights).all():
        raise ValueError(f"no {what}: weights must be finite and not negative, smallest is {weights.min():g}")
    total = weights.sum(axis=-1)
    if not (total > 0.0).all():
        raise ValueError(f"no {what}: the {weights.shape[-1]} weights sum to 0")
    counted = np.where(weights[..., None] > 0.0, points, 0.0)
    return np.asarray(np.einsum("...n,...nk->...k", weights, counted) / total[..., None])
