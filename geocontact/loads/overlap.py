"""How deep the pieces of one surface lie inside another body, smooth surfaces allowed for."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.curvature import phong_offset
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import SurfaceQuadrature

USUAL = 1e-3
"""m; deeper points are looked for in a second, slower query."""


@dataclass(frozen=True, eq=False)
class Overlap:
    """Depth of each piece inside a body, and what of the body is next to it, in the body's own frame.

    Parameters
    ----------
    depth
        [m]; 0 where there is none.
    distance
        Signed distance to the body's triangles [m]; infinite where that is of no matter.
    normal
        Gradient of that distance.
    face, closest
        Face of the body that is next to the piece, and the point of it [m].
    """

    depth: Float[np.ndarray, " p"]
    distance: Float[np.ndarray, " p"]
    normal: Float[np.ndarray, "p 3"]
    face: Int[np.ndarray, " p"]
    closest: Float[np.ndarray, "p 3"]


def overlap(
    pieces: SurfaceQuadrature,
    height: Float[np.ndarray, " p"] | None,
    moving: Surface,
    rotation: Float[np.ndarray, "3 3"],
    translation: Float[np.ndarray, " 3"],
    normals: Float[np.ndarray, "m 3 3"] | None,
) -> Overlap:
    """Depth of each piece inside `moving` at x = rotation x_moving + translation.

    Parameters
    ----------
    height
        Of the smooth surface above each piece [m]; None where triangles are taken as they are.
    normals
        `corner_normals` of `moving`; None where its triangles are taken as they are.
    """
    there = (pieces.point - translation) @ rotation
    near = moving.proximity(there, USUAL)
    distance, normal, face, closest = near.distance.copy(), near.normal.copy(), near.face.copy(), near.closest.copy()
    deep = np.isneginf(distance)
    if deep.any():
        found = moving.proximity(there[deep])
        distance[deep], normal[deep], face[deep] = found.distance, found.normal, found.face
        closest[deep] = found.closest
    smooth = distance if height is None else distance - height
    reached = np.flatnonzero(smooth < (0.0 if normals is None else USUAL))
    gap = smooth[reached]
    if normals is not None:
        gap = gap - phong_offset(moving, normals, face[reached], closest[reached])
    against = np.einsum("pi,pi->p", normal[reached] @ rotation.T, pieces.normal[reached])
    depth = np.zeros(len(distance))
    depth[reached] = np.where(against < 0.0, np.maximum(-gap, 0.0), 0.0)
    return Overlap(depth, distance, normal, face, closest)
