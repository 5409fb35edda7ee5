"""The bounded tree: boxes over triangles, built once, queried with the largest distance that matters.

Binary, surface-area heuristic in 16 bins; the two children of a node lie side by side. Bounding the query is most of
the speed: what lies further away than the limit is dismissed at the first boxes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geocontact.geometry.kernels.compile import kernel
from geocontact.geometry.kernels.triangle import closest_point, squared_distance

LEAF = 4  # triangles in a leaf
BINS = 16
DEPTH = 40  # deeper than this nodes are halved by count, so that the stack below always suffices
STACK = 128


WIDTH = np.uint64(16)  # numbers in a triangle record
PAIR = np.uint64(12)  # numbers in the two boxes of a node's children
BOX = np.uint64(6)


class Tree(NamedTuple):
    """Arrays of the tree; triangles are numbered by *slot*, their order along the leaves.

    root (6,) lower and upper corner of everything; pairs (12 k,) boxes of the two children of each node, flat;
    first, count (k,) first slot and number of slots of a leaf, else left child and 0 (the right child follows it);
    records (16 m,) triangles, flat, as `triangle_frames` lays them out; face (m,) the face of each slot;
    normal (m, 7, 3) angle-weighted pseudo-normals of the seven features of each slot, zero where a feature touches a
    degenerate or tangled face and has no trustworthy normal.

    Flat arrays and unsigned indices: half the time of two-dimensional ones in the innermost loop.
    """

    root: np.ndarray
    pairs: np.ndarray
    first: np.ndarray
    count: np.ndarray
    records: np.ndarray
    face: np.ndarray
    normal: np.ndarray


@kernel
def build_boxes(lower, upper):  # type: ignore[no-untyped-def]
    """Root box, child boxes, first and count of the nodes, and the slot order, of triangles with these boxes (m, 3)."""
    m = len(lower)
    order = np.arange(m)
    centre = 0.5 * (lower + upper)
    box = np.empty((2 * m + 1, 6))
    meta = np.empty((2 * m + 1, 2), np.int64)
    todo = np.empty((4 * DEPTH + 64, 4), np.int64)  # node, first, last, depth
    todo[0] = np.array([0, 0, m, 0])
    waiting = 1
    used = 1
    while waiting > 0:
        waiting -= 1
        node, first, last, depth = todo[waiting]
        _enclose(lower, upper, order, first, last, box[node])
        if last - first <= LEAF:
            meta[node, 0] = first
            meta[node, 1] = last - first
            continue
        middle = _split(lower, upper, centre, order, first, last, depth)
        meta[node, 0] = used
        meta[node, 1] = 0
        # the larger half waits, so that the list of waiting nodes stays short
        todo[waiting] = np.array([used, first, middle, depth + 1])
        todo[waiting + 1] = np.array([used + 1, middle, last, depth + 1])
        if middle - first < last - middle:
            todo[waiting] = np.array([used + 1, middle, last, depth + 1])
            todo[waiting + 1] = np.array([used, first, middle, depth + 1])
        waiting += 2
        used += 2
    pairs = np.zeros((used, 12))
    for node in range(used):
        if meta[node, 1] == 0:
            pairs[node, :6] = box[meta[node, 0]]
            pairs[node, 6:] = box[meta[node, 0] + 1]
    return box[0].copy(), pairs.ravel(), meta[:used, 0].astype(np.uint32), meta[:used, 1].astype(np.uint32), order


@kernel
def _enclose(lower, upper, order, first, last, out):  # type: ignore[no-untyped-def]
    for k in range(3):
        lo = np.inf
        hi = -np.inf
        for i in range(first, last):
            lo = min(lo, lower[order[i], k])
            hi = max(hi, upper[order[i], k])
        out[k] = lo
        out[k + 3] = hi


@kernel
def _split(lower, upper, centre, order, first, last, depth):  # type: ignore[no-untyped-def]
    axis = 0
    extent = -1.0
    low = 0.0
    for k in range(3):
        lo = np.inf
        hi = -np.inf
        for i in range(first, last):
            lo = min(lo, centre[order[i], k])
            hi = max(hi, centre[order[i], k])
        if hi - lo > extent:
            extent = hi - lo
            axis = k
            low = lo
    if extent > 0.0 and depth < DEPTH:
        cut = _cheapest_bin(lower, upper, centre, order, first, last, axis, low, extent)
        middle = first
        for i in range(first, last):
            if min(int(BINS * (centre[order[i], axis] - low) / extent), BINS - 1) < cut:
                order[i], order[middle] = order[middle], order[i]
                middle += 1
        if first < middle < last:
            return middle
    part = order[first:last].copy()
    order[first:last] = part[np.argsort(centre[part, axis], kind="mergesort")]
    return (first + last) // 2


@kernel
def _cheapest_bin(lower, upper, centre, order, first, last, axis, low, extent):  # type: ignore[no-untyped-def]
    lo = np.full((BINS, 3), np.inf)
    hi = np.full((BINS, 3), -np.inf)
    count = np.zeros(BINS, np.int64)
    for i in range(first, last):
        t = order[i]
        b = min(int(BINS * (centre[t, axis] - low) / extent), BINS - 1)
        count[b] += 1
        for k in range(3):
            lo[b, k] = min(lo[b, k], lower[t, k])
            hi[b, k] = max(hi[b, k], upper[t, k])
    cost = np.zeros(BINS + 1)
    for sweep in range(2):
        l = np.full(3, np.inf)
        h = np.full(3, -np.inf)
        n = 0
        for j in range(BINS - 1):
            b = j if sweep == 0 else BINS - 1 - j
            if count[b] > 0:
                n += count[b]
                for k in range(3):
                    l[k] = min(l[k], lo[b, k])
                    h[k] = max(h[k], hi[b, k])
            if n > 0:
                e = h - l
                cost[b + 1 if sweep == 0 else b] += n * (e[0] * e[1] + e[1] * e[2] + e[2] * e[0])
    return 1 + np.argmin(cost[1:BINS])


@kernel
def box_distance(box, o, x, y, z):  # type: ignore[no-untyped-def]
    """Squared distance of a point to the box that starts at offset o of a flat array; 0 inside."""
    dx = max(box[o] - x, x - box[o + np.uint64(3)], 0.0)
    dy = max(box[o + np.uint64(1)] - y, y - box[o + np.uint64(4)], 0.0)
    dz = max(box[o + np.uint64(2)] - z, z - box[o + np.uint64(5)], 0.0)
    return dx * dx + dy * dy + dz * dz


@kernel
def nearest(tree, x, y, z, limit2, nodes, keys):  # type: ignore[no-untyped-def]
    """Squared distance and slot of the nearest triangle; slot -1 when none is nearer than sqrt(limit2).

    `nodes` (STACK, uint32) and `keys` (STACK, float64) are scratch, one pair per thread.
    """
    best = limit2
    slot = -1
    waiting = 0
    if box_distance(tree.root, np.uint64(0), x, y, z) < best:
        nodes[0] = 0
        keys[0] = 0.0
        waiting = 1
    while waiting > 0:
        waiting -= 1
        if keys[waiting] >= best:
            continue
        node = np.uint64(nodes[waiting])
        while True:
            count = np.uint64(tree.count[node])
            first = np.uint64(tree.first[node])
            if count != 0:
                for i in range(first, first + count):
                    d2 = squared_distance(tree.records, i * WIDTH, x, y, z, best)
                    if d2 < best:
                        best = d2
                        slot = np.int64(i)
                break
            near = box_distance(tree.pairs, node * PAIR, x, y, z)
            far = box_distance(tree.pairs, node * PAIR + BOX, x, y, z)
            node = first
            other = first + np.uint64(1)
            if far < near:
                near, far = far, near
                node, other = other, node
            if far < best:
                nodes[waiting] = other
                keys[waiting] = far
                waiting += 1
            if near >= best:
                break
    return best, slot


@kernel
def side_of(tree, slot, px, py, pz):  # type: ignore[no-untyped-def]
    """Closest point on a slot and the side the point is on: 1 outside, -1 inside, 0 where normals cannot tell.

    Angle-weighted pseudo-normals: Baerentzen & Aanaes, Signed distance computation using the angle weighted
    pseudonormal, IEEE TVCG 11 (2005). Right for closed, consistently oriented surfaces without self-intersection.
    """
    qx, qy, qz, feature = closest_point(tree.records, np.uint64(slot) * WIDTH, px, py, pz)
    n = tree.normal[slot, feature]
    dx = px - qx
    dy = py - qy
    dz = pz - qz
    along = dx * n[0] + dy * n[1] + dz * n[2]
    doubt = 1e-9 * np.sqrt((dx * dx + dy * dy + dz * dz) * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]))
    side = 0
    if along > doubt:
        side = 1
    elif along < -doubt:
        side = -1
    return qx, qy, qz, side
