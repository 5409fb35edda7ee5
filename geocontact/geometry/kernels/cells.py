"""A grid around a surface whose cells tell most points on which side of a threshold they are, without a search.

A cell keeps the point p of the surface that is nearest to its centre, and a slack e >= 0 such that every x in it has

    |x - p|^2 - e <= d(x)^2 <= |x - p|^2

The right side holds because p belongs to the surface. For the left one, |x - p|^2 - d(x)^2 is convex in x (|x|^2
cancels, and d^2 - |x|^2 is a minimum of linear functions), so its largest value over a cell is taken at one of the
eight corners, where the distance is measured. e falls with the square of the cell's edge.

Two levels: coarse cells that lie wholly on one side keep that verdict, the others are divided into `n`^3 fine cells.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geocontact.geometry.kernels.compile import inner, kernel
from geocontact.geometry.kernels.tree import nearest, offset, scratch, side_of
from geocontact.geometry.kernels.triangle import closest_point

ROUND = 1e-12  # relative allowance for rounding
WITHIN, BEYOND, OPEN = np.int8(1), np.int8(2), np.int8(0)


class CellGrid(NamedTuple):
    """The grid about the centre of its surface, for one threshold.

    low (3,) its corner; shape (3,) coarse cells along each axis; coarse and fine their edges [m]; n fine cells along a
    coarse one; state (c,) WITHIN, BEYOND or OPEN; block (c,) number of an open cell's fine cells. A cell's number there
    is `block`, or for coarse ones `first` + the coarse cell's own: near (k, 4) is p and e, place (k,) where p lies in
    the tree, side (k,) 1 outside, -1 inside, 0 where the surface may pass through.
    """

    low: np.ndarray
    shape: np.ndarray
    coarse: float
    fine: float
    n: int
    state: np.ndarray
    block: np.ndarray
    first: int
    near: np.ndarray
    place: np.ndarray
    side: np.ndarray


@kernel
def measured_cells(tree, low, edge, count, signed):
    """near (k, 4), place (k,), side (k,) and the least and largest distance (k, 2) of the cells of a box."""
    nodes, keys, square, fan = scratch()
    boxes, child, leaves, fill = tree.boxes, tree.child, tree.leaves, tree.fill
    n0, n1, n2 = count[0], count[1], count[2]
    corner = np.empty((n0 + 1, n1 + 1, n2 + 1))
    hint = 0
    for a in range(n0 + 1):
        for b in range(n1 + 1):
            for c in range(n2 + 1):
                x, y, z = low[0] + a * edge, low[1] + b * edge, low[2] + c * edge
                corner[a, b, c], hint = _nearest_triangle(
                    boxes, child, leaves, fill, x, y, z, hint, nodes, keys, square, fan
                )
    total = n0 * n1 * n2
    near, place = np.empty((total, 4)), np.empty(total, np.int64)
    side, span = np.zeros(total, np.int8), np.empty((total, 2))
    half2 = 0.75 * edge * edge
    k = 0
    for a in range(n0):
        for b in range(n1):
            for c in range(n2):
                x, y, z = low[0] + (a + 0.5) * edge, low[1] + (b + 0.5) * edge, low[2] + (c + 0.5) * edge
                d2, hint = _nearest_triangle(boxes, child, leaves, fill, x, y, z, hint, nodes, keys, square, fan)
                px, py, pz, which = side_of(leaves, tree.slots, tree.normal, tree.row, hint, x, y, z)
                slack, least, most = 0.0, np.inf, 0.0
                for i in range(2):
                    for j in range(2):
                        for m in range(2):
                            vx = low[0] + (a + i) * edge - px
                            vy = low[1] + (b + j) * edge - py
                            vz = low[2] + (c + m) * edge - pz
                            v2, there = vx * vx + vy * vy + vz * vz, corner[a + i, b + j, c + m]
                            slack = max(slack, v2 - there + ROUND * v2)
                            least, most = min(least, there), max(most, v2)
                near[k, 0], near[k, 1], near[k, 2], near[k, 3] = px, py, pz, slack
                place[k] = hint
                lipschitz = max(np.sqrt(d2) - np.sqrt(half2), 0.0)
                span[k, 0] = max(np.sqrt(max(least - half2, 0.0)), lipschitz) * (1.0 - ROUND)
                span[k, 1] = np.sqrt(most) * (1.0 + ROUND)
                if not signed:
                    side[k] = 1
                elif d2 > half2 * (1.0 + 1e-9):
                    side[k] = which
                k += 1
    return near, place, side, span


@inner
def _nearest_triangle(boxes, child, leaves, fill, x, y, z, hint, nodes, keys, square, fan):
    """Squared distance and place of the nearest triangle, the place of a neighbour's being a first guess."""
    qx, qy, qz, _, _ = closest_point(leaves, offset(hint), x, y, z)
    guess = (x - qx) ** 2 + (y - qy) ** 2 + (z - qz) ** 2
    d2, place = nearest(boxes, child, leaves, fill, x, y, z, guess, nodes, keys, square, fan)
    if place < 0:
        return guess, hint
    return d2, place


@kernel
def divided(tree, low, coarse, count, n, open_cells, signed):
    """The fine cells of all open coarse ones, in their order: near, place, side."""
    each = n * n * n
    near, place = np.empty((len(open_cells) * each, 4)), np.empty(len(open_cells) * each, np.int64)
    side = np.empty(len(open_cells) * each, np.int8)
    inner = np.array([n, n, n])
    corner = np.empty(3)
    for k in range(len(open_cells)):
        cell = open_cells[k]
        corner[0] = low[0] + (cell // (count[1] * count[2])) * coarse
        corner[1] = low[1] + (cell // count[2] % count[1]) * coarse
        corner[2] = low[2] + (cell % count[2]) * coarse
        found = measured_cells(tree, corner, coarse / n, inner, signed)
        near[k * each : (k + 1) * each] = found[0]
        place[k * each : (k + 1) * each] = found[1]
        side[k * each : (k + 1) * each] = found[2]
    return near, place, side


@kernel
def cell_at(low, count, coarse, n, state, block, first, x, y, z):
    """Number of the cell that holds a point and the verdict over all of it; -1, BEYOND outside of the grid."""
    a, b, c = (x - low[0]) / coarse, (y - low[1]) / coarse, (z - low[2]) / coarse
    if a < 0.0 or b < 0.0 or c < 0.0 or a >= count[0] or b >= count[1] or c >= count[2]:
        return -1, BEYOND
    i, j, k = int(a), int(b), int(c)
    cell = (i * count[1] + j) * count[2] + k
    if state[cell] != OPEN:
        return first + cell, state[cell]
    i, j, k = min(int((a - i) * n), n - 1), min(int((b - j) * n), n - 1), min(int((c - k) * n), n - 1)
    return block[cell] * n * n * n + (i * n + j) * n + k, OPEN


@kernel
def verdict(cells_near, cells_side, number, state, limit2, x, y, z):
    """What a point's cell says of it: WITHIN, BEYOND, or OPEN where its distance has to be measured."""
    if state != OPEN:
        return state
    d2 = (x - cells_near[number, 0]) ** 2 + (y - cells_near[number, 1]) ** 2 + (z - cells_near[number, 2]) ** 2
    if d2 <= limit2:
        return WITHIN
    if d2 - cells_near[number, 3] > limit2 and cells_side[number] != 0:
        return BEYOND if cells_side[number] > 0 else WITHIN
    return OPEN
