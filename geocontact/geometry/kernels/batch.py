"""Signed distances of many points to one tree, each up to a limit of its own."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.compile import kernel
from geocontact.geometry.kernels.tree import in_box, nearest, offset, scratch, side_of
from geocontact.geometry.kernels.triangle import closest_point

SHORT = 1.0 - 1e-9  # balls that are free of the surface are taken as smaller by this share
CHUNK = 32  # points that are dismissed together when none of them can be near


@kernel
def chunk_spheres(points, limit):
    """Centre, radius and largest limit of every CHUNK consecutive points; shape (ceil(n / CHUNK), 5)."""
    count = (len(points) + CHUNK - 1) // CHUNK
    sphere = np.empty((count, 5))
    for c in range(count):
        first = c * CHUNK
        last = min(first + CHUNK, len(points))
        for k in range(3):
            low, high = points[first, k], points[first, k]
            for i in range(first + 1, last):
                low = min(low, points[i, k])
                high = max(high, points[i, k])
            sphere[c, k] = 0.5 * (low + high)
        r2, farthest = 0.0, limit[first]
        for i in range(first, last):
            x, y, z = points[i, 0] - sphere[c, 0], points[i, 1] - sphere[c, 1], points[i, 2] - sphere[c, 2]
            r2 = max(r2, x * x + y * y + z * z)
            farthest = max(farthest, limit[i])
        sphere[c, 3] = np.sqrt(r2)
        sphere[c, 4] = farthest
    return sphere


@kernel
def move(points, rotation, translation):
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
def signed_distances(tree, points, limit, sphere, signed):
    """Distance, side, slot and closest point of every point.

    Beyond its limit a point has slot -1 and its limit as distance (the true distance is not smaller). side is 1
    outside, -1 inside, 0 undecided; always 1 when not `signed`. `sphere` (from `chunk_spheres`, in the same frame)
    lets whole chunks be dismissed, and bounds the search of the others: distance is 1-Lipschitz. The balls of the
    known distance about the middle of a chunk and of the limit about a point are free of the surface: a point beyond
    its limit has the middle's side where they meet.
    """
    n = len(points)
    distance = np.empty(n)
    side = np.empty(n, np.int8)
    slot = np.empty(n, np.int64)
    closest = np.empty((n, 3))
    root, boxes, child, leaves, fill = tree.root, tree.boxes, tree.child, tree.leaves, tree.fill
    slots, normal, row = tree.slots, tree.normal, tree.row
    nodes, keys, square, fan = scratch()
    for c in range(len(sphere)):
        first = c * CHUNK
        last = min(first + CHUNK, n)
        cx, cy, cz = sphere[c, 0], sphere[c, 1], sphere[c, 2]
        reach = sphere[c, 3] + sphere[c, 4]
        d2, hint = nearest(boxes, child, leaves, fill, cx, cy, cz, reach * reach, nodes, keys, square, fan)
        middle = np.sqrt(d2)
        central = 1  # side of the middle of the chunk
        if signed and hint >= 0:
            _, _, _, central = side_of(leaves, slots, normal, row, hint, cx, cy, cz)
        elif signed and in_box(root, cx, cy, cz):
            _, place = nearest(boxes, child, leaves, fill, cx, cy, cz, np.inf, nodes, keys, square, fan)
            _, _, _, central = side_of(leaves, slots, normal, row, place, cx, cy, cz)
        for i in range(first, last):
            distance[i] = limit[i]
            side[i] = central
            slot[i] = -1
            closest[i, 0] = closest[i, 1] = closest[i, 2] = np.nan
            if hint < 0:
                continue
            x, y, z = points[i, 0], points[i, 1], points[i, 2]
            away = np.sqrt((x - cx) ** 2 + (y - cy) ** 2 + (z - cz) ** 2)
            place = -1
            if middle - away <= limit[i]:
                qx, qy, qz, _, _ = closest_point(leaves, offset(hint), x, y, z)
                guess2 = (x - qx) ** 2 + (y - qy) ** 2 + (z - qz) ** 2
                limit2 = min(limit[i] * limit[i], guess2)
                d2, place = nearest(boxes, child, leaves, fill, x, y, z, limit2, nodes, keys, square, fan)
                if place < 0 and guess2 <= limit[i] * limit[i]:  # nothing is nearer than the guess
                    d2, place = guess2, hint
            if place >= 0:
                hint = place  # a good guess for the next point
                slot[i] = slots[place]
                distance[i] = np.sqrt(d2)
                closest[i, 0], closest[i, 1], closest[i, 2], which = side_of(leaves, slots, normal, row, place, x, y, z)
                if signed:
                    side[i] = which
            elif signed and away >= (limit[i] + middle) * SHORT:  # what the balls about both leave may be crossed
                side[i] = 1
                if in_box(root, x, y, z):
                    _, place = nearest(boxes, child, leaves, fill, x, y, z, np.inf, nodes, keys, square, fan)
                    _, _, _, side[i] = side_of(leaves, slots, normal, row, place, x, y, z)
    return distance, side, slot, closest
