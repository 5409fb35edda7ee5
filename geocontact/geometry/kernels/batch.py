"""Signed distances of many points to one tree, each up to a limit of its own."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.compile import kernel
from geocontact.geometry.kernels.tree import in_box, nearest, scratch, side_of, squared_distance
from geocontact.geometry.kernels.wide import LEAF

CHUNK = 32  # points that are dismissed together when none of them can be near
SLACK = 1.0 + 1e-9  # so that rounding never excludes the nearest triangle itself


@kernel
def chunk_spheres(points, limit):  # type: ignore[no-untyped-def]
    """Centre, radius and largest limit of every CHUNK consecutive points; shape (ceil(n / CHUNK), 5)."""
    count = (len(points) + CHUNK - 1) // CHUNK
    sphere = np.empty((count, 5))
    for c in range(count):
        first = c * CHUNK
        last = min(first + CHUNK, len(points))
        for k in range(3):
            sphere[c, k] = 0.5 * (points[first:last, k].min() + points[first:last, k].max())
        r2 = 0.0
        for i in range(first, last):
            d = points[i] - sphere[c, :3]
            r2 = max(r2, d[0] * d[0] + d[1] * d[1] + d[2] * d[2])
        sphere[c, 3] = np.sqrt(r2)
        sphere[c, 4] = limit[first:last].max()
    return sphere


@kernel
def move(points, rotation, translation):  # type: ignore[no-untyped-def]
    """R p + t for every point."""
    out = np.empty_like(points)
    for i in range(len(points)):
        for k in range(3):
            out[i, k] = (
                rotation[k, 0] * points[i, 0]
                + rotation[k, 1] * points[i, 1]
                + rotation[k, 2] * points[i, 2]
                + translation[k]
            )
    return out


@kernel
def signed_distances(tree, points, limit, sphere, signed):  # type: ignore[no-untyped-def]
    """Distance, side, slot and closest point of every point.

    Beyond its limit a point has slot -1 and its limit as distance (the true distance is not smaller). side is 1
    outside, -1 inside, 0 undecided; always 1 when not `signed`. `sphere` (from `chunk_spheres`, in the same frame)
    lets whole chunks be dismissed, and bounds the search of the others: distance is 1-Lipschitz.
    """
    n = len(points)
    distance = np.empty(n)
    side = np.ones(n, np.int8)
    slot = np.full(n, -1)
    closest = np.full((n, 3), np.nan)
    w = scratch()
    tiny = 1e-12 * (tree.root[3:] - tree.root[:3]).sum()  # points on the surface itself must be found too
    hint = -1  # place nearest to the point before: a good guess for the next
    for c in range(len(sphere)):
        first = c * CHUNK
        last = min(first + CHUNK, n)
        cx, cy, cz = sphere[c, 0], sphere[c, 1], sphere[c, 2]
        reach = sphere[c, 3] + sphere[c, 4]
        d2, place = nearest(tree, cx, cy, cz, reach * reach, w)
        if place < 0:
            far = _side(tree, cx, cy, cz, signed, w)
            for i in range(first, last):
                distance[i] = limit[i]
                side[i] = far
            continue
        middle = np.sqrt(d2)
        hint = place
        central = 1
        if signed:
            _, _, _, central = side_of(tree, place, cx, cy, cz)
        for i in range(first, last):
            x, y, z = points[i, 0], points[i, 1], points[i, 2]
            away = np.sqrt((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2)
            place = -1
            if middle - away <= limit[i]:
                guess = np.sqrt(squared_distance(tree, hint, x, y, z))
                start = min(limit[i], guess * SLACK + tiny)
                d2, place = nearest(tree, x, y, z, start * start, w)
            if place < 0:
                distance[i] = limit[i]
                if away < limit[i]:  # nothing between the point and the middle of its chunk
                    side[i] = central
                else:
                    side[i] = _side(tree, x, y, z, signed, w)
                continue
            hint = place
            slot[i] = tree.slots[place // LEAF, place % LEAF]
            distance[i] = np.sqrt(d2)
            closest[i, 0], closest[i, 1], closest[i, 2], which = side_of(tree, place, x, y, z)
            if signed:
                side[i] = which
    return distance, side, slot, closest


@kernel
def _side(tree, x, y, z, signed, w):  # type: ignore[no-untyped-def]
    if not signed or not in_box(tree.root, x, y, z):
        return 1
    place = nearest(tree, x, y, z, np.inf, w)[1]
    return side_of(tree, place, x, y, z)[3]
