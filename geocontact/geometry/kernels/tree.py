"""The bounded tree: built once, queried with the largest distance that matters.

Bounding the query is most of the speed: what lies further away than the limit is dismissed at the first boxes.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from geocontact.geometry.kernels.compile import kernel
from geocontact.geometry.kernels.triangle import closest_point
from geocontact.geometry.kernels.wide import FAN, LEAF, STACK, box_distances, leaf_distances


class Tree(NamedTuple):
    """Arrays of the tree; triangles are numbered by *slot*, their order along the leaves.

    root (6,) lower and upper corner of everything; boxes, child, leaves, slots, fill as `widen` makes them, a *place*
    being a leaf times LEAF plus a position in it; face (m,) the face of each slot;
    normal (m, 7, 3) angle-weighted pseudo-normals of the seven features of each slot, zero where a feature touches a
    degenerate or tangled face and has no trustworthy normal.
    """

    root: np.ndarray
    boxes: np.ndarray
    child: np.ndarray
    leaves: np.ndarray
    slots: np.ndarray
    fill: np.ndarray
    face: np.ndarray
    normal: np.ndarray


class Scratch(NamedTuple):
    """Working memory of one thread's queries."""

    node: np.ndarray
    key: np.ndarray
    square: np.ndarray
    fan: int


@kernel
def scratch():  # type: ignore[no-untyped-def]
    """Fresh working memory."""
    return Scratch(np.empty(STACK, np.int64), np.empty(STACK), np.empty(max(FAN, LEAF)), FAN)


@kernel
def nearest(tree, x, y, z, limit2, w):  # type: ignore[no-untyped-def]
    """Squared distance and place of the nearest triangle; place -1 when none is nearer than sqrt(limit2)."""
    best = limit2
    place = -1
    w.node[0] = 0
    w.key[0] = 0.0
    waiting = 1
    while waiting > 0:
        waiting -= 1
        if w.key[waiting] >= best:
            continue
        node = w.node[waiting]
        if node < 0:
            leaf = -2 - node
            leaf_distances(tree.leaves, leaf, x, y, z, w.square, tree.fill[leaf])
            for j in range(tree.fill[leaf]):
                if w.square[j] < best:
                    best = w.square[j]
                    place = leaf * LEAF + j
            continue
        box_distances(tree.boxes, node, x, y, z, w.square, w.fan)
        base = waiting
        for j in range(FAN):
            d2 = w.square[j]
            if d2 < best:
                k = waiting  # the nearest child ends on top
                while k > base and w.key[k - 1] < d2:
                    w.key[k] = w.key[k - 1]
                    w.node[k] = w.node[k - 1]
                    k -= 1
                w.key[k] = d2
                w.node[k] = tree.child[node, j]
                waiting += 1
    return best, place


@kernel
def in_box(box, x, y, z):  # type: ignore[no-untyped-def]
    """Whether a point lies inside a box (6,)."""
    return box[0] < x < box[3] and box[1] < y < box[4] and box[2] < z < box[5]


@kernel
def squared_distance(tree, place, x, y, z):  # type: ignore[no-untyped-def]
    """Squared distance of a point to the triangle at a place."""
    qx, qy, qz, _, _ = closest_point(tree.leaves[place // LEAF], place % LEAF, x, y, z)
    return (x - qx) ** 2 + (y - qy) ** 2 + (z - qz) ** 2


@kernel
def side_of(tree, place, px, py, pz):  # type: ignore[no-untyped-def]
    """Closest point on a triangle and the side the point is on: 1 outside, -1 inside, 0 where normals cannot tell.

    Angle-weighted pseudo-normals: Baerentzen & Aanaes, Signed distance computation using the angle weighted
    pseudonormal, IEEE TVCG 11 (2005). Right for closed, consistently oriented surfaces without self-intersection.
    """
    leaf, j = place // LEAF, place % LEAF
    qx, qy, qz, feature, height = closest_point(tree.leaves[leaf], j, px, py, pz)
    if feature == 0:
        along = height * tree.leaves[leaf, 17, j]
        return qx, qy, qz, (along > 0.0) - (along < 0.0)
    n = tree.normal[tree.slots[leaf, j], feature]
    dx = px - qx
    dy = py - qy
    dz = pz - qz
    along = dx * n[0] + dy * n[1] + dz * n[2]
    doubt = 1e-9 * np.sqrt((dx * dx + dy * dy + dz * dz) * (n[0] * n[0] + n[1] * n[1] + n[2] * n[2]))
    return qx, qy, qz, (along > doubt) - (along < -doubt)
