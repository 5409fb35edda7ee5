"""Rays through the bounded tree: where each first leaves the body."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.compile import kernel, lean
from geocontact.geometry.kernels.tree import offset
from geocontact.geometry.kernels.triangle import LEAF, U
from geocontact.geometry.kernels.wide import FAN, STACK

GRAZING = 1e-9  # cosine between ray and face below which the ray runs along the face and does not leave there
SLACK = 1e-9  # of a triangle's longest edge: rays through an edge hit one of its two faces at least


@kernel
def exits(tree, points, directions, limit, outside):
    """Distance along each ray to the first face that it leaves through, and its slot.

    directions are unit vectors; `outside` is 1 where the faces' normals point outside, -1 where they point inside.
    Faces that the ray enters through do not count, so a ray may start on the surface. Beyond `limit` the distance is
    infinite and the slot -1.
    """
    n = len(points)
    distance = np.full(n, np.inf)
    slot = np.full(n, -1)
    nodes = np.empty(STACK, np.int64)
    for i in range(n):
        distance[i], place = _exit(
            tree.boxes, tree.child, tree.leaves, tree.fill, points[i], directions[i], limit, outside, nodes
        )
        if place >= 0:
            slot[i] = tree.slots[place]
    return distance, slot


@lean
def _exit(boxes, child, leaves, fill, p, d, limit, outside, nodes):
    best = limit
    place = -1
    nodes[0] = 0
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = nodes[waiting]
        if node < 0:
            leaf = -2 - node
            for j in range(fill[leaf]):
                t = _crossing(leaves, offset(leaf * LEAF + j), p, d, outside)
                if t < best:
                    best = t
                    place = leaf * LEAF + j
            continue
        base = U(node) * U(6 * FAN)
        for j in range(FAN):
            if child[node * FAN + j] != -1 and _meets(boxes, base + U(j), p, d, best):
                nodes[waiting] = child[node * FAN + j]
                waiting += 1
    if place < 0:
        return np.inf, place
    return best, place


@lean
def _meets(boxes, o, p, d, best):
    """Whether the ray passes the box within `best`, the box widened by what rounding may cost."""
    near = 0.0
    far = best
    for k in range(3):
        low, high = boxes[o + U(k * FAN)], boxes[o + U((k + 3) * FAN)]
        if not low <= high:
            return False
        slack = SLACK * (high - low + abs(low) + abs(high))
        if abs(d[k]) < 1e-300:
            if p[k] < low - slack or p[k] > high + slack:
                return False
            continue
        a, b = (low - slack - p[k]) / d[k], (high + slack - p[k]) / d[k]
        near, far = max(near, min(a, b)), min(far, max(a, b))
    return near <= far


@lean
def _crossing(r, o, p, d, outside):
    """Where the ray leaves through a triangle; infinite where it does not."""
    along = d[0] * r[o + U(3 * LEAF)] + d[1] * r[o + U(4 * LEAF)] + d[2] * r[o + U(5 * LEAF)]
    length, cx, cy = r[o + U(12 * LEAF)], r[o + U(13 * LEAF)], r[o + U(14 * LEAF)]
    if along * outside <= GRAZING or cy <= 0.0:
        return np.inf
    dx, dy, dz = p[0] - r[o], p[1] - r[o + U(LEAF)], p[2] - r[o + U(2 * LEAF)]
    height = dx * r[o + U(3 * LEAF)] + dy * r[o + U(4 * LEAF)] + dz * r[o + U(5 * LEAF)]
    t = -height / along
    slack = SLACK * length
    if t < -slack:
        return np.inf
    dx, dy, dz = dx + t * d[0], dy + t * d[1], dz + t * d[2]
    x = dx * r[o + U(6 * LEAF)] + dy * r[o + U(7 * LEAF)] + dz * r[o + U(8 * LEAF)]
    y = dx * r[o + U(9 * LEAF)] + dy * r[o + U(10 * LEAF)] + dz * r[o + U(11 * LEAF)]
    area = slack * length
    if y < -slack or x * cy - y * cx < -area or y * (cx - length) - (x - length) * cy < -area:
        return np.inf
    return max(t, 0.0)
