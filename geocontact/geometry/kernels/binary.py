"""A binary tree of boxes over triangles: surface-area heuristic in 16 bins, children side by side."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geocontact.geometry.kernels.compile import inner, kernel, part

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
    order = np.empty(m, np.int64)
    centre = np.empty((m, 3))
    for i in range(m):
        order[i] = i
        for k in range(3):
            centre[i, k] = 0.5 * (lower[i, k] + upper[i, k])
    box = np.empty((2 * m + 1, 6))
    start = np.empty(2 * m + 1, np.int64)
    count = np.empty(2 * m + 1, np.int64)
    todo = np.empty((4 * DEPTH + 64, 4), np.int64)  # node, first, last, depth
    waiting = _wait(todo, 0, 0, 0, m, 0)
    used = 1
    while waiting > 0:
        waiting -= 1
        node, first, last, depth = todo[waiting, 0], todo[waiting, 1], todo[waiting, 2], todo[waiting, 3]
        _enclose(lower, upper, order, first, last, box[node])
        if last - first <= BUNDLE:
            start[node] = first
            count[node] = last - first
            continue
        middle = _split(lower, upper, centre, order, first, last, depth)
        start[node] = used
        count[node] = 0
        # the larger half waits, so that the list of waiting nodes stays short
        if middle - first < last - middle:
            waiting = _wait(todo, waiting, used + 1, middle, last, depth + 1)
            waiting = _wait(todo, waiting, used, first, middle, depth + 1)
        else:
            waiting = _wait(todo, waiting, used, first, middle, depth + 1)
            waiting = _wait(todo, waiting, used + 1, middle, last, depth + 1)
        used += 2
    pairs = np.zeros(12 * used)
    for node in range(used):
        if count[node] == 0:
            for k in range(6):
                pairs[12 * node + k] = box[start[node], k]
                pairs[12 * node + 6 + k] = box[start[node] + 1, k]
    return Binary(box[0].copy(), pairs, start[:used].copy(), count[:used].copy(), order)


@part
def _wait(todo, waiting, node, first, last, depth):
    """Put a node on the list; returns its new length."""
    todo[waiting, 0] = node
    todo[waiting, 1] = first
    todo[waiting, 2] = last
    todo[waiting, 3] = depth
    return waiting + 1


@inner
def _enclose(lower, upper, order, first, last, out):
    for k in range(3):
        lo = np.inf
        hi = -np.inf
        for i in range(first, last):
            lo = min(lo, lower[order[i], k])
            hi = max(hi, upper[order[i], k])
        out[k] = lo
        out[k + 3] = hi


@inner
def _split(lower, upper, centre, order, first, last, depth):
    axis = first - first  # a number, not the literal 0, for which what is called would be compiled once more
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
    _sort(centre, axis, order, first, last)
    return (first + last) // 2


@inner
def _sort(centre, axis, order, first, last):
    """Slots from `first` to `last` by their centre along an axis, equal ones as they were: merged from below."""
    spare = np.empty(last - first, np.int64)
    width = 1
    while width < last - first:
        for start in range(first, last, 2 * width):
            middle, end = min(start + width, last), min(start + 2 * width, last)
            i, j = start, middle
            for k in range(start - first, end - first):
                if i < middle and (j >= end or centre[order[i], axis] <= centre[order[j], axis]):
                    spare[k] = order[i]
                    i += 1
                else:
                    spare[k] = order[j]
                    j += 1
        for k in range(last - first):
            order[first + k] = spare[k]
        width *= 2


@inner
def _cheapest_bin(lower, upper, centre, order, first, last, axis, low, extent):
    lo = np.empty((BINS, 3))
    hi = np.empty((BINS, 3))
    count = np.empty(BINS, np.int64)
    for b in range(BINS):
        count[b] = 0
        for k in range(3):
            lo[b, k] = np.inf
            hi[b, k] = -np.inf
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
