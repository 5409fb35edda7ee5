"""Faces of a surface that are pierced by edges of the same surface: there normals cannot tell inside from outside."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.binary import DEPTH
from geocontact.geometry.kernels.compile import kernel

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


@kernel
def _pierce(tree, corner, faces, f, k, l, nodes, marked):
    p = corner[f, k]
    q = corner[f, l]
    lo = np.minimum(p, q)
    hi = np.maximum(p, q)
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


@kernel
def _meets(box, o, lo, hi):
    for k in range(3):
        if box[o + k] > hi[k] or box[o + k + 3] < lo[k]:
            return False
    return True


@kernel
def _share(face, i, j):
    for k in range(SIDES):
        if face[k] == i or face[k] == j:
            return True
    return False


@kernel
def _volume(a, b, c, d):
    u, v, w = b - a, c - a, d - a
    return u[0] * (v[1] * w[2] - v[2] * w[1]) + u[1] * (v[2] * w[0] - v[0] * w[2]) + u[2] * (v[0] * w[1] - v[1] * w[0])


@kernel
def _crosses(p, q, a, b, c):
    """Whether segment pq passes through triangle abc: its ends clearly on different sides, rounding apart."""
    size = max(np.abs(q - p).max(), np.abs(b - a).max(), np.abs(c - a).max(), np.abs(a - p).max())
    zero = ROUNDING * size * size * size
    above = _volume(a, b, c, p)
    below = _volume(a, b, c, q)
    if not ((above > zero and below < -zero) or (above < -zero and below > zero)):
        return False
    x, y, z = _volume(p, q, a, b), _volume(p, q, b, c), _volume(p, q, c, a)
    return (x >= -zero and y >= -zero and z >= -zero) or (x <= zero and y <= zero and z <= zero)
