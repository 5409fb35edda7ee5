"""The binary tree made wide: 16 children a node, up to 32 triangles a leaf, laid out so that the processor takes
several at a time. For that the inner loops run over flat arrays by unsigned offsets (views would be counted, signed
indices wrapped) up to a count that the compiler does not know (it would unroll a known one).
"""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.binary import DEPTH
from geocontact.geometry.kernels.compile import inner, kernel, part
from geocontact.geometry.kernels.triangle import LEAF, U

FAN = 16  # children of a node
ROWS = 18  # numbers of a triangle in a leaf: the first 15 of its record, 1/|AC|^2, 1/|BC|^2, orientation
VECTOR = 8  # numbers that a processor takes at a time, at most
STACK = FAN * (DEPTH + 32)


@kernel
def widen(binary, records, orientation):
    """Boxes, children, leaves, slots and fill of the wide tree.

    All flat: boxes (k, 6, FAN), lower x, y, z, upper x, y, z of the children, empty ones beyond reach; child (k, FAN):
    node number, or -2 - leaf number; leaves (l, ROWS, LEAF), the last triangle repeated in unused places;
    slots (l, LEAF): the slot of each place; fill (l,): places in use, rounded up to whole vectors.
    orientation (m,): 1 where n points outside, -1 where it points inside, 0 where it cannot tell.
    """
    n = len(binary.first)
    box, start, size = _extents(binary.root, binary.pairs, binary.first, binary.size)
    boxes = np.empty(n * 6 * FAN)
    child = np.empty(n * FAN, np.int64)
    leaves = np.empty(n * ROWS * LEAF)
    slots = np.empty(n * LEAF, np.int64)
    fill = np.empty(n, np.int64)
    todo = np.empty(n, np.int64)
    fan = np.empty(FAN, np.int64)
    todo[0] = 0
    used, made, leaf = 0, 1, todo[0]
    while used < made:
        width = _gather(binary.first, box, size, todo[used], fan)
        for i in range(FAN):
            child[used * FAN + i] = -1
            for k in range(6):
                boxes[(used * 6 + k) * FAN + i] = box[fan[i], k] if i < width else (np.inf if k < 3 else -np.inf)
            if i >= width:
                continue
            node = fan[i]
            if size[node] > LEAF:
                child[used * FAN + i] = made
                todo[made] = node
                made += 1
            else:
                child[used * FAN + i] = -2 - leaf
                _fill(records, orientation, start[node], size[node], leaf, leaves, slots)
                fill[leaf] = (size[node] + VECTOR - 1) // VECTOR * VECTOR
                leaf += 1
        used += 1
    return (
        boxes[: used * 6 * FAN].copy(),
        child[: used * FAN].copy(),
        leaves[: leaf * ROWS * LEAF].copy(),
        slots[: leaf * LEAF].copy(),
        fill[:leaf].copy(),
    )


@inner
def _extents(root, pairs, firsts, sizes):
    """Box, first slot and number of slots below each node of the binary tree."""
    n = len(firsts)
    box = np.empty((n, 6))
    start = np.empty(n, np.int64)
    size = np.empty(n, np.int64)
    for k in range(6):
        box[0, k] = root[k]
    for node in range(n - 1, -1, -1):  # children come after their parents
        first = firsts[node]
        if sizes[node] > 0:
            start[node] = first
            size[node] = sizes[node]
            continue
        for k in range(6):
            box[first, k] = pairs[12 * node + k]
            box[first + 1, k] = pairs[12 * node + 6 + k]
        start[node] = min(start[first], start[first + 1])
        size[node] = size[first] + size[first + 1]
    return box, start, size


@inner
def _gather(firsts, box, size, node, fan):
    """Up to FAN nodes that together make up `node`: the one with the largest surface is opened again and again."""
    fan[0] = node
    width = 1
    while width < FAN:
        largest = -1.0
        place = -1
        for i in range(width):
            x, y, z = (
                box[fan[i], 3] - box[fan[i], 0],
                box[fan[i], 4] - box[fan[i], 1],
                box[fan[i], 5] - box[fan[i], 2],
            )
            surface = x * y + y * z + z * x
            if size[fan[i]] > LEAF and surface > largest:
                largest = surface
                place = i
        if place < 0:
            break
        first = firsts[fan[place]]
        fan[place] = first
        fan[width] = first + 1
        width += 1
    return width


@inner
def _fill(records, orientation, start, size, leaf, leaves, slots):
    for j in range(LEAF):
        slot = start + min(j, size - 1)
        slots[leaf * LEAF + j] = slot
        o = leaf * ROWS * LEAF + j
        for k in range(15):
            leaves[o + k * LEAF] = records[slot, k]
        length, x, y = records[slot, 12], records[slot, 13], records[slot, 14]
        ac = x * x + y * y
        bc = (x - length) * (x - length) + y * y
        leaves[o + 15 * LEAF] = 1.0 / ac if ac > 0.0 else 0.0
        leaves[o + 16 * LEAF] = 1.0 / bc if bc > 0.0 else 0.0
        leaves[o + 17 * LEAF] = orientation[slot]


@part
def box_distances(boxes, o, x, y, z, out, n):
    """Squared distances of a point to the n = FAN boxes at offset o."""
    for j in range(n):
        i = o + U(j)
        dx = max(max(boxes[i] - x, x - boxes[i + U(3 * FAN)]), 0.0)
        dy = max(max(boxes[i + U(FAN)] - y, y - boxes[i + U(4 * FAN)]), 0.0)
        dz = max(max(boxes[i + U(2 * FAN)] - z, z - boxes[i + U(5 * FAN)]), 0.0)
        out[U(j)] = dx * dx + dy * dy + dz * dz


@part
def leaf_distances(t, o, px, py, pz, out, n):
    """Squared distances of a point to the first n triangles at offset o; the cases of `triangle`, without branches.

    A point over the triangle is as far as its height; any other is as far as the nearest of the three edges.
    """
    for j in range(n):
        i = o + U(j)
        dx, dy, dz = px - t[i], py - t[i + U(LEAF)], pz - t[i + U(2 * LEAF)]
        h = dx * t[i + U(3 * LEAF)] + dy * t[i + U(4 * LEAF)] + dz * t[i + U(5 * LEAF)]
        x = dx * t[i + U(6 * LEAF)] + dy * t[i + U(7 * LEAF)] + dz * t[i + U(8 * LEAF)]
        y = dx * t[i + U(9 * LEAF)] + dy * t[i + U(10 * LEAF)] + dz * t[i + U(11 * LEAF)]
        length, cx, cy = t[i + U(12 * LEAF)], t[i + U(13 * LEAF)], t[i + U(14 * LEAF)]
        ex = min(x, 0.0) + max(x - length, 0.0)
        edge = ex * ex + y * y
        s = min(max((x * cx + y * cy) * t[i + U(15 * LEAF)], 0.0), 1.0)
        ex, ey = x - s * cx, y - s * cy
        edge = min(edge, ex * ex + ey * ey)
        bx, back = cx - length, x - length
        s = min(max((back * bx + y * cy) * t[i + U(16 * LEAF)], 0.0), 1.0)
        ex, ey = back - s * bx, y - s * cy
        edge = min(edge, ex * ex + ey * ey)
        over = min(min(y, x * cy - y * cx), y * bx - back * cy)
        over = min(over, cy - 1e-300)  # nothing is over a collinear triangle
        out[U(j)] = h * h + (0.0 if over >= 0.0 else edge)


@part
def least_of(values, n):
    """The least of the first n values, n a multiple of VECTOR above 0: eight rows, none of which waits for another."""
    a, b, c, d = values[U(0)], values[U(1)], values[U(2)], values[U(3)]
    e, f, g, h = values[U(4)], values[U(5)], values[U(6)], values[U(7)]
    for k in range(VECTOR, n, VECTOR):
        j = U(k)
        a, b, c, d = (
            min(a, values[j]),
            min(b, values[j + U(1)]),
            min(c, values[j + U(2)]),
            min(d, values[j + U(3)]),
        )
        e, f, g, h = (
            min(e, values[j + U(4)]),
            min(f, values[j + U(5)]),
            min(g, values[j + U(6)]),
            min(h, values[j + U(7)]),
        )
    return min(min(min(a, e), min(b, f)), min(min(c, g), min(d, h)))


@part
def first_of(values, value):
    """Number of the first of `values` that is `value`, which is one of them."""
    j = U(0)
    while values[j] != value:
        j += U(1)
    return np.int64(j)
