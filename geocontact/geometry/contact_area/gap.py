"""The least distance of two surfaces at a pose, edges and faces included, from the distances of their vertices."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float, Int

from geocontact.geometry.contact_area.sampled import Distances
from geocontact.geometry.kernels.batch import CHUNK, chunk_spheres, signed_distances
from geocontact.geometry.kernels.gap import edge_gap, near_edges
from geocontact.geometry.surface import Surface

USUAL = 0.9
"""Share of the other surface's faces that are small enough to be bounded without being divided."""

BEYOND = 1.5
"""Radius beyond a face in edges of the other surface: one that leads away from it and half a one for the gap."""


@dataclass(frozen=True, eq=False)
class Rise:
    """Heights of a surface over the planes of its faces, filled in by the kernels that need them.

    What stands there depends on the surface and the radius alone, so threads may share it in any order.

    place (m,) is the place of each slot in the tree; above and below (m,) are what `rise_of` gives on either side, NaN
    where it has not been asked for; reach is how far the radius goes beyond each face [m]. With `signed` what is free
    above is known to be outside.
    """

    place: Int[np.ndarray, " m"]
    above: Float[np.ndarray, " m"]
    below: Float[np.ndarray, " m"]
    reach: float
    signed: bool

    @classmethod
    def of(cls, surface: Surface, other: Surface) -> Rise:
        """Nothing known yet of `surface`, for bounds over the faces of `other`."""
        slots, count = surface.tree.slots, len(surface.faces)
        place = np.empty(count, np.int64)
        place[slots] = np.arange(len(slots))
        usual = float(np.quantile(other.edge_length.max(axis=1), USUAL))
        return cls(
            place=place,
            above=np.full(count, np.nan),
            below=np.full(count, np.nan),
            reach=BEYOND * usual,
            signed=surface.closed and surface.normals_trusted,
        )


ROUNDING = 1e-14  # share of a body's size within which surfaces meet


@dataclass(frozen=True, eq=False)
class Edges:
    """The edges of a surface, each once, for measuring them against another one.

    ends (q, 2) number vertices along `surface.walk`; length (q,) and, of each vertex, reach (n,) are in m.
    """

    ends: Int[np.ndarray, "q 2"]
    length: Float[np.ndarray, " q"]
    reach: Float[np.ndarray, " n"]

    @classmethod
    def of(cls, surface: Surface) -> Edges:
        """Those of every face."""
        walk = surface.walk
        place = np.full(len(surface.vertices), -1)
        place[walk] = np.arange(len(walk))
        a, b, c = (place[corner] for corner in surface.faces.T)
        pairs = ((b, c), (c, a), (a, b))
        key, once = np.unique(
            np.concatenate([np.minimum(s, e) * np.int64(len(walk)) + np.maximum(s, e) for s, e in pairs]),
            return_index=True,
        )
        ends = np.stack(np.divmod(key, len(walk)), axis=1)
        return cls(ends, surface.edge_length.T.ravel()[once], surface.reach[walk])


@dataclass(frozen=True, eq=False)
class Facing:
    """One side of a pair at a pose: a surface's edges, the distances of its vertices to `other`, and `other`'s rise."""

    edges: Edges
    distances: Distances
    other: Surface
    rise: Rise


def least_distance(one: Facing, two: Facing) -> float:
    """Smallest distance of the two surfaces [m], exact to rounding; 0 where they meet.

    The least distance of a vertex, which both maps have, is an upper bound; only edges that can come nearer are
    measured.
    """
    best = min(_nearest_found(one), _nearest_found(two))
    if not np.isfinite(best):
        best = _of_some(one)
    known = []
    for side in (one, two):
        distance, slot = _measured(side, best)
        best = min(best, float(distance.min()))
        known.append((distance, slot))
    best = _over_edges(one, *known[0], best)
    # how far edges are apart has been found from one side; an edge of the other may still pass through a face
    meeting = ROUNDING * float(np.linalg.norm(one.other.tree.root[3:] - one.other.tree.root[:3]))
    meets = best <= meeting or _over_edges(two, *known[1], meeting) < meeting
    return 0.0 if meets else best


def _nearest_found(side: Facing) -> float:
    d = side.distances
    return float(np.where(d.slot >= 0, d.distance, np.inf).min())


def _of_some(side: Facing) -> float:
    """Least distance of one vertex in CHUNK, measured however far it is [m]."""
    points = np.ascontiguousarray(side.distances.points[::CHUNK])
    limit = np.full(len(points), np.inf)
    return float(signed_distances(side.other.tree, points, limit, chunk_spheres(points, limit), False)[0].min())


def _measured(side: Facing, best: float) -> tuple[Float[np.ndarray, " n"], Int[np.ndarray, " n"]]:
    """Distances and slots with those vertices measured farther whose edges could come nearer than `best`.

    Where both ends of an edge e are farther than sqrt(best^2 + e^2 / 4) none of its points is nearer than `best`.
    """
    d = side.distances
    limit = np.hypot(best, 0.5 * side.edges.reach) * (1.0 + 1e-9)
    short = (d.slot < 0) & (d.distance < limit)
    if not short.any():
        return d.distance, d.slot
    points, limit = np.ascontiguousarray(d.points[short]), limit[short]
    found, _, where, _ = signed_distances(side.other.tree, points, limit, chunk_spheres(points, limit), False)
    distance, slot = d.distance.copy(), d.slot.copy()
    distance[short], slot[short] = found, where
    return distance, slot


def _over_edges(side: Facing, distance: Float[np.ndarray, " n"], slot: Int[np.ndarray, " n"], best: float) -> float:
    """The less of `best` and the least distance of the edges of one side to the other surface [m]."""
    edges, points, rise, tree = side.edges, side.distances.points, side.rise, side.other.tree
    keep, floor = near_edges(
        tree,
        rise.place,
        rise.above,
        rise.below,
        rise.reach,
        rise.signed,
        edges.ends,
        edges.length,
        points,
        distance,
        slot,
        best,
    )
    order = np.argsort(floor, kind="stable")
    start, end = points[edges.ends[keep[order]]].transpose(1, 0, 2)
    return float(edge_gap(tree, np.ascontiguousarray(start), np.ascontiguousarray(end), floor[order], best))
