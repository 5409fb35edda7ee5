"""How much of a triangle lies within a threshold of the other body: certified bounds and the linear estimate.

Given are the distances d_j of the three corners v_j to the other surface, their closest points p_j there and the sides
s_j. Two facts about the distance d to any set hold exactly, whatever the set looks like:

* d(x) <= |x - p_j|, and the right side is convex, hence not above its linear interpolation between the corners: the
  part where that interpolation is <= T is certainly within the threshold (lower bound of the area);
* d(x)^2 - |x|^2 is concave (a minimum of functions that are linear in x), so d(x)^2 is not below the linear
  interpolation of d_j^2 minus q, with q at most the squared radius of the smallest circle around the triangle: the part
  where this exceeds T^2 is certainly farther than T, and being free of the other surface it has one side throughout.

Both bounds close with the square of the edge length. Where triangles are large against T the 1-Lipschitz property
decides: sd(x) <= sd_j + |x - v_j|, sd(x) >= sd_j - |x - v_j|.
"""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.clip import fraction_below
from geocontact.geometry.kernels.compile import kernel

ROUND = 1e-12  # relative allowance for rounding in the certificates


@kernel
def certify(faces, points, distance, side, slot, closest, threshold, signed):  # type: ignore[no-untyped-def]
    """Lower and upper bound of the part of each triangle within the threshold, as fractions of its area.

    faces (k, 3) index the point arrays, which are as `signed_distances` gives them: a point beyond its limit has
    slot -1 and is at least as far as the distance given. Returns arrays (k,), (k,).
    """
    lower = np.zeros(len(faces))
    upper = np.zeros(len(faces))
    near = (slot >= 0) | (side <= 0)
    v = np.empty((3, 3))
    p = np.empty((3, 3))
    d = np.empty(3)
    s = np.empty(3, np.int8)
    t = np.empty(3, np.int64)
    for f in range(len(faces)):
        if not (near[faces[f, 0]] or near[faces[f, 1]] or near[faces[f, 2]]):
            continue  # all corners farther than the threshold by more than the longest edge
        for c in range(3):
            i = faces[f, c]
            d[c] = distance[i]
            s[c] = side[i]
            t[c] = slot[i]
            for x in range(3):
                v[c, x] = points[i, x]
                p[c, x] = closest[i, x]
        lower[f], upper[f] = _bounds(v, p, d, s, t, threshold, signed)
    return lower, upper


@kernel
def _length(a, b):  # type: ignore[no-untyped-def]
    return np.sqrt((a[0] - b[0]) ** 2 + (a[1] - b[1]) ** 2 + (a[2] - b[2]) ** 2)


@kernel
def _bounds(v, p, d, s, slot, threshold, signed):  # type: ignore[no-untyped-def]
    e0 = _length(v[1], v[2])
    e1 = _length(v[2], v[0])
    e2 = _length(v[0], v[1])
    slack = ROUND * (e0 + e1 + e2 + threshold)
    reach0, reach1, reach2 = max(e1, e2), max(e2, e0), max(e0, e1)
    # 1-Lipschitz: whole triangle decided by one corner
    if (
        _within(s[0], d[0], slot[0], reach0, threshold - slack, signed)
        or _within(s[1], d[1], slot[1], reach1, threshold - slack, signed)
        or _within(s[2], d[2], slot[2], reach2, threshold - slack, signed)
    ):
        return 1.0, 1.0
    outside = threshold + slack
    if (
        (s[0] > 0 and d[0] - reach0 > outside)
        or (s[1] > 0 and d[1] - reach1 > outside)
        or (s[2] > 0 and d[2] - reach2 > outside)
    ):
        return 0.0, 0.0
    lower = _surely_within(v, p, slot, threshold - slack)
    if lower >= 1.0:
        return 1.0, 1.0
    # the part certainly farther than T: linear interpolation of d^2 above T^2 + q
    need = (outside * outside + _circle2(e0, e1, e2)) * (1.0 + ROUND)
    f0, f1, f2 = need - d[0] * d[0], need - d[1] * d[1], need - d[2] * d[2]
    beyond = fraction_below(f0, f1, f2)
    if beyond > 0.0:
        inside = signed and ((f0 < 0.0 and s[0] < 0) or (f1 < 0.0 and s[1] < 0) or (f2 < 0.0 and s[2] < 0))
        outer = not signed or (f0 < 0.0 and s[0] > 0) or (f1 < 0.0 and s[1] > 0) or (f2 < 0.0 and s[2] > 0)
        if inside and not outer:
            return min(lower + beyond, 1.0), 1.0
        if outer and not inside:
            return lower, max(1.0 - beyond, lower)
    return lower, 1.0


@kernel
def _within(side, d, slot, reach, threshold, signed):  # type: ignore[no-untyped-def]
    if signed and side < 0:
        return reach - d <= threshold  # d is not above the true depth
    return slot >= 0 and d + reach <= threshold


@kernel
def _surely_within(v, p, slot, threshold):  # type: ignore[no-untyped-def]
    best = 0.0
    for j in range(3):
        if slot[j] < 0:
            continue
        part = fraction_below(
            _length(v[0], p[j]) - threshold, _length(v[1], p[j]) - threshold, _length(v[2], p[j]) - threshold
        )
        best = max(best, part)
    return best


@kernel
def _circle2(a, b, c):  # type: ignore[no-untyped-def]
    """Squared radius of the smallest circle that contains a triangle of these edge lengths."""
    a2, b2, c2 = a * a, b * b, c * c
    longest2 = max(a2, b2, c2)
    if a2 + b2 + c2 <= 2.0 * longest2 * (1.0 + 1e-9):
        return 0.25 * longest2
    sixteen_area2 = 2.0 * (a2 * b2 + b2 * c2 + c2 * a2) - (a2 * a2 + b2 * b2 + c2 * c2)
    return a2 * b2 * c2 / sixteen_area2
