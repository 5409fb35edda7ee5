"""Triangles cut where linear functions change sign: areas, first moments, and the share on one side of a plane."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.compile import kernel, lean


@kernel
def fraction_below(f0, f1, f2):
    """Share of a triangle's area where the linear function with corner values f is <= 0."""
    below = int(f0 <= 0.0) + int(f1 <= 0.0) + int(f2 <= 0.0)  # numpy's truths would add up to one
    if below == 0:
        return 0.0
    if below == 3:
        return 1.0
    if below == 1:
        if f1 <= 0.0:
            f0, f1, f2 = f1, f2, f0
        elif f2 <= 0.0:
            f0, f1, f2 = f2, f0, f1
        return (f0 / (f0 - f1)) * (f0 / (f0 - f2))
    if f1 > 0.0:
        f0, f1, f2 = f1, f2, f0
    elif f2 > 0.0:
        f0, f1, f2 = f2, f0, f1
    return 1.0 - (f0 / (f0 - f1)) * (f0 / (f0 - f2))


@kernel
def areas_below(faces, value, area, thresholds):
    """Area of the parts of all triangles where `value`, linear in each, is <= each of growing thresholds; (s,).

    faces (k, 3) index value (n,); area (k,).
    """
    count = len(thresholds)
    found = np.zeros(count)
    whole = np.zeros(count + 1)  # area of triangles that lie below from this threshold on
    last = thresholds[count - 1]
    for f in range(len(faces)):
        a, b, c = value[faces[f, 0]], value[faces[f, 1]], value[faces[f, 2]]
        low, high = min(a, min(b, c)), max(a, max(b, c))
        if low > last:
            continue
        t = 0
        while t < count and thresholds[t] < low:
            t += 1
        while t < count and thresholds[t] < high:
            found[t] += area[f] * fraction_below(a - thresholds[t], b - thresholds[t], c - thresholds[t])
            t += 1
        whole[t] += area[f]
    below = 0.0
    for t in range(count):
        below += whole[t]
        found[t] += below
    return found


@lean
def _cut(polygon, count, f, out):
    """Part of a convex polygon in barycentric coordinates where b @ f <= 0; returns its corner count."""
    kept = 0
    for i in range(count):
        a = polygon[i]
        b = polygon[(i + 1) % count]
        fa = a[0] * f[0] + a[1] * f[1] + a[2] * f[2]
        fb = b[0] * f[0] + b[1] * f[1] + b[2] * f[2]
        if fa <= 0.0:
            for k in range(3):
                out[kept, k] = a[k]
            kept += 1
        if (fa <= 0.0) != (fb <= 0.0):
            t = fa / (fa - fb)
            for k in range(3):
                out[kept, k] = a[k] + t * (b[k] - a[k])
            kept += 1
    return kept


@lean
def _moments(polygon, count, out):
    """Share of the triangle's area inside the polygon and the barycentric first moments (3,) of that share."""
    share = 0.0
    for k in range(3):
        out[k] = 0.0
    for i in range(1, count - 1):
        a, b, c = polygon[0], polygon[i], polygon[i + 1]
        part = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        share += part
        for k in range(3):
            out[k] += part * (a[k] + b[k] + c[k]) / 3.0
    return share


@kernel
def clipped_parts(faces, points, value, across, area):
    """Area, first moment and area on the negative side of each triangle's part where `value` <= 0.

    faces (k, 3) index points (n, 3), value (n,) and across (n,), all linear in each triangle; across is the signed
    distance to a splitting plane; area (k,). Returns part (k,), moment (k, 3) = integral of position, negative (k,).
    """
    k = len(faces)
    part = np.zeros(k)
    negative = np.zeros(k)
    moment = np.zeros((k, 3))
    whole = np.zeros((3, 3))
    for j in range(3):
        whole[j, j] = 1.0
    first = np.empty((4, 3))
    second = np.empty((5, 3))
    weight = np.empty(3)
    f = np.empty(3)
    g = np.empty(3)
    for i in range(k):
        for j in range(3):
            f[j] = value[faces[i, j]]
            g[j] = across[faces[i, j]]
        count = _cut(whole, len(whole), f, first)
        if count < 3:
            continue
        share = _moments(first, count, weight)
        part[i] = share * area[i]
        for j in range(3):
            for m in range(3):
                moment[i, m] += weight[j] * points[faces[i, j], m] * area[i]
        if g[0] > 0.0 and g[1] > 0.0 and g[2] > 0.0:
            continue
        negative[i] = _moments(second, _cut(first, count, g, second), weight) * area[i]
    return part, moment, negative
