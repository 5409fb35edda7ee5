"""A compensation joint along the limb takes up the displacement between its stroke ends, the cuff the rest."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def taken_up(
    total: Float[np.ndarray, " n"], stroke: tuple[float, float]
) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, " n"]]:
    """Displacement of a joint that slides freely from `stroke[0]` to `stroke[1]` [m], and what is left for the cuff.

    `total` is d_tot [m]. A locked joint has both ends at 0. ValueError where the stroke ends before it begins.
    """
    low, high = stroke
    if low > high:
        raise ValueError(f"a stroke from {low * 1e3:g} to {high * 1e3:g} mm ends before it begins")
    moved = np.clip(total, low, high)
    return moved, np.asarray(total - moved)
