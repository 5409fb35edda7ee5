"""Least distance of edges to a surface, where the distances of their ends are known.

Two surfaces that do not meet are nearest either at a vertex of one of them or between two edges, and two surfaces meet
where an edge of one passes through a face of the other. The vertices being measured, edges are what is left; most are
dismissed by the distances d, d' of their ends and their length e: the distance along an edge is 1-Lipschitz, and its
square is not below the linear interpolation of d^2 and d'^2 less t (1 - t) e^2 (see `certify`); see `rise` for a third.
"""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.compile import kernel, lean
from geocontact.geometry.kernels.rise import plane_of, rise_of, size_of
from geocontact.geometry.kernels.tree import nearest, offset, scratch
from geocontact.geometry.kernels.triangle import LEAF, U
from geocontact.geometry.kernels.wide import FAN, ROWS, box_distances, leaf_distances

ROUND = 1e-12  # relative allowance for rounding in the bounds
HALVINGS = 12  # an edge is divided at most this often before faces are looked at one by one


@kernel
def near_edges(tree, place, above, below, reach, signed, ends, length, points, distance, slot, bar):
    """Edges that may come nearer than `bar`, and for each a distance that no point of it is below.

    ends (q, 2) index points (n, 3); distance (n,) is the true one where slot (n,) is not -1, else a lower bound of it.
    above, below (m,), reach as for `promising`; without `signed` both sides of a face are alike, with it what is free
    below a face is not asked for.
    """
    leaves = tree.leaves
    keep = np.empty(len(ends), np.int64)
    floors = np.empty(len(ends))
    nodes, keys, square, fan = scratch()
    count = 0
    for q in range(len(ends)):
        i, j, e = ends[q, 0], ends[q, 1], length[q]
        a, b = distance[i], distance[j]
        low = 0.5 * (a + b - e)  # 1-Lipschitz from both ends
        if low >= bar:
            continue
        low2 = min(a, b) ** 2
        if abs(a * a - b * b) < e * e:
            low2 = a * a - (a * a - b * b + e * e) ** 2 / (4.0 * e * e)
        low2 -= ROUND * (a * a + b * b + e * e)
        low = max(low, np.sqrt(max(low2, 0.0)))
        for end in range(2):
            s = slot[ends[q, end]]
            if s >= 0 and low < bar and reach > 0.0:
                radius = reach + size_of(leaves, place[s])
                clear = _clear_of(
                    tree, place[s], s, above, below, radius, signed, points, i, j, nodes, keys, square, fan
                )
                low = max(low, clear)
        if low < bar:
            keep[count] = q
            floors[count] = low
            count += 1
    return keep[:count].copy(), floors[:count].copy()


@lean
def _clear_of(tree, place, s, above, below, radius, signed, points, i, j, nodes, keys, square, fan):
    """Bound of the distance between points i and j by the face at a place; 0 where there is none."""
    cx, cy, cz, nx, ny, nz = plane_of(tree.leaves, place)
    ax, ay, az = points[i, 0] - cx, points[i, 1] - cy, points[i, 2] - cz
    bx, by, bz = points[j, 0] - cx, points[j, 1] - cy, points[j, 2] - cz
    a, b = ax * nx + ay * ny + az * nz, bx * nx + by * ny + bz * nz
    if a * b <= 0.0 or (signed and a < 0.0):
        return 0.0
    if a > 0.0:
        if np.isnan(above[s]):
            above[s] = rise_of(tree, cx, cy, cz, nx, ny, nz, radius, signed, nodes, keys, square, fan)
        rise = above[s]
    else:
        if np.isnan(below[s]):
            below[s] = rise_of(tree, cx, cy, cz, -nx, -ny, -nz, radius, signed, nodes, keys, square, fan)
        rise = below[s]
    a, b = abs(a) - rise, abs(b) - rise
    if a <= 0.0 or b <= 0.0:
        return 0.0
    far = max(np.sqrt(ax * ax + ay * ay + az * az) + a, np.sqrt(bx * bx + by * by + bz * bz) + b)
    return min(a, b) if far < radius else 0.0


@kernel
def edge_gap(tree, start, end, floors, best):
    """Least distance of edges, start to end (q, 3), to the surface: 0 where one meets it, `best` if none is nearer.

    floors (q,), growing: no point of an edge is nearer than that. The ends themselves are taken as measured already.
    """
    boxes, child, leaves, fill = tree.boxes, tree.child, tree.leaves, tree.fill
    nodes, keys, square, fan = scratch()
    pieces = np.empty((HALVINGS + 2, 6))
    level = np.empty(HALVINGS + 2, np.int64)
    for q in range(len(start)):
        if floors[q] >= best or best == 0.0:
            break
        for k in range(3):
            pieces[0, k] = start[q, k]
            pieces[0, 3 + k] = end[q, k]
        level[0] = 0
        waiting = 1
        while waiting > 0 and best > 0.0:
            waiting -= 1
            piece, depth = pieces[waiting], level[waiting]
            x, y, z = 0.5 * (piece[0] + piece[3]), 0.5 * (piece[1] + piece[4]), 0.5 * (piece[2] + piece[5])
            ux, uy, uz = x - piece[0], y - piece[1], z - piece[2]
            half = np.sqrt(ux * ux + uy * uy + uz * uz) * (1.0 + ROUND)
            limit = (best + half) * (1.0 + ROUND)
            d2, found = nearest(boxes, child, leaves, fill, x, y, z, limit * limit, nodes, keys, square, fan)
            if found < 0:
                continue
            d = np.sqrt(d2)
            best = min(best, d)
            o = offset(found)
            if depth < HALVINGS and half > d + 2.0 * leaves[o + U(12 * LEAF)]:
                for k in range(3):
                    pieces[waiting + 1, 3 + k] = piece[3 + k]
                pieces[waiting, 3] = pieces[waiting + 1, 0] = x
                pieces[waiting, 4] = pieces[waiting + 1, 1] = y
                pieces[waiting, 5] = pieces[waiting + 1, 2] = z
                level[waiting] = depth + 1
                level[waiting + 1] = depth + 1
                waiting += 2
                continue
            best = _piece_gap(boxes, child, leaves, fill, piece, x, y, z, half, best, nodes, square, fan)
    return best


@lean
def _piece_gap(boxes, child, leaves, fill, piece, x, y, z, half, best, nodes, square, fan):
    """The less of `best` and the least distance of a piece, given its middle and half length, to the faces."""
    nodes[0] = 0
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = nodes[waiting]
        limit2 = ((best + half) * (1.0 + ROUND)) ** 2
        if node >= 0:
            box_distances(boxes, U(node) * U(6 * FAN), x, y, z, square, fan)
            for j in range(FAN):
                if square[j] <= limit2:
                    nodes[waiting] = child[node * FAN + j]
                    waiting += 1
            continue
        leaf = -2 - node
        leaf_distances(leaves, U(leaf) * U(ROWS * LEAF), x, y, z, square, fill[leaf])
        for j in range(fill[leaf]):
            if square[j] <= limit2:
                best = min(best, _segment_to_triangle(leaves, U(leaf) * U(ROWS * LEAF) + U(j), piece))
                if best == 0.0:
                    return best
    return best


@lean
def _segment_to_triangle(leaves, o, piece):
    """Distance of a segment to the three edges of the triangle at offset o, 0 where it passes through its inside.

    In the triangle's frame: corners (0, 0), (length, 0), (cx, cy) of the plane z = 0.
    """
    p = _local(leaves, o, piece[0], piece[1], piece[2])
    q = _local(leaves, o, piece[3], piece[4], piece[5])
    length, cx, cy = leaves[o + U(12 * LEAF)], leaves[o + U(13 * LEAF)], leaves[o + U(14 * LEAF)]
    if (p[2] > 0.0) != (q[2] > 0.0) and cy > 0.0:
        t = p[2] / (p[2] - q[2])
        x, y = p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])
        if y >= 0.0 and x * cy >= y * cx and y * (cx - length) >= (x - length) * cy:
            return 0.0
    d2 = _segments2(p, q, 0.0, 0.0, length, 0.0)
    d2 = min(d2, _segments2(p, q, 0.0, 0.0, cx, cy))
    d2 = min(d2, _segments2(p, q, length, 0.0, cx, cy))
    return np.sqrt(d2)


@lean
def _local(leaves, o, x, y, z):
    """A point in the frame of the triangle at offset o."""
    dx, dy, dz = x - leaves[o], y - leaves[o + U(LEAF)], z - leaves[o + U(2 * LEAF)]
    return (
        dx * leaves[o + U(6 * LEAF)] + dy * leaves[o + U(7 * LEAF)] + dz * leaves[o + U(8 * LEAF)],
        dx * leaves[o + U(9 * LEAF)] + dy * leaves[o + U(10 * LEAF)] + dz * leaves[o + U(11 * LEAF)],
        dx * leaves[o + U(3 * LEAF)] + dy * leaves[o + U(4 * LEAF)] + dz * leaves[o + U(5 * LEAF)],
    )


@lean
def _segments2(p, q, ax, ay, bx, by):
    """Squared distance of segment pq to the segment from (ax, ay, 0) to (bx, by, 0).

    The distance of the lines where it is attained within both, else the least of the distances of an end to the other
    segment: right for parallel segments and points as well.
    """
    ux, uy, uz = q[0] - p[0], q[1] - p[1], q[2] - p[2]
    vx, vy = bx - ax, by - ay
    wx, wy, wz = p[0] - ax, p[1] - ay, p[2]
    a, b, c = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy, vx * vx + vy * vy
    d, e = ux * wx + uy * wy + uz * wz, vx * wx + vy * wy
    det = a * c - b * b
    if det > 1e-14 * a * c:
        s, t = (b * e - c * d) / det, (a * e - b * d) / det
        if 0.0 <= s <= 1.0 and 0.0 <= t <= 1.0:
            return (wx + s * ux - t * vx) ** 2 + (wy + s * uy - t * vy) ** 2 + (wz + s * uz) ** 2
    best = np.inf
    for k in range(2):  # ends of the second segment to the first
        t = 0.0 if k == 0 else 1.0
        gx, gy, gz = wx - t * vx, wy - t * vy, wz
        s = min(max(-(gx * ux + gy * uy + gz * uz) / a, 0.0), 1.0) if a > 0.0 else 0.0
        best = min(best, (gx + s * ux) ** 2 + (gy + s * uy) ** 2 + (gz + s * uz) ** 2)
    for k in range(2):  # ends of the first to the second
        s = 0.0 if k == 0 else 1.0
        gx, gy, gz = wx + s * ux, wy + s * uy, wz + s * uz
        t = min(max((gx * vx + gy * vy) / c, 0.0), 1.0) if c > 0.0 else 0.0
        best = min(best, (gx - t * vx) ** 2 + (gy - t * vy) ** 2 + gz * gz)
    return best
