"""A binary tree of boxes over triangles: surface-area heuristic in 16 bins, children side by side."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geocontact.geometry.kernels.compile import kernel

BUNDLE = 4  # triangles in a leaf
BINS = 16
DEPTH = 40  # deeper than this nodes are halved by count, so that the stacks always suffice


class Binary(NamedTuple):
    """root (6,) lower and upper corner of everything; pairs (12 k,) boxes of each node's two children, flat;
    first, size (k,) first slot and number of slots of a leaf, else left child and 0 (the right child follows it);
    order (m,) the face of each slot.
    """

    root: np.ndarray
    pairs: np.ndarray
    first: np.ndarray
    size: np.ndarray
    order: np.ndarray


@kernel
def build(lower, upper):
    """The tree over triangles with these boxes, lower and upper corners (m, 3)."""
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
        if last - first <= BUNDLE:
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
    return Binary(box[0].copy(), pairs.ravel(), meta[:used, 0].copy(), meta[:used, 1].copy(), order)


@kernel
def _enclose(lower, upper, order, first, last, out):
    for k in range(3):
        lo = np.inf
        hi = -np.inf
        for i in range(first, last):
            lo = min(lo, lower[order[i], k])
            hi = max(hi, upper[order[i], k])
        out[k] = lo
        out[k + 3] = hi


@kernel
def _split(lower, upper, centre, order, first, last, depth):
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
def _cheapest_bin(lower, upper, centre, order, first, last, axis, low, extent):
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
    l = np.empty(3)
    h = np.empty(3)
    for sweep in range(2):
        for k in range(3):
            l[k] = np.inf
            h[k] = -np.inf
        n = 0
        for j in range(BINS - 1):
            b = j if sweep == 0 else BINS - 1 - j
            if count[b] > 0:
                n += count[b]
                for k in range(3):
                    l[k] = min(l[k], lo[b, k])
                    h[k] = max(h[k], hi[b, k])
            if n > 0:
                x, y, z = h[0] - l[0], h[1] - l[1], h[2] - l[2]
                cost[b + 1 if sweep == 0 else b] += n * (x * y + y * z + z * x)
    cheapest = 1
    for b in range(2, BINS):
        if cost[b] < cost[cheapest]:
            cheapest = b
    return cheapest
