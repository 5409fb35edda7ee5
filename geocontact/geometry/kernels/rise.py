"""How far a surface rises over the plane of one of its faces, nearby: a bound of the signed distance that is linear.

Let c and n be the middle and the outward normal of a face, and let no part of the surface within `radius` of c be more
than h above its plane. What lies higher and within the radius is then free of the surface, and one side of it. With
g(x) = n (x - c) - h and |x - c| + |g(x)| < radius:

* g(x) > 0: no point of the surface is nearer to x than g(x);
* where that free part is outside, also g(x) <= 0: x is outside, or going along n leads out of the body within |g(x)|.

So the signed distance is not below g. The first of the two holds below the plane as well.
"""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.compile import lean
from geocontact.geometry.kernels.tree import nearest, offset, side_of
from geocontact.geometry.kernels.triangle import LEAF, U
from geocontact.geometry.kernels.wide import FAN, ROWS, box_distances, leaf_distances

ROUND = 1e-12  # share of the radius that rounding may cost


@lean
def plane_of(leaves, place):
    """Middle (3) and outward unit normal (3) of the triangle at a place; a zero normal where there is no telling."""
    o = offset(place)
    s = (leaves[o + U(12 * LEAF)] + leaves[o + U(13 * LEAF)]) / 3.0
    t = leaves[o + U(14 * LEAF)] / 3.0
    w = leaves[o + U(17 * LEAF)]
    return (
        leaves[o] + s * leaves[o + U(6 * LEAF)] + t * leaves[o + U(9 * LEAF)],
        leaves[o + U(1 * LEAF)] + s * leaves[o + U(7 * LEAF)] + t * leaves[o + U(10 * LEAF)],
        leaves[o + U(2 * LEAF)] + s * leaves[o + U(8 * LEAF)] + t * leaves[o + U(11 * LEAF)],
        w * leaves[o + U(3 * LEAF)],
        w * leaves[o + U(4 * LEAF)],
        w * leaves[o + U(5 * LEAF)],
    )


@lean
def size_of(leaves, place):
    """Largest distance of a corner to the middle of the triangle at a place."""
    o = offset(place)
    l, x, y = leaves[o + U(12 * LEAF)], leaves[o + U(13 * LEAF)], leaves[o + U(14 * LEAF)]
    s, t = (l + x) / 3.0, y / 3.0
    far2 = max(s * s + t * t, (l - s) * (l - s) + t * t)
    return np.sqrt(max(far2, (x - s) * (x - s) + (y - t) * (y - t)))


@lean
def rise_of(tree, cx, cy, cz, nx, ny, nz, radius, signed, nodes, keys, square, fan):
    """What `height_within` gives; when `signed`, infinite as well where what is higher is not outside.

    The last four arguments are `scratch`, here and below.
    """
    height = height_within(tree, cx, cy, cz, nx, ny, nz, radius, radius, nodes, square, fan)
    if not signed or height == np.inf:
        return height
    outside = free_above(tree, cx, cy, cz, nx, ny, nz, height, radius, nodes, keys, square, fan)
    return height if outside else np.inf


@lean
def height_within(tree, cx, cy, cz, nx, ny, nz, radius, most, nodes, square, fan):
    """Height over the plane through c across the unit vector n that the surface reaches within `radius` of c.

    Infinite where it reaches as far as `most`, which is not above the radius, and where n is zero.
    """
    if nx == 0.0 and ny == 0.0 and nz == 0.0:
        return np.inf
    boxes, child, leaves, fill = tree.boxes, tree.child, tree.leaves, tree.fill
    height = -np.inf
    r2 = radius * radius * (1.0 + ROUND)
    nodes[0] = 0
    waiting = 1
    while waiting > 0:
        waiting -= 1
        node = nodes[waiting]
        if node >= 0:
            box_distances(boxes, U(node) * U(6 * FAN), cx, cy, cz, square, fan)
            for j in range(FAN):
                if square[j] <= r2:
                    nodes[waiting] = child[node * FAN + j]
                    waiting += 1
            continue
        leaf = -2 - node
        leaf_distances(leaves, U(leaf) * U(ROWS * LEAF), cx, cy, cz, square, fill[leaf])
        for j in range(fill[leaf]):
            if square[j] <= r2:
                height = max(height, _highest(leaves, leaf * LEAF + j, cx, cy, cz, nx, ny, nz, radius))
        if height >= most:
            return np.inf
    height += ROUND * radius
    return np.inf if height >= most else height


@lean
def free_above(tree, cx, cy, cz, nx, ny, nz, height, radius, nodes, keys, square, fan):
    """Whether what is higher than `height` within the radius, being free of the surface, is outside."""
    step = 0.5 * (max(height, -radius) + radius)
    x, y, z = cx + step * nx, cy + step * ny, cz + step * nz
    _, found = nearest(tree.boxes, tree.child, tree.leaves, tree.fill, x, y, z, np.inf, nodes, keys, square, fan)
    _, _, _, side = side_of(tree.leaves, tree.slots, tree.normal, tree.row, found, x, y, z)
    return side > 0


@lean
def _highest(leaves, place, cx, cy, cz, nx, ny, nz, radius):
    """Bound of the height over the plane through c across n that a triangle has within `radius` of c.

    That of its highest corner, and that of the highest point of its plane within the radius: its foot's and as much as
    the plane can rise from there.
    """
    o = offset(place)
    dx, dy, dz = leaves[o] - cx, leaves[o + U(LEAF)] - cy, leaves[o + U(2 * LEAF)] - cz
    mx, my, mz = leaves[o + U(3 * LEAF)], leaves[o + U(4 * LEAF)], leaves[o + U(5 * LEAF)]
    u = leaves[o + U(6 * LEAF)] * nx + leaves[o + U(7 * LEAF)] * ny + leaves[o + U(8 * LEAF)] * nz
    v = leaves[o + U(9 * LEAF)] * nx + leaves[o + U(10 * LEAF)] * ny + leaves[o + U(11 * LEAF)] * nz
    a = dx * nx + dy * ny + dz * nz
    b = a + leaves[o + U(12 * LEAF)] * u
    c = a + leaves[o + U(13 * LEAF)] * u + leaves[o + U(14 * LEAF)] * v
    foot = dx * mx + dy * my + dz * mz
    rise = foot * (mx * nx + my * ny + mz * nz)
    rise += np.sqrt(max(radius * radius - foot * foot, 0.0) * (u * u + v * v))
    return min(max(a, max(b, c)), rise)
