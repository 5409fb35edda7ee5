"""The least signed distance of triangles to a closed surface: which of them can hold it, divided until none can."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.compile import inner, kernel, lean, part
from geocontact.geometry.kernels.quarter import ROUNDING, SLACK
from geocontact.geometry.kernels.rise import free_above, height_within, plane_of, rise_of, size_of
from geocontact.geometry.kernels.tree import nearest, offset, scratch, side_of
from geocontact.geometry.kernels.triangle import closest_point

MARGIN = 0.25  # edges of a triangle that the radius about it leaves for the rise


@kernel
def deepest(tree, place, above, reach, use, faces, edges, points, signed, slot, best, tolerance, most, effort):
    """The less of `best` and the least signed distance of the faces, within `tolerance`.

    Faces that can be deeper are divided into their quarters, at most `most` of them at a time. effort (2,), written
    here: how often that may happen again, and how many have been divided so far. The arguments up to slot are those of
    `promising`. Without `use`, or where normals do not give the side of a new point, it stops for the caller to find
    the sides. Returns best and, where it stopped for that, the quarters: faces (k, 3), edges (k, 3), points, signed,
    slot as they were given, and side (n,), 1 outside, -1 inside, 0 in doubt. Points are six for each divided face: its
    corners, whose sides are known, and the middles of its edges.
    """
    side = np.empty(0, np.int8)
    while True:
        for f in range(len(faces)):
            best = min(best, signed[faces[f, 0]], signed[faces[f, 1]], signed[faces[f, 2]])
        keep, floor = promising(tree, place, above, reach, use, faces, edges, points, signed, slot, best - tolerance)
        if len(keep) == 0 or effort[0] == 0:
            return best, faces[:0], edges[:0], points, signed, slot, side
        keep = _lowest(keep, floor, most)
        faces, edges, points, signed, slot = _taken(keep, faces, edges, points, signed, slot)
        side = np.empty(len(points), np.int8)
        asked = _measured(tree, use, points, signed, slot, side)
        effort[0] -= 1
        effort[1] += len(keep)
        above = above[:0]  # known for triangles as given, worth finding anew for smaller ones
        if asked or not use:
            return best, faces, edges, points, signed, slot, side


@inner
def _lowest(keep, floor, most):
    """Those of `keep` with the lowest floors, at most `most` of them."""
    if len(keep) <= most:
        return keep
    low, bar = np.inf, -np.inf
    for each in floor:
        low, bar = min(low, each), max(bar, each)
    room = most
    for _ in range(64):  # up to `low` lie no more than `most` of them, up to `bar` more
        middle = low + 0.5 * (bar - low)
        count = 0
        for each in floor:
            count += each <= middle
        if count > most:
            bar = middle
        else:
            low, room = middle, most - count
    count = 0
    for k in range(len(keep)):
        if floor[k] <= low or (floor[k] <= bar and room > 0):
            room -= floor[k] > low
            if count < most:
                keep[count] = keep[k]
                count += 1
    return keep[:count]


@inner
def _taken(keep, faces, edges, points, signed, slot):
    """Quarters of the faces in `keep`, and six points of each: its corners, and its edges' middles, to be measured.

    The quarters are similar to their parent, so their edges are half of its edges.
    """
    n = len(keep)
    quarters, halves = np.empty((4 * n, 3), np.int64), np.empty((4 * n, 3))
    placed, known, where = np.empty((6 * n, 3)), np.empty(6 * n), np.empty(6 * n, np.int64)
    for q in range(n):
        for c in range(3):
            corner = faces[keep[q], c]
            i, j = faces[keep[q], (c + 1) % 3], faces[keep[q], (c + 2) % 3]
            known[6 * q + c], where[6 * q + c] = signed[corner], slot[corner]
            known[6 * q + 3 + c], where[6 * q + 3 + c] = np.inf, -1
            for k in range(3):
                placed[6 * q + c, k] = points[corner, k]
                placed[6 * q + 3 + c, k] = 0.5 * (points[i, k] + points[j, k])
                # corner c first, as in the face, between the middles of the edges beside it
                quarters[4 * q + c, k] = 6 * q + (c if k == c else 6 - c - k)
                halves[4 * q + c, k] = halves[4 * q + 3, k] = 0.5 * edges[keep[q], k]
            quarters[4 * q + 3, c] = 6 * q + 3 + c
    return quarters, halves, placed, known, where


@inner
def _measured(tree, use, points, signed, slot, side):
    """Fill in what is not known of the middles of edges, and say whether the side of one of them is in doubt.

    A middle is searched for as far as the ends of its edge allow: distance is 1-Lipschitz. Without `use` all are taken
    as outside, for the caller to find the sides of those that can be inside.
    """
    nodes, keys, square, fan = scratch()
    asked = False
    for m in range(len(points)):
        if m % 6 < 3:
            side[m] = 1
            continue
        first = m - m % 6
        i, j = first + (m % 6 - 2) % 3, first + (m % 6 - 1) % 3
        x, y, z = points[m, 0], points[m, 1], points[m, 2]
        half = np.sqrt((x - points[i, 0]) ** 2 + (y - points[i, 1]) ** 2 + (z - points[i, 2]) ** 2)
        nearby = min(abs(signed[i]) if slot[i] >= 0 else np.inf, abs(signed[j]) if slot[j] >= 0 else np.inf)
        limit = (nearby + half) * (1.0 + SLACK) + ROUNDING
        d2, found = nearest(
            tree.boxes, tree.child, tree.leaves, tree.fill, x, y, z, limit * limit, nodes, keys, square, fan
        )
        side[m] = 1
        if use:
            _, _, _, side[m] = side_of(tree.leaves, tree.slots, tree.normal, tree.row, found, x, y, z)
        signed[m], slot[m] = np.sqrt(d2), tree.slots[found]
        if side[m] < 0:
            signed[m] = -signed[m]
        asked = asked or side[m] == 0
    return asked


@part
def promising(tree, place, above, reach, use, faces, edges, points, signed, slot, bar):
    """Faces that may reach below `bar` <= 0 and, for each, a value that no point of it is below.

    faces (k, 3) index points (n, 3), signed (n,), slot (n,) as `signed_distances` finds them; edges (k, 3) are the
    lengths opposite to each corner. signed is infinite beyond a point's limit, and such a point is outside by more than
    any edge at it. place (m,) is the place of each slot. With `use` the rise over the planes of faces counts. above
    (m,) holds it for each slot with the radius `reach` beyond its triangle, NaN where it has not been asked for; where
    that is not enough, or above is empty, it is found anew for each face, with no larger radius than that face needs.
    """
    leaves = tree.leaves
    keep = np.empty(len(faces), np.int64)
    floors = np.empty(len(faces))
    count = 0
    v = np.empty((3, 3))
    far = np.empty((3, 3))
    own, alike = np.empty(3, np.int64), np.empty(3, np.int64)
    nodes, keys, square, fan = scratch()
    for f in range(len(faces)):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        if max(signed[i], max(signed[j], signed[k])) == np.inf:
            continue
        e0, e1, e2 = edges[f, 0], edges[f, 1], edges[f, 2]
        low = max(signed[i] - max(e1, e2), signed[j] - max(e2, e0), signed[k] - max(e0, e1))  # 1-Lipschitz
        if low >= bar:
            continue
        for c in range(3):
            for x in range(3):
                v[c, x] = points[faces[f, c], x]
        for c in range(3):
            s = own[c] = slot[faces[f, c]]
            alike[c] = 0 if c > 0 and s == own[0] else (1 if c > 1 and s == own[1] else -1)
            if len(above) == 0 or s < 0 or low >= bar or not use or alike[c] >= 0:
                continue  # a plane that two corners share says the same twice
            cx, cy, cz, nx, ny, nz = plane_of(leaves, place[s])
            radius = reach + size_of(leaves, place[s])
            if np.isnan(above[s]):
                above[s] = rise_of(tree, cx, cy, cz, nx, ny, nz, radius, use, nodes, keys, square, fan)
            low = max(low, _over_plane(cx, cy, cz, nx, ny, nz, above[s], radius, v))
        if low >= bar:
            continue
        for c in range(3):
            for corner in range(3):
                if alike[c] >= 0:
                    far[c, corner] = far[alike[c], corner]
                else:
                    far[c, corner] = np.inf if own[c] < 0 else _to_triangle(leaves, place[own[c]], v, corner)
        low = max(low, -_farthest(far))
        margin = MARGIN * max(e0, max(e1, e2))
        for c in range(3):
            if low < bar and use and own[c] >= 0 and alike[c] < 0:
                at = place[own[c]]
                a, b, d = signed[i], signed[j], signed[k]
                nearby = _over_plane_nearby(tree, at, margin, v, a, b, d, bar, nodes, keys, square, fan)
                low = max(low, nearby)
        if low < bar:
            keep[count] = f
            floors[count] = low
            count += 1
    return keep[:count].copy(), floors[:count].copy()


@lean
def _over_plane_nearby(tree, place, margin, v, a, b, c, bar, nodes, keys, square, fan):
    """Bound of the signed distance over a triangle v (3, 3) by the plane of the face at a place, about v's middle.

    It is -inf where it would lie below `bar`, which is known before the whole neighbourhood has been looked at.
    a, b, c are the signed distances of its corners: one that is outside and above says that what is free is outside.
    """
    cx, cy, cz, nx, ny, nz = plane_of(tree.leaves, place)
    mx = (v[0, 0] + v[1, 0] + v[2, 0]) / 3.0
    my = (v[0, 1] + v[1, 1] + v[2, 1]) / 3.0
    mz = (v[0, 2] + v[1, 2] + v[2, 2]) / 3.0
    h = (mx - cx) * nx + (my - cy) * ny + (mz - cz) * nz
    cx, cy, cz = mx - h * nx, my - h * ny, mz - h * nz
    radius, lowest = 0.0, np.inf
    for corner in range(3):
        dx, dy, dz = v[corner, 0] - cx, v[corner, 1] - cy, v[corner, 2] - cz
        h = dx * nx + dy * ny + dz * nz
        radius = max(radius, np.sqrt(dx * dx + dy * dy + dz * dz) + abs(h))
        lowest = min(lowest, h)
    if lowest < bar:  # the face itself is as high as its plane
        return -np.inf
    radius += margin
    rise = height_within(tree, cx, cy, cz, nx, ny, nz, radius, min(radius, lowest - bar), nodes, square, fan)
    low = _over_plane(cx, cy, cz, nx, ny, nz, rise, radius, v)
    if low == -np.inf:
        return low
    for corner, signed in enumerate((a, b, c)):
        h = (v[corner, 0] - cx) * nx + (v[corner, 1] - cy) * ny + (v[corner, 2] - cz) * nz
        if h > rise and signed > 0.0:
            return low
    outside = free_above(tree, cx, cy, cz, nx, ny, nz, rise, radius, nodes, keys, square, fan)
    return low if outside else -np.inf


@lean
def _over_plane(cx, cy, cz, nx, ny, nz, rise, radius, v):
    """Bound of the signed distance over a triangle v (3, 3) by the rise over a plane; -inf where it does not hold."""
    if rise == np.inf:
        return -np.inf
    low = np.inf
    for c in range(3):
        dx, dy, dz = v[c, 0] - cx, v[c, 1] - cy, v[c, 2] - cz
        g = dx * nx + dy * ny + dz * nz - rise
        if np.sqrt(dx * dx + dy * dy + dz * dz) + abs(g) >= radius:
            return -np.inf
        low = min(low, g)
    return low


@lean
def _to_triangle(leaves, place, v, corner):
    """Distance of one of the corners v (3, 3) to the triangle at a place."""
    x, y, z = v[corner, 0], v[corner, 1], v[corner, 2]
    qx, qy, qz, _, _ = closest_point(leaves, offset(place), x, y, z)
    return np.sqrt((x - qx) ** 2 + (y - qy) ** 2 + (z - qz) ** 2)


@lean
def _farthest(far):
    """Bound of the distance over a triangle by those of its corners to three faces: far (face, corner).

    The distance to a face is convex, and so is a weighted mean of two of them, which the smaller one is not above: its
    largest value is at a corner. The mean tells what is deepest half-way between two walls.
    """
    best = np.inf
    for i in range(3):
        best = min(best, max(far[i, 0], max(far[i, 1], far[i, 2])))
    for i in range(3):
        j = (i + 1) % 3
        if far[i, 0] == np.inf or far[j, 0] == np.inf:
            continue
        for c in range(3):  # the best weight is one at which two corners are alike
            d = (c + 1) % 3
            slope = far[i, c] - far[j, c] - far[i, d] + far[j, d]
            if slope == 0.0:
                continue
            w = (far[j, d] - far[j, c]) / slope
            if 0.0 < w < 1.0:
                mean = w * far[i, 0] + (1.0 - w) * far[j, 0]
                mean = max(mean, w * far[i, 1] + (1.0 - w) * far[j, 1])
                best = min(best, max(mean, w * far[i, 2] + (1.0 - w) * far[j, 2]))
    return best
