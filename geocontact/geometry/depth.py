"""The deepest point of one surface inside another, faces included."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.geometry.kernels.faces import quarter
from geocontact.geometry.kernels.floor import promising
from geocontact.geometry.sampled import QUARTERS, Distances, Sampled, measure
from geocontact.geometry.surface import Surface

TOLERANCE = 1e-6  # m; depths closer together than this are not told apart
DIVISIONS = 12
CANDIDATES = 20_000  # at most this many triangles are divided at a time, the most promising first


def lowest_signed_distance(sampled: Sampled, other: Surface, distances: Distances) -> float:
    """Smallest signed distance [m] of the counted faces to `other`, within 1e-6 m, for overlapping closed bodies.

    Branch and bound over triangles: no point of a triangle is deeper than its corner's depth plus the longest edge
    there, nor deeper than the largest distance of its corners to one point of `other`; what cannot beat the deepest
    point found so far is dropped, the rest is divided into four.
    """
    d = _unlimited(sampled, other, distances)
    signed = d.signed
    best = float(signed[sampled.faces].min())
    faces, points, closest = sampled.faces, d.points, d.closest
    for _ in range(DIVISIONS):
        keep, floor = promising(faces, points, closest, signed, best - TOLERANCE)
        if len(keep) == 0:
            break
        if len(keep) > CANDIDATES:
            keep = keep[np.argsort(floor, kind="stable")[:CANDIDATES]]
        f = faces[keep]
        points, closest, signed = _quartered(points[f], closest[f], signed[f], other)
        faces = np.arange(len(points)).reshape(-1, 3)
        best = min(best, float(signed.min()))
    return best


def _unlimited(sampled: Sampled, other: Surface, d: Distances) -> Distances:
    """The same distances with deep points, which lie beyond their limit, measured in full."""
    deep = (d.slot < 0) & (d.side < 0)
    if not deep.any():
        return d
    full = measure(other, np.ascontiguousarray(d.points[deep]), np.full(int(deep.sum()), np.inf))
    distance, slot, closest = d.distance.copy(), d.slot.copy(), d.closest.copy()
    distance[deep], slot[deep], closest[deep] = full.distance, full.slot, full.closest
    return Distances(d.points, distance, d.side, slot, closest, d.undecided)


def _quartered(
    corner: Float[np.ndarray, "k 3 3"],
    closest: Float[np.ndarray, "k 3 3"],
    signed: Float[np.ndarray, "k 3"],
    other: Surface,
) -> tuple[Float[np.ndarray, "j 3"], Float[np.ndarray, "j 3"], Float[np.ndarray, " j"]]:
    middle = quarter(corner)
    new = measure(other, middle.reshape(-1, 3), np.full(3 * len(corner), np.inf))
    points = np.concatenate([corner, middle], axis=1)[:, QUARTERS]
    feet = np.concatenate([closest, new.closest.reshape(-1, 3, 3)], axis=1)[:, QUARTERS]
    values = np.concatenate([signed, new.signed.reshape(-1, 3)], axis=1)[:, QUARTERS]
    return points.reshape(-1, 3), feet.reshape(-1, 3), values.ravel()
