"""A surface in small pieces, each a point with an area and a normal: what sums over a surface run over."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

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


MOST = 4_000_000
"""Pieces; more are refused, as a slip in the unit of the edge asks for them."""


@dataclass(frozen=True, eq=False)
class SurfaceQuadrature:
    """Pieces of a surface in its own frame; neighbours are close together in the list.

    Parameters
    ----------
    point
        Centroid of each piece [m].
    area
        Its area [m^2]; those of a face add up to the face's.
    normal
        Outward unit normal.
    face
        Face that it is a piece of.
    """

    point: Float[np.ndarray, "p 3"]
    area: Float[np.ndarray, " p"]
    normal: Float[np.ndarray, "p 3"]
    face: Int[np.ndarray, " p"]

    def face_means(self, values: Float[np.ndarray, " p"], faces: int) -> Float[np.ndarray, " f"]:
        """Mean of `values` over each of the `faces` faces, weighted with area; 0 where a face has no piece."""
        total = np.bincount(self.face, self.area * values, faces)
        area = np.bincount(self.face, self.area, faces)
        return np.divide(total, area, out=np.zeros(faces), where=area > 0.0)


def surface_quadrature(
    surface: Surface, edge: float = np.inf, faces: Bool[np.ndarray, " f"] | None = None
) -> SurfaceQuadrature:
    """Faces cut into n^2 congruent triangles each, n as large as edges of at most `edge` [m] ask for.

    Faces without area have no piece, and one that stands in the file twice counts once.

    Parameters
    ----------
    faces
        Which faces count; all without.
    """
    counts = (surface.face_area > 0.0) & ~surface.repeated
    if faces is not None:
        counts = counts & faces
    order = surface.tree.face[counts[surface.tree.face]]
    n = np.maximum(np.ceil(surface.edge_length[order].max(axis=1) / edge), 1.0)
    if (n**2).sum() > MOST:
        raise ValueError(f"edges of {edge * 1e3:g} mm make {(n**2).sum():.3g} pieces, more than {MOST:.0g}")
    points, owners = [], []
    for parts in np.unique(n).astype(int).tolist():
        mine = np.flatnonzero(n == parts)
        corners = surface.vertices[surface.faces[order[mine]]]
        weights = _centroids(parts)
        points.append(np.einsum("wk,fkc->fwc", weights, corners).reshape(-1, 3))
        owners.append(np.repeat(mine, len(weights)))
    owner = np.concatenate(owners) if owners else np.zeros(0, np.int64)
    along = np.argsort(owner, kind="stable")
    face = order[owner[along]]
    return SurfaceQuadrature(
        point=np.concatenate(points)[along] if points else np.zeros((0, 3)),
        area=surface.face_area[face] / n[owner[along]] ** 2,
        normal=surface.face_normal[face],
        face=face,
    )


def _centroids(n: int) -> Float[np.ndarray, "w 3"]:
    """Barycentric coordinates of the centroids of n^2 congruent pieces of a triangle."""
    i, j = (axis.ravel() for axis in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    upright, turned = i + j < n, i + j < n - 1
    first = np.concatenate([i[upright] + 1.0 / 3.0, i[turned] + 2.0 / 3.0]) / n
    second = np.concatenate([j[upright] + 1.0 / 3.0, j[turned] + 2.0 / 3.0]) / n
    return np.column_stack([first, second, 1.0 - first - second])
