"""Faces chosen by points picked on a surface: inside a polygon of them, or near one of them."""

from __future__ import annotations

import numpy as np
from jaxtyping import Bool, Float, Int
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from geocontact.geometry.surface import Surface
from geocontact.geometry.topology import neighbours

SAME = 1e-9
"""Share of the diagonal of the corners' box up to which two places are one."""


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
        In their order around the polygon [m]; at least three. One at the place of the one before it, or of the first
        at the end, counts once.

    Raises
    ------
    ValueError
        The corners are too few, lie in one line, or the outline crosses or touches itself.
    """
    if len(corners) < 3:
        raise ValueError(f"a polygon needs 3 landmarks at least, not {len(corners)}")
    corners = _without_repeats(corners)
    middle = corners.mean(axis=0)
    _, spread, axes = np.linalg.svd(corners - middle, full_matrices=True)
    if len(corners) < 3 or not spread[1] > 1e-6 * spread[0]:
        raise ValueError("the landmarks lie in one line: there is no inside")
    outline = (corners - middle) @ axes[:2].T
    if _crosses_itself(outline):
        what = "the outline of the landmarks crosses itself or comes back to a place"
        raise ValueError(f"{what}; list each once, in their order around the region")
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


def _without_repeats(corners: Float[np.ndarray, "k 3"]) -> Float[np.ndarray, "l 3"]:
    """The corners that lie apart from the one before them; the first corner is after the last."""
    away = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)
    kept = away > SAME * float(np.linalg.norm(np.ptp(corners, axis=0)))
    return np.asarray(corners[kept] if kept.any() else corners[:1])


def _crosses_itself(outline: Float[np.ndarray, "k 2"]) -> bool:
    """Whether two sides that are no neighbours cross, or one ends on the other; sides in one line may lie apart."""
    near = SAME * float(np.linalg.norm(np.ptp(outline, axis=0)))
    sides = list(zip(outline, np.roll(outline, -1, axis=0), strict=True))
    count = len(outline)
    return any(_meet(sides[i], sides[j], near) for i in range(count) for j in range(i + 2, count - (i == 0)))


Side = tuple[Float[np.ndarray, " 2"], Float[np.ndarray, " 2"]]


def _meet(one: Side, other: Side, near: float) -> bool:
    """Whether two sides share a point, to `near`: each has ends on both sides of the other, or an end is on one."""
    across = [[_beside(side, end) for end in ends] for side, ends in ((one, other), (other, one))]
    if all(min(pair) < -near and max(pair) > near for pair in across):
        return True
    return any(_away(side, end) <= near for side, ends in ((one, other), (other, one)) for end in ends)


def _beside(side: Side, point: Float[np.ndarray, " 2"]) -> float:
    """Distance of a point from the line of a side, positive to its left."""
    along = side[1] - side[0]
    to = point - side[0]
    return float((along[0] * to[1] - along[1] * to[0]) / np.linalg.norm(along))


def _away(side: Side, point: Float[np.ndarray, " 2"]) -> float:
    """Distance of a point from a side."""
    along = side[1] - side[0]
    share = float(np.clip((point - side[0]) @ along / (along @ along), 0.0, 1.0))
    return float(np.linalg.norm(point - side[0] - share * along))


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
