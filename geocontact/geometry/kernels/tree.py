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


class Tree(NamedTuple):
    """Arrays of the tree; triangles are numbered by *slot*, their order along the leaves.

    box (k, 6) lower and upper corner; meta (k, 2): for a leaf first slot and count, else left child and 0;
    triangle (m, 16) records; face (m,) the face of each slot; normal (m, 7, 3) angle-weighted pseudo-normals of the
    seven features of each slot, zero where a feature touches a degenerate face and has no trustworthy normal.
    """

    box: np.ndarray
    meta: np.ndarray
    triangle: np.ndarray
    face: np.ndarray
    normal: np.ndarray


@kernel
def build_boxes(lower, upper):  # type: ignore[no-untyped-def]
    """Node boxes, node meta data and the slot order of triangles with the given boxes (m, 3)."""
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
    return box[:used].copy(), meta[:used].copy(), order


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
def _box_distance(box, px, py, pz):  # type: ignore[no-untyped-def]
    dx = max(box[0] - px, px - box[3], 0.0)
    dy = max(box[1] - py, py - box[4], 0.0)
    dz = max(box[2] - pz, pz - box[5], 0.0)
    return dx * dx + dy * dy + dz * dz


@kernel
def nearest(tree, px, py, pz, limit2, nodes, keys):  # type: ignore[no-untyped-def]
    """Squared distance and slot of the nearest triangle; slot -1 when none is nearer than sqrt(limit2).

    `nodes` (STACK, int64) and `keys` (STACK, float64) are scratch, one pair per thread.
    """
    best = limit2
    slot = -1
    waiting = 0
    if _box_distance(tree.box[0], px, py, pz) < best:
        nodes[0] = 0
        keys[0] = 0.0
        waiting = 1
    while waiting > 0:
        waiting -= 1
        if keys[waiting] >= best:
            continue
        node = nodes[waiting]
        while tree.meta[node, 1] == 0:
            near = tree.meta[node, 0]
            far = near + 1
            d_near = _box_distance(tree.box[near], px, py, pz)
            d_far = _box_distance(tree.box[far], px, py, pz)
            if d_far < d_near:
                near, far = far, near
                d_near, d_far = d_far, d_near
            if d_far < best:
                nodes[waiting] = far
                keys[waiting] = d_far
                waiting += 1
            if d_near >= best:
                node = -1
                break
            node = near
        if node < 0:
            continue
        first = tree.meta[node, 0]
        for i in range(first, first + tree.meta[node, 1]):
            d2 = squared_distance(tree.triangle[i], px, py, pz, best)
            if d2 < best:
                best = d2
                slot = i
    return best, slot


@kernel
def side_of(tree, slot, px, py, pz):  # type: ignore[no-untyped-def]
    """Closest point on a slot and the side the point is on: 1 outside, -1 inside, 0 where normals cannot tell.

    Angle-weighted pseudo-normals: Baerentzen & Aanaes, Signed distance computation using the angle weighted
    pseudonormal, IEEE TVCG 11 (2005). Right for closed, consistently oriented surfaces without self-intersection.
    """
    qx, qy, qz, feature = closest_point(tree.triangle[slot], px, py, pz)
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
