"""The outline of a surface as seen from far along one direction."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float, Int


def silhouette(
    vertices: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"], direction: Float[np.ndarray, " 3"]
) -> Int[np.ndarray, "e 2"]:
    """Edges (pairs of vertices) where the surface turns away from `direction`, and open edges.

    Parameters
    ----------
    vertices, faces
        Triangle surface; corners in one sense of rotation. A vertex that stands twice counts twice: merge it before.
    direction
        From the surface towards the eye.
    """
    a, b, c = (vertices[faces[:, k]] for k in range(3))
    looks = np.cross(b - a, c - a) @ direction > 0.0
    corners = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges, which = np.unique(np.sort(corners, axis=1), axis=0, return_inverse=True)
    seen = np.bincount(which.ravel(), np.tile(looks, 3), len(edges))
    around = np.bincount(which.ravel(), minlength=len(edges))
    return np.asarray(edges[((seen > 0) & (seen < around)) | (around == 1)])
