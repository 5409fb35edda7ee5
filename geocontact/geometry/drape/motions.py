"""How a mat can be moved over a surface as a whole: along its rows, along its columns, turned; a belt is tilted."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.geometry.drape.mat import Mat
from geocontact.geometry.drape.positions import directions
from geocontact.geometry.drape.spread import Way


def motions(
    mat: Mat, points: Float[np.ndarray, "r1 c1 3"], cells: Float[np.ndarray, "k 2"], belt: Way | None = None
) -> Float[np.ndarray, "m k 3"]:
    """Velocities along the surface at positions counted in cells, one row per motion; NaN off the surface.

    Along rows and along columns by 1 m/m, and turned about the mat's middle by 1 rad in the plane that it has when it
    is flat: a = (a1, a2) away from the middle goes (-a2, a1). A belt of length L meets itself and cannot turn so; as a
    ring of radius L / 2 pi it is tilted instead, about two axes: across it by L / 2 pi times cosine and sine of the
    angle 2 pi a / L that it has gone around.
    """
    row, column = directions(points, cells).transpose(1, 0, 2)
    ahead, aside = mat.away(cells).T
    if belt is None:
        return np.stack([row, column, ahead[:, None] * column - aside[:, None] * row])
    length = mat.rows * mat.pitch[0] if belt == "rows" else mat.columns * mat.pitch[1]
    across, gone = (column, ahead) if belt == "rows" else (row, aside)
    radius, angle = length / (2.0 * np.pi), 2.0 * np.pi * gone[:, None] / length
    return np.stack([row, column, radius * np.cos(angle) * across, radius * np.sin(angle) * across])
