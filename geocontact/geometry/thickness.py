"""How thick a body is under each point of its surface, along the normal there."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.geometry.kernels.ray import exits
from geocontact.geometry.surface import Surface


def thickness_below(
    surface: Surface,
    points: Float[np.ndarray, "n 3"],
    normals: Float[np.ndarray, "n 3"],
    limit: float = np.inf,
) -> Float[np.ndarray, " n"]:
    """Distance from each point into the body, against the normal, to where the ray first leaves the body [m].

    What an elastic foundation takes for the thickness of its layer. Infinite where the ray does not come out within
    `limit` [m]: at holes of an open surface. Near a rim the ray may come out at the side, close by: the layer there is
    as thin as this says only along the normal.

    Parameters
    ----------
    points
        On the surface, or inside the body [m].
    normals
        Outward unit normals there; of a face in it, `surface.face_normal`.
    """
    if not (np.isfinite(points).all() and np.isfinite(normals).all()):
        raise ValueError("points and normals must be finite")
    local = np.ascontiguousarray(points - surface.centre)
    inwards = np.ascontiguousarray(-normals)
    distance, _ = exits(surface.tree, local, inwards, float(limit), -1.0 if surface.inside_out else 1.0)
    return np.asarray(distance)
