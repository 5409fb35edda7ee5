"""The deepest point of one surface inside another, faces included."""

from __future__ import annotations

import dataclasses

import numpy as np

from geocontact.geometry.contact_area.rise import Rise
from geocontact.geometry.contact_area.sampled import Distances, Sampled, measure
from geocontact.geometry.contact_area.subdivision import compact, quartered
from geocontact.geometry.kernels.floor import promising
from geocontact.geometry.surface import Surface

TOLERANCE = 1e-9  # m; depths closer together than this are not told apart
DIVISIONS = 30  # a guard; edges halve each time
CANDIDATES = 20_000  # at most this many triangles are divided at a time, the most promising first


def lowest_signed_distance(
    sampled: Sampled, other: Surface, distances: Distances, rise: Rise, known: float = 0.0
) -> float:
    """Smallest signed distance [m] of the counted faces to `other`, within 1e-9 m, or `known` <= 0 if that is lower.

    Branch and bound over triangles. Bounds from the distances of the corners: no point of a triangle is deeper than its
    corner's depth plus the longest edge there, nor deeper than the largest distance of its corners to one face of
    `other`, nor farther below the plane of such a face than its corners are, plus what `other` rises over that plane.
    What cannot beat the deepest point found so far is dropped, the rest is divided into four.

    Parameters
    ----------
    sampled, other, distances
        Faces that count, the closed surface they may be inside of, and the distances of their corners to it.
    rise
        Of `other`.
    known
        A signed distance that is attained elsewhere; only what lies deeper is looked for.
    """
    if len(sampled.faces) == 0:
        return known
    points = _unlimited(other, distances)
    faces, edges, signed = sampled.faces, sampled.edges, points.signed
    best = min(known, float(signed[faces].min()))
    above = rise.above
    for _ in range(DIVISIONS):
        keep, floor = promising(
            other.tree,
            rise.place,
            above,
            rise.reach,
            rise.signed,
            faces,
            edges,
            points.points,
            signed,
            points.slot,
            best - TOLERANCE,
        )
        if len(keep) == 0:
            break
        if len(keep) > CANDIDATES:
            keep = keep[np.argsort(floor, kind="stable")[:CANDIDATES]]
        faces, points = quartered(*compact(faces[keep], points), other, np.inf)
        edges, signed = np.repeat(0.5 * edges[keep], 4, axis=0), points.signed
        best = min(best, float(signed.min()))
        above = rise.above[:0]  # known for triangles as given, worth finding anew for smaller ones
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
