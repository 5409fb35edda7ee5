"""Faces of a surface that are pierced by edges of the same surface: there normals cannot tell inside from outside."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.binary import DEPTH
from geocontact.geometry.kernels.compile import inner, kernel

SIDES = 3
ROUNDING = 1e-12  # share of the cube of the size below which a volume is none


@kernel
def pierced(tree, corner, faces):
    """Marks faces that take part in a self-intersection, (m,) bool.

    corner (m, 3, 3) positions, faces (m, 3) indices after merging coincident vertices. An edge is tested against every
    face that shares no vertex with it; both the faces of the edge and the pierced face are marked.
    """
    marked = np.zeros(len(faces), np.bool_)
    nodes = np.empty(2 * DEPTH + 64, np.int64)
    for f in range(len(faces)):
        for k in range(SIDES):
            i, j = faces[f, k], faces[f, (k + 1) % 3]
            if i < j:  # each edge once; its other face is marked through the shared vertices by the caller
                _pierce(tree, corner, faces, f, k, (k + 1) % 3, nodes, marked)
    return marked


@inner
def _pierce(tree, corner, faces, f, k, l, nodes, marked):
    p = corner[f, k]
    q = corner[f, l]
    lo = np.empty(3)
    hi = np.empty(3)
    for x in range(3):
        lo[x] = min(p[x], q[x])
        hi[x] = max(p[x], q[x])
    nodes[0] = 0
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = nodes[waiting]
        first, count = tree.first[node], tree.size[node]
        if count == 0:
            for child in range(2):
                if _meets(tree.pairs, 12 * node + 6 * child, lo, hi):
                    nodes[waiting] = first + child
                    waiting += 1
            continue
        for slot in range(first, first + count):
            g = tree.order[slot]
            if _share(faces[g], faces[f, k], faces[f, l]):
                continue
            if _crosses(p, q, corner[g, 0], corner[g, 1], corner[g, 2]):
                marked[f] = True
                marked[g] = True


@inner
def _meets(box, o, lo, hi):
    for k in range(3):
        if box[o + k] > hi[k] or box[o + k + 3] < lo[k]:
            return False
    return True


@inner
def _share(face, i, j):
    for k in range(SIDES):
        if face[k] == i or face[k] == j:
            return True
    return False


@inner
def _volume(a, b, c, d):
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    wx, wy, wz = d[0] - a[0], d[1] - a[1], d[2] - a[2]
    return ux * (vy * wz - vz * wy) + uy * (vz * wx - vx * wz) + uz * (vx * wy - vy * wx)


@inner
def _extent(a, b):
    """Largest difference of two points along an axis."""
    return max(abs(b[0] - a[0]), max(abs(b[1] - a[1]), abs(b[2] - a[2])))


@inner
def _crosses(p, q, a, b, c):
    """Whether segment pq passes through triangle abc: its ends clearly on different sides, rounding apart."""
    size = max(max(_extent(p, q), _extent(a, b)), max(_extent(a, c), _extent(p, a)))
    zero = ROUNDING * size * size * size
    above = _volume(a, b, c, p)
    below = _volume(a, b, c, q)
    if not ((above > zero and below < -zero) or (above < -zero and below > zero)):
        return False
    x, y, z = _volume(p, q, a, b), _volume(p, q, b, c), _volume(p, q, c, a)
    return (x >= -zero and y >= -zero and z >= -zero) or (x <= zero and y <= zero and z <= zero)
