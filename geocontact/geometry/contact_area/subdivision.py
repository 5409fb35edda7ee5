"""Triangles divided into four, with the distance to the other surface asked for at each new point once."""

from __future__ import annotations

import numpy as np
from jaxtyping import Int

from geocontact.geometry.contact_area.sampled import Distances, measure
from geocontact.geometry.surface import Surface

# the four quarters of a triangle, from its corners 0 1 2 and the middles 3 4 5 of the edges opposite to them
QUARTERS = np.array([[0, 5, 4], [5, 1, 3], [4, 3, 2], [3, 4, 5]])
ROUNDING = 1e-12  # m; no distance is missed because of rounding
OPPOSITE = np.array([[1, 2], [2, 0], [0, 1]])


def compact(faces: Int[np.ndarray, "k 3"], points: Distances) -> tuple[Int[np.ndarray, "k 3"], Distances]:
    """Only the points these faces use, and the faces renumbered to them."""
    named = np.zeros(len(points.distance), bool)
    named[faces] = True
    used = np.flatnonzero(named)
    place = np.empty(len(named), np.int64)
    place[used] = np.arange(len(used))
    return place[faces], points[used]


def quartered(
    faces: Int[np.ndarray, "k 3"], points: Distances, other: Surface, beyond: float
) -> tuple[Int[np.ndarray, "4*k 3"], Distances]:
    """Faces replaced by their four quarters (in this order per face) and the points with the new ones appended.

    A new point is measured up to the longest edge of its faces plus `beyond` [m], or as far as its neighbours allow
    (distance is 1-Lipschitz).
    """
    ends = np.sort(faces[:, OPPOSITE], axis=2).reshape(-1, 2)
    key = ends[:, 0] * np.int64(len(points.distance)) + ends[:, 1]
    _, first, which = np.unique(key, return_index=True, return_inverse=True)
    start, end = ends[first].T
    length = np.linalg.norm(points.points[ends[:, 0]] - points.points[ends[:, 1]], axis=1)
    longest = np.zeros(len(first))
    np.maximum.at(longest, which, np.repeat(length.reshape(-1, 3).max(axis=1), 3))
    known = np.where(points.slot >= 0, points.distance, np.inf)
    nearby = np.minimum(known[start], known[end]) + 0.5 * length[first]
    limit = np.minimum(beyond + longest, nearby * (1.0 + 1e-9) + ROUNDING)
    middle = 0.5 * (points.points[start] + points.points[end])
    across = 0.5 * (points.across[start] + points.across[end])
    new = measure(other, middle, limit, across)
    corners = np.concatenate([faces, len(points.distance) + which.reshape(-1, 3)], axis=1)
    return corners[:, QUARTERS].reshape(-1, 3), points + new
