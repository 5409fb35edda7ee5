"""The clip that every peer is given: area of triangles below an iso-line, in numpy."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int


def clipped_area(
    faces: Int[np.ndarray, "m 3"],
    area: Float[np.ndarray, " m"],
    distance: Float[np.ndarray, " n"],
    threshold: float,
) -> float:
    """Area [m^2] where `distance`, linear in each triangle, is <= `threshold` [m]; `area` is that of the whole faces.

    A corner cut off at the odd vertex 0 has the share f0 / (f0 - f1) * f0 / (f0 - f2) of its triangle.
    """
    f = distance - threshold
    below = f <= 0.0
    count = below[faces[:, 0]].astype(np.int8) + below[faces[:, 1]] + below[faces[:, 2]]
    crossed = np.flatnonzero((count == 1) | (count == 2))
    corner = f[faces[crossed]]
    single = count[crossed] == 1
    odd = np.argmax((corner <= 0.0) == single[:, None], axis=1)
    row = np.arange(len(crossed))
    f0, f1, f2 = corner[row, odd], corner[row, odd - 2], corner[row, odd - 1]
    tip = f0 / (f0 - f1) * f0 / (f0 - f2) * area[crossed]
    return float(area[count == 3].sum() + np.where(single, tip, area[crossed] - tip).sum())
