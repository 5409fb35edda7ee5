"""Clipped area of a surface at many poses in the field of a fixed one, with its derivative to the pose."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.cells import BEYOND, OPEN, WITHIN, cell_at, verdict
from geocontact.geometry.kernels.compile import inner, kernel
from geocontact.geometry.kernels.tree import nearest, offset, scratch, side_of
from geocontact.geometry.kernels.triangle import LEAF, U, closest_point

MEASURED = np.int8(3)
ON_IT = 1e-12  # m; the direction to the nearest point is lost below
SURE = 1e-9  # m; a side that normals cannot give matters where the distance is larger


@kernel
def face_chunks(points, faces, area, start):
    """Middle, radius and area of the faces from each start to the next; shape (len(start) - 1, 5)."""
    out = np.zeros((len(start) - 1, 5))
    for c in range(len(out)):
        low, high = np.full(3, np.inf), np.full(3, -np.inf)
        for f in range(start[c], start[c + 1]):
            out[c, 4] += area[f]
            for j in range(3):
                for k in range(3):
                    low[k] = min(low[k], points[faces[f, j], k])
                    high[k] = max(high[k], points[faces[f, j], k])
        r2 = 0.0
        for k in range(3):
            out[c, k] = 0.5 * (low[k] + high[k])
        for f in range(start[c], start[c + 1]):
            for j in range(3):
                p = faces[f, j]
                x, y, z = points[p, 0] - out[c, 0], points[p, 1] - out[c, 1], points[p, 2] - out[c, 2]
                r2 = max(r2, x * x + y * y + z * z)
        out[c, 3] = np.sqrt(r2) * (1.0 + 1e-12)
    return out


@inner
def _turned(r, t, x, y, z):
    return (
        r[0, 0] * x + r[0, 1] * y + r[0, 2] * z + t[0],
        r[1, 0] * x + r[1, 1] * y + r[1, 2] * z + t[1],
        r[2, 0] * x + r[2, 1] * y + r[2, 2] * z + t[2],
    )


@inner
def _whole(low, count, coarse, n, state, block, first, near, side, x, y, z, radius, threshold):
    """Verdict over all points within `radius` of a point."""
    number, _ = cell_at(low, count, coarse, n, state, block, first, x, y, z)
    if number < 0:
        far = max(low[0] - x, x - low[0] - count[0] * coarse)
        far = max(far, max(low[1] - y, y - low[1] - count[1] * coarse))
        far = max(far, max(low[2] - z, z - low[2] - count[2] * coarse))
        return BEYOND if far > radius else OPEN
    square = (x - near[number, 0]) ** 2 + (y - near[number, 1]) ** 2 + (z - near[number, 2]) ** 2
    if np.sqrt(square) + radius <= threshold:
        return WITHIN
    if np.sqrt(max(square - near[number, 3], 0.0)) - radius > threshold and side[number] != 0:
        return BEYOND if side[number] > 0 else WITHIN
    return OPEN


@inner
def _slopes(f, odd, out):
    """Share of a triangle where f <= 0 (one or two corners are), its derivatives to the corner values in `out`."""
    i, j, k = odd, (odd + 1) % 3, (odd + 2) % 3
    a, b = f[i] - f[j], f[i] - f[k]
    tip = (f[i] / a) * (f[i] / b)
    sign = 1.0 if f[i] <= 0.0 else -1.0
    out[i] = sign * (2.0 * f[i] / (a * b) - tip / a - tip / b)
    out[j] = sign * tip / a
    out[k] = sign * tip / b
    return tip if f[i] <= 0.0 else 1.0 - tip


@kernel
def areas_at(tree, cells, points, faces, area, start, chunks, threshold, signed, rotation, translation):
    """Area (t,), derivative (t, 6) and count of corners without a side (t,) of the clip at each pose.

    points (n, 3), faces (m, 3), area (m,), start and chunks (see `face_chunks`) are of the surface that is measured,
    about its own centre; rotation (t, 3, 3) and translation (t, 3) bring it into the frame of `tree` and `cells`, about
    the centre there. The derivative is to a shift and a small turn about that centre, both in that frame.
    """
    poses, n = len(rotation), len(points)
    found, slope, doubt = np.zeros(poses), np.zeros((poses, 6)), np.zeros(poses, np.int64)
    boxes, child, leaves, slots = tree.boxes, tree.child, tree.leaves, tree.slots
    fill, normal, row = tree.fill, tree.normal, tree.row
    low, count, coarse, n_fine = cells.low, cells.shape, cells.coarse, cells.n
    state, block, first_coarse, near = cells.state, cells.block, cells.first, cells.near
    sides, places = cells.side, cells.place
    nodes, keys, square, fan = scratch()
    stamp, kind = np.full(n, -1), np.zeros(n, np.int8)
    value, cell, where, unit = np.zeros(n), np.zeros(n, np.int64), np.zeros((n, 3)), np.zeros((n, 3))
    limit2 = threshold * threshold
    f, share = np.empty(3), np.empty(3)
    for pose in range(poses):
        r, t = rotation[pose], translation[pose]
        total = 0.0
        for c in range(len(chunks)):
            x, y, z = _turned(r, t, chunks[c, 0], chunks[c, 1], chunks[c, 2])
            whole = _whole(
                low, count, coarse, n_fine, state, block, first_coarse, near, sides, x, y, z, chunks[c, 3], threshold
            )
            if whole == WITHIN:
                total += chunks[c, 4]
            if whole != OPEN:
                continue
            for face in range(start[c], start[c + 1]):
                within = 0
                for j in range(3):
                    v = faces[face, j]
                    if stamp[v] != pose:
                        stamp[v] = pose
                        x, y, z = _turned(r, t, points[v, 0], points[v, 1], points[v, 2])
                        where[v, 0], where[v, 1], where[v, 2] = x, y, z
                        cell[v], about = cell_at(low, count, coarse, n_fine, state, block, first_coarse, x, y, z)
                        kind[v] = verdict(near, sides, cell[v], about, limit2, x, y, z)
                    if kind[v] == OPEN:
                        doubt[pose] += _measure(
                            boxes, child, leaves, slots, fill, normal, row, places, signed, v, where, cell, kind, value,
                            unit, nodes, keys, square, fan,
                        )  # fmt: skip
                    if kind[v] == WITHIN or (kind[v] == MEASURED and value[v] <= threshold):
                        within += 1
                if within == 3:
                    total += area[face]
                if within == 0 or within == 3:
                    continue
                for j in range(3):
                    v = faces[face, j]
                    if kind[v] != MEASURED:
                        doubt[pose] += _measure(
                            boxes, child, leaves, slots, fill, normal, row, places, signed, v, where, cell, kind, value,
                            unit, nodes, keys, square, fan,
                        )  # fmt: skip
                total += _cut(faces[face], area[face], threshold, value, where, unit, within, f, share, slope[pose])
        found[pose] = total
    return found, slope, doubt


@inner
def _cut(corners, area, threshold, value, where, unit, within, f, share, slope):
    """Area of a triangle that is cut, `within` corners of it inside; its derivative is added to `slope` (6,)."""
    odd = 0
    for j in range(3):
        f[j] = value[corners[j]] - threshold
        if (f[j] <= 0.0) == (within == 1):
            odd = j
    part = area * _slopes(f, odd, share)
    for j in range(3):
        _pull(slope, area * share[j], where[corners[j]], unit[corners[j]])
    return part


@inner
def _pull(slope, by, at, unit):
    """Add `by` times what a distance changes by with a shift (its direction) and a turn (position x direction)."""
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        slope[i] += by * unit[i]
        slope[3 + i] += by * (at[j] * unit[k] - at[k] * unit[j])


@inner
def _measure(
    boxes, child, leaves, slots, fill, normal, row, places, signed, v, where, cell, kind, value, unit, nodes, keys,
    square, fan
):  # fmt: skip
    """Signed distance of one corner and its gradient, put into `value` and `unit`; 1 where it has no side."""
    x, y, z = where[v, 0], where[v, 1], where[v, 2]
    number = cell[v]
    limit2, place = np.inf, -1
    if number >= 0:
        place = places[number]
        qx, qy, qz, _, _ = closest_point(leaves, offset(place), x, y, z)
        limit2 = (x - qx) ** 2 + (y - qy) ** 2 + (z - qz) ** 2
    d2, nearer = nearest(boxes, child, leaves, fill, x, y, z, limit2, nodes, keys, square, fan)
    place = nearer if nearer >= 0 else place
    qx, qy, qz, side = side_of(leaves, slots, normal, row, place, x, y, z)
    distance = np.sqrt(d2)
    lost = 1 if signed and side == 0 and distance > SURE else 0
    if not signed:
        side = 1
    kind[v] = MEASURED
    value[v] = side * distance
    if distance > ON_IT:
        by = side / distance
        unit[v, 0], unit[v, 1], unit[v, 2] = by * (x - qx), by * (y - qy), by * (z - qz)
    else:  # the triangle's own normal, turned to the outside
        o = offset(place)
        by = leaves[o + U(17 * LEAF)] if signed else 1.0
        for i in range(3):
            unit[v, i] = by * leaves[o + U(3 + i) * U(LEAF)]
    return lost


@kernel
def corner_slopes(faces, value, area, count):
    """Derivative (count,) of the area where `value` (n,), linear in each face, is <= 0 to the value of each point."""
    out, f, share = np.zeros(count), np.empty(3), np.empty(3)
    for face in range(len(faces)):
        within = 0
        for j in range(3):
            f[j] = value[faces[face, j]]
            within += f[j] <= 0.0
        if within == 0 or within == 3:
            continue
        odd = 0
        for j in range(3):
            if (f[j] <= 0.0) == (within == 1):
                odd = j
        _slopes(f, odd, share)
        for j in range(3):
            out[faces[face, j]] += area[face] * share[j]
    return out
