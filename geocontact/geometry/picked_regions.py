"""Faces chosen by points picked on a surface: inside a polygon of them, or near one of them."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from geocontact.geometry.surface import Surface
from geocontact.geometry.topology import neighbours


def centroids(surface: Surface) -> Float[np.ndarray, "m 3"]:
    """Mean of the corners of each face [m]."""
    return np.asarray(surface.vertices[surface.faces].mean(axis=1))


def faces_near(surface: Surface, point: Float[np.ndarray, " 3"], radius: float) -> Bool[np.ndarray, " m"]:
    """Faces whose centroid lies within a sphere, in one piece with the face nearest to its middle.

    Parts of the surface that pass through the sphere elsewhere, such as the other side of a thin plate, do not count.

    Parameters
    ----------
    point, radius
        Middle, on the surface or near it, and radius of the sphere [m].
    """
    inside = np.linalg.norm(centroids(surface) - point, axis=1) <= radius
    return _in_one_piece(surface, inside, _faces_under(surface, point[None]))


def faces_within(surface: Surface, corners: Float[np.ndarray, "k 3"]) -> Bool[np.ndarray, " m"]:
    """Faces inside a polygon whose corners lie on the surface.

    The polygon is seen along the normal of the plane that fits its corners best in the least-squares sense; a face
    counts when its centroid is seen inside (even-odd rule: Shimrat, Commun ACM 5, 1962), when it looks to the side to
    which the faces under the corners look, and when it is in one piece with one of them or of those inside nearest to
    the corners' middle. The other side of a plate or condyle does not count.

    Parameters
    ----------
    corners
        In their order around the polygon [m]; at least three.

    Raises
    ------
    ValueError
        The corners are too few, lie in one line, or the outline crosses itself.
    """
    if len(corners) < 3:
        raise ValueError(f"a polygon needs 3 landmarks at least, not {len(corners)}")
    middle = corners.mean(axis=0)
    _, spread, axes = np.linalg.svd(corners - middle, full_matrices=True)
    if not spread[1] > 1e-6 * spread[0]:
        raise ValueError("the landmarks lie in one line: there is no inside")
    outline = (corners - middle) @ axes[:2].T
    if _crosses_itself(outline):
        raise ValueError("the outline of the landmarks crosses itself; list them in their order around the region")
    under = _faces_under(surface, corners)
    towards = axes[2] if surface.face_normal[under].sum(axis=0) @ axes[2] >= 0.0 else -axes[2]
    seen = (centroids(surface) - middle) @ axes[:2].T
    inside = even_odd(seen, outline) & (surface.face_normal @ towards > 0.0)
    if not inside.any():
        return np.asarray(inside)
    central = np.flatnonzero(inside)[np.argmin(np.linalg.norm(centroids(surface)[inside] - middle, axis=1))]
    return _in_one_piece(surface, inside, np.append(under, central))


def even_odd(points: Float[np.ndarray, "n 2"], outline: Float[np.ndarray, "k 2"]) -> Bool[np.ndarray, " n"]:
    """Whether points lie inside an outline: a ray from them along +x crosses it an odd number of times."""
    inside = np.zeros(len(points), bool)
    for a, b in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        spans = (a[1] > points[:, 1]) != (b[1] > points[:, 1])
        with np.errstate(divide="ignore", invalid="ignore"):
            at = a[0] + (points[:, 1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
        inside ^= spans & (points[:, 0] < at)
    return inside


def _crosses_itself(outline: Float[np.ndarray, "k 2"]) -> bool:
    """Whether two sides that are no neighbours meet."""
    ends = np.stack([outline, np.roll(outline, -1, axis=0)], axis=1)
    count = len(outline)

    def side(a: Float[np.ndarray, " 2"], b: Float[np.ndarray, " 2"], c: Float[np.ndarray, " 2"]) -> float:
        return float(np.sign((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])))

    for i in range(count):
        for j in range(i + 2, count - (i == 0)):
            (a, b), (c, d) = ends[i], ends[j]
            if side(a, b, c) * side(a, b, d) <= 0.0 and side(c, d, a) * side(c, d, b) <= 0.0:
                return True
    return False


def _faces_under(surface: Surface, points: Float[np.ndarray, "k 3"]) -> Int[np.ndarray, " k"]:
    """The face nearest to each point."""
    return np.asarray(surface.proximity(points).face)


def _in_one_piece(
    surface: Surface, inside: Bool[np.ndarray, " m"], seeds: Int[np.ndarray, " k"]
) -> Bool[np.ndarray, " m"]:
    """Those of the faces that hang together with a seed across edges; a seed counts only where it is inside."""
    across = neighbours(surface.topology.merged[surface.faces])
    face, other = np.repeat(np.arange(len(across)), 3), across.ravel()
    joined = (other >= 0) & inside[face] & inside[other]
    graph = coo_array((np.ones(int(joined.sum())), (face[joined], other[joined])), shape=(len(across), len(across)))
    _, label = connected_components(graph, directed=False)
    kept = np.unique(label[seeds[inside[seeds]]])
    return np.asarray(inside & np.isin(label, kept))
