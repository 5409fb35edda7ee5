"""The rim of an open surface: where nearest points gather that have no partner."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.geometry.neighbours import neighbours
from geocontact.geometry.surface import Surface

NEAR = 1e-9  # of a face's longest edge: a point so near to an edge lies on it


def on_boundary(
    surface: Surface, points: Float[np.ndarray, "n 3"], face: Int[np.ndarray, " n"]
) -> Bool[np.ndarray, " n"]:
    """Which points [m] of the surface, each on its face, lie on an edge or a corner where the surface ends."""
    faces = surface.topology.merged[surface.faces]
    ends = neighbours(faces) < 0
    corner = np.zeros(len(surface.vertices), bool)
    corner[faces[ends]] = True
    corner[np.roll(faces, -1, axis=1)[ends]] = True
    near = NEAR * surface.edge_length[face].max(axis=1)
    found = np.zeros(len(points), bool)
    for k in range(3):
        a, b = (surface.vertices[surface.faces[face, m % 3]] for m in (k, k + 1))
        along = b - a
        share = np.einsum("ij,ij->i", points - a, along) / np.maximum(np.einsum("ij,ij->i", along, along), 1e-300)
        foot = a + np.clip(share, 0.0, 1.0)[:, None] * along
        found |= ends[face, k] & (np.linalg.norm(points - foot, axis=1) <= near)
        found |= corner[faces[face, k]] & (np.linalg.norm(points - a, axis=1) <= near)
    return found
