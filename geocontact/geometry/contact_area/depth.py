"""The deepest point of one surface inside another, faces included."""

from __future__ import annotations

import dataclasses

import numpy as np

from geocontact.geometry.contact_area.sampled import Distances, Sampled, measure
from geocontact.geometry.contact_area.subdivision import compact, quartered
from geocontact.geometry.kernels.floor import promising
from geocontact.geometry.surface import Surface

TOLERANCE = 1e-6  # m; depths closer together than this are not told apart
DIVISIONS = 30  # a guard; edges halve each time
CANDIDATES = 20_000  # at most this many triangles are divided at a time, the most promising first


def lowest_signed_distance(sampled: Sampled, other: Surface, distances: Distances) -> float:
    """Smallest signed distance [m] of the counted faces to `other`, within 1e-6 m, for overlapping closed bodies.

    Branch and bound over triangles: no point of a triangle is deeper than its corner's depth plus the longest edge
    there, nor deeper than the largest distance of its corners to one point of `other`; what cannot beat the deepest
    point found so far is dropped, the rest is divided into four. Infinite when no face counts.
    """
    if len(sampled.faces) == 0:
        return np.inf
    points = _unlimited(other, distances)
    faces = sampled.faces
    best = float(points.signed[faces].min())
    for _ in range(DIVISIONS):
        keep, floor = promising(faces, points.points, points.closest, points.signed, best - TOLERANCE)
        if len(keep) == 0:
            break
        if len(keep) > CANDIDATES:
            keep = keep[np.argsort(floor, kind="stable")[:CANDIDATES]]
        faces, points = quartered(*compact(faces[keep], points), other, np.inf)
        best = min(best, float(points.signed.min()))
    return best


def _unlimited(other: Surface, d: Distances) -> Distances:
    """The same distances with deep points, which lie beyond their limit, measured in full."""
    deep = (d.slot < 0) & (d.side < 0)
    if not deep.any():
        return d
    full = measure(other, np.ascontiguousarray(d.points[deep]), np.full(int(deep.sum()), np.inf), d.across[deep])
    distance, slot, closest = d.distance.copy(), d.slot.copy(), d.closest.copy()
    distance[deep], slot[deep], closest[deep] = full.distance, full.slot, full.closest
    return dataclasses.replace(d, distance=distance, slot=slot, closest=closest)
