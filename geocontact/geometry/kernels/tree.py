"""The bounded tree: built once, queried with the largest distance that matters.

Bounding the query is most of the speed: what lies further away than the limit is dismissed at the first boxes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geocontact.geometry.kernels.compile import inner, lean
from geocontact.geometry.kernels.triangle import LEAF, U, closest_point
from geocontact.geometry.kernels.wide import FAN, ROWS, STACK, box_distances, first_of, leaf_distances, least_of


class BoxTree(NamedTuple):
    """Arrays of the tree; triangles are numbered by *slot*, their order along the leaves.

    root (6,) lower and upper corner of everything; boxes, child, leaves, slots, fill as `widen` makes them, a *place*
    being a leaf times LEAF plus a position in it; face (m,) the face of each slot;
    normal (k, 3), flat, angle-weighted pseudo-normals, each once, zero where a feature touches a degenerate or doubtful
    face and has no trustworthy normal; row (m, 6), flat, which of them the edges and corners of each slot have.
    """

    root: np.ndarray
    boxes: np.ndarray
    child: np.ndarray
    leaves: np.ndarray
    slots: np.ndarray
    fill: np.ndarray
    face: np.ndarray
    normal: np.ndarray
    row: np.ndarray


@inner
def scratch():
    """Working memory of one thread's queries: nodes and keys that wait, squared distances, and the fan."""
    return np.empty(STACK, np.int64), np.empty(STACK), np.empty(max(FAN, LEAF)), FAN


@lean
def nearest(boxes, child, leaves, fill, x, y, z, limit2, nodes, keys, square, fan):
    """Squared distance and place of the nearest triangle; place -1 when none is nearer than sqrt(limit2).

    The first arrays are the tree's, the last four `scratch`: bare arrays, because a tuple of them would be counted in
    and out at every call.
    """
    best = limit2
    place = -1
    nodes[0] = 0
    keys[0] = 0.0
    waiting = 1
    while waiting > 0:
        waiting -= 1
        if keys[U(waiting)] >= best:
            continue
        node = nodes[U(waiting)]
        if node < 0:
            leaf = -2 - node
            leaf_distances(leaves, U(leaf) * U(ROWS * LEAF), x, y, z, square, fill[U(leaf)])
            least = least_of(square, fill[U(leaf)])
            if least < best:
                best = least
                place = leaf * LEAF + first_of(square, least)
            continue
        box_distances(boxes, U(node) * U(6 * FAN), x, y, z, square, fan)
        base = waiting
        for j in range(FAN):
            d2 = square[U(j)]
            if d2 < best:
                k = waiting  # the nearest child ends on top
                while k > base and keys[U(k - 1)] < d2:
                    keys[U(k)] = keys[U(k - 1)]
                    nodes[U(k)] = nodes[U(k - 1)]
                    k -= 1
                keys[U(k)] = d2
                nodes[U(k)] = child[U(node * FAN + j)]
                waiting += 1
    return best, place


@lean
def in_box(box, x, y, z):
    """Whether a point lies inside a box (6,)."""
    return box[0] < x < box[3] and box[1] < y < box[4] and box[2] < z < box[5]


@lean
def offset(place):
    """Where the numbers of the triangle at a place begin."""
    return U(place // LEAF) * U(ROWS * LEAF) + U(place % LEAF)


@lean
def side_of(leaves, slots, normal, row, place, px, py, pz):
    """Closest point on a triangle and the side the point is on: 1 outside, -1 inside, 0 where normals cannot tell.

    Angle-weighted pseudo-normals: Baerentzen & Aanaes, Signed distance computation using the angle weighted
    pseudonormal, IEEE TVCG 11 (2005). Right for closed, consistently oriented surfaces without self-intersection.
    """
    o = offset(place)
    qx, qy, qz, feature, height = closest_point(leaves, o, px, py, pz)
    if feature == 0:
        along = height * leaves[o + U(17 * LEAF)]
        return qx, qy, qz, int(along > 0.0) - int(along < 0.0)
    i = 3 * row[slots[place] * 6 + feature - 1]
    nx, ny, nz = normal[i], normal[i + 1], normal[i + 2]
    dx, dy, dz = px - qx, py - qy, pz - qz
    along = dx * nx + dy * ny + dz * nz
    doubt = 1e-9 * np.sqrt((dx * dx + dy * dy + dz * dz) * (nx * nx + ny * ny + nz * nz))
    return qx, qy, qz, int(along > doubt) - int(along < -doubt)
