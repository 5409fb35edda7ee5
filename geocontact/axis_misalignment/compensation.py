"""A compensation joint that slides freely between its stroke ends, and the force beyond them.

The joint takes up the deflection as long as it lies between the ends, so F = k (d - min(max(d, lower), upper)); locked,
both ends are 0. All that a limit on |F| asks of the ends follows from the least and the largest deflection.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True)
class Compensation:
    """Stiffness k of the attachment [N/m] and stroke ends of the joint [m]; locked unless stated otherwise."""

    stiffness: float
    lower: float = 0.0
    upper: float = 0.0

    def force(self, deflection: Float[np.ndarray, "*shape"]) -> Float[np.ndarray, "*shape"]:
        """Force on the limb [N], positive where the attachment is deflected towards the joint."""
        return np.asarray(self.stiffness * taken_up(deflection, (self.lower, self.upper))[1])

    def peak(self, extremes: Float[np.ndarray, "n 2"]) -> Float[np.ndarray, " n"]:
        """Largest |F| [N] over a range in which the deflection has these extremes; NaN is kept."""
        return self.stiffness * beyond(extremes, self.lower, self.upper)


def taken_up(
    total: Float[np.ndarray, "*shape"], stroke: tuple[float, float]
) -> tuple[Float[np.ndarray, "*shape"], Float[np.ndarray, "*shape"]]:
    """Displacement of a joint that slides freely from `stroke[0]` to `stroke[1]` [m], and what is left for the cuff.

    `total` is d_tot [m]. A locked joint has both ends at 0. ValueError where the stroke ends before it begins.
    """
    low, high = stroke
    if low > high:
        raise ValueError(f"a stroke from {low * 1e3:g} to {high * 1e3:g} mm ends before it begins")
    moved = np.clip(total, low, high)
    return moved, np.asarray(total - moved)


def beyond(extremes: Float[np.ndarray, "n 2"], lower: float, upper: float) -> Float[np.ndarray, " n"]:
    """How far a deflection between these extremes goes beyond the stroke at most, to either side [m]; NaN is kept."""
    return np.asarray(np.maximum(np.maximum(extremes[:, 1] - upper, lower - extremes[:, 0]), 0.0))


def needed_ends(extremes: Float[np.ndarray, "n 2"], slack: float) -> Float[np.ndarray, "n 2"]:
    """Stroke ends [m] that keep |F| under k `slack` while the deflection goes between these extremes [m].

    The lower end must not be above the first, the upper end not below the second. Where the first is the larger of the
    two no stroke is needed: a joint locked anywhere between them will do.
    """
    return np.asarray(extremes + slack * np.array([1.0, -1.0]))
