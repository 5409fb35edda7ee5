"""Point to triangle in the triangle's own frame: right for degenerate and collinear triangles too.

Each triangle is stored as 16 numbers: corner A (3), unit vectors n, u, v (9), L, cx, cy, shift. The longest edge AB
lies along u with length L; C is at (cx, cy) with cy >= 0; n = u x v points to the outside. `shift` tells which corner
of the face became A. Because AB is the longest edge the angles at A and B are acute, which leaves few cases. A
collinear triangle has cy = 0 and is the segment AB, a point has L = 0. The frame is orthonormal even for needles, so
distances are isometric to the last digit there as well.
"""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.compile import inner, kernel, lean

U = np.uint64
LEAF = 32  # triangles in a leaf of the wide tree
FLAT = 1e-13  # height of a triangle over its longest edge below which it is treated as a segment


@kernel
def triangle_frames(vertices, faces):
    """Records of all faces, shape (m, 16)."""
    records = np.zeros((len(faces), 16))
    for i in range(len(faces)):
        _frame(vertices, faces[i], records[i])
    return records


@inner
def _frame(vertices, face, out):
    shift = 0
    longest = -1.0
    for k in range(3):
        i, j = face[(k + 1) % 3], face[k]
        length2 = 0.0
        for x in range(3):
            length2 += (vertices[i, x] - vertices[j, x]) * (vertices[i, x] - vertices[j, x])
        if length2 > longest:
            longest = length2
            shift = k
    a, b, c = face[shift], face[(shift + 1) % 3], face[(shift + 2) % 3]
    length = np.sqrt(longest)
    u = np.zeros(3)
    v = np.empty(3)
    u[0] = 1.0
    if length > 0.0:
        for x in range(3):
            u[x] = (vertices[b, x] - vertices[a, x]) / length
    cx = 0.0
    for x in range(3):
        cx += (vertices[c, x] - vertices[a, x]) * u[x]
    for x in range(3):
        v[x] = vertices[c, x] - vertices[a, x] - cx * u[x]
    cy = _length(v)
    if cy <= FLAT * length or length == 0.0:
        cy = 0.0
        k = 0
        if abs(u[1]) < abs(u[k]):
            k = 1
        if abs(u[2]) < abs(u[k]):
            k = 2
        for x in range(3):
            v[x] = -u[k] * u[x]
        v[k] += 1.0
    else:
        for x in range(3):
            v[x] /= cy
        along = v[0] * u[0] + v[1] * u[1] + v[2] * u[2]
        for x in range(3):
            v[x] -= along * u[x]
    norm = _length(v)
    for x in range(3):
        v[x] /= norm
        out[x] = vertices[a, x]
        out[6 + x] = u[x]
        out[9 + x] = v[x]
    out[3] = u[1] * v[2] - u[2] * v[1]
    out[4] = u[2] * v[0] - u[0] * v[2]
    out[5] = u[0] * v[1] - u[1] * v[0]
    out[12] = length
    out[13] = min(max(cx, 0.0), length)
    out[14] = cy
    out[15] = shift


@lean
def _length(v):
    return np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


@lean
def closest_point(r, o, px, py, pz):
    """Closest point of a triangle, the feature it lies on and the height over the triangle's plane.

    The triangle's numbers are r[o], r[o + LEAF], r[o + 2 LEAF], …, as the leaves of the wide tree hold them.

    Features: 0 interior, 1 edge AB, 2 edge AC, 3 edge BC, 4 corner A, 5 corner B, 6 corner C (letters of the record).
    """
    dx = px - r[o]
    dy = py - r[o + U(1 * LEAF)]
    dz = pz - r[o + U(2 * LEAF)]
    height = dx * r[o + U(3 * LEAF)] + dy * r[o + U(4 * LEAF)] + dz * r[o + U(5 * LEAF)]
    x = dx * r[o + U(6 * LEAF)] + dy * r[o + U(7 * LEAF)] + dz * r[o + U(8 * LEAF)]
    y = dx * r[o + U(9 * LEAF)] + dy * r[o + U(10 * LEAF)] + dz * r[o + U(11 * LEAF)]
    length = r[o + U(12 * LEAF)]
    cx = r[o + U(13 * LEAF)]
    cy = r[o + U(14 * LEAF)]
    feature = 0
    if y < 0.0 or cy == 0.0:
        feature = 1
        if x <= 0.0:
            feature = 4
        elif x >= length:
            feature = 5
        x = min(max(x, 0.0), length)
        y = 0.0
    else:
        left = x * cy - y * cx
        right = (length - x) * cy - y * (length - cx)
        best = np.inf
        qx = x
        qy = y
        if left < 0.0:
            t = min(max((x * cx + y * cy) / (cx * cx + cy * cy), 0.0), 1.0)
            qx = t * cx
            qy = t * cy
            best = (x - qx) ** 2 + (y - qy) ** 2
            feature = 2
            if t == 0.0:
                feature = 4
            elif t == 1.0:
                feature = 6
        if right < 0.0:
            bx = cx - length
            t = min(max(((x - length) * bx + y * cy) / (bx * bx + cy * cy), 0.0), 1.0)
            sx = length + t * bx
            sy = t * cy
            if (x - sx) ** 2 + (y - sy) ** 2 < best:
                qx = sx
                qy = sy
                feature = 3
                if t == 0.0:
                    feature = 5
                elif t == 1.0:
                    feature = 6
        x = qx
        y = qy
    return (
        r[o] + x * r[o + U(6 * LEAF)] + y * r[o + U(9 * LEAF)],
        r[o + U(1 * LEAF)] + x * r[o + U(7 * LEAF)] + y * r[o + U(10 * LEAF)],
        r[o + U(2 * LEAF)] + x * r[o + U(8 * LEAF)] + y * r[o + U(11 * LEAF)],
        feature,
        height,
    )
