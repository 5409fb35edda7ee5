"""Roll-over shape: path of the centre of pressure in the shank's frame, as an arc (Hansen, Childress & Knox 2000).

The arc is the circle of least algebraic error (Kåsa 1976); a path that is straight has no radius.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True)
class Arc:
    """A circle through a path, lying above it.

    Parameters
    ----------
    radius
        [m]; infinite for a straight path, negative where it curves upwards.
    middle
        Of the circle, forward and up [m].
    off
        Root mean square distance of the path [m].
    """

    radius: float
    middle: tuple[float, float]
    off: float


def arc_through(points: Float[np.ndarray, "t 2"]) -> Arc:
    """Through a path in the sagittal plane, forward and up [m]; ValueError for fewer than three points."""
    if len(points) < 3:
        raise ValueError("an arc needs three points")
    base = points.mean(axis=0)
    x, y = (points - base).T
    matrix = np.column_stack([2.0 * x, 2.0 * y, np.ones(len(x))])
    (a, b, c), *_ = np.linalg.lstsq(matrix, x**2 + y**2, rcond=None)
    radius = float(np.sqrt(max(c + a**2 + b**2, 0.0)))
    off = np.hypot(x - a, y - b) - radius
    sign = 1.0 if b >= 0.0 else -1.0
    return Arc(sign * radius, (float(base[0] + a), float(base[1] + b)), float(np.sqrt(np.mean(off**2))))
