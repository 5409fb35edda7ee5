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
from geocontact.geometry.kernels.compile import kernel, lean

ROUND = 1e-12  # relative allowance for rounding in the certificates


@kernel
def certify(faces, points, distance, side, slot, closest, edges, threshold, signed):
    """Lower and upper bound of the part of each triangle within the threshold, as fractions of its area.

    faces (k, 3) index the point arrays, which are as `signed_distances` gives them: a point beyond its limit has
    slot -1 and is at least as far as the distance given. edges (k, 3) are the lengths opposite to each corner.
    Returns arrays (k,), (k,).
    """
    lower = np.zeros(len(faces))
    upper = np.zeros(len(faces))
    v = np.empty((3, 3))
    p = np.empty((3, 3))
    d = np.empty(3)
    s = np.empty(3, np.int8)
    found = np.empty(3, np.bool_)
    for f in range(len(faces)):
        i, j, k = faces[f, 0], faces[f, 1], faces[f, 2]
        if min(side[i], min(side[j], side[k])) > 0 and max(slot[i], max(slot[j], slot[k])) < 0:
            continue  # all corners farther than the threshold by more than the longest edge
        e0, e1, e2 = edges[f, 0], edges[f, 1], edges[f, 2]
        verdict = _by_one_corner(i, max(e1, e2), distance, side, slot, threshold, signed)
        if verdict == 0:
            verdict = _by_one_corner(j, max(e2, e0), distance, side, slot, threshold, signed)
        if verdict == 0:
            verdict = _by_one_corner(k, max(e0, e1), distance, side, slot, threshold, signed)
        if verdict != 0:
            lower[f] = upper[f] = 1.0 if verdict > 0 else 0.0
            continue
        for c in range(3):
            corner = faces[f, c]
            for x in range(3):
                v[c, x] = points[corner, x]
                p[c, x] = closest[corner, x]
            d[c] = distance[corner]
            s[c] = side[corner]
            found[c] = slot[corner] >= 0
        lower[f], upper[f] = _second_order(v, p, d, s, found, e0, e1, e2, threshold, signed)
    return lower, upper


@kernel
def totals(lower, upper, area, moment, negative):
    """Sums over the triangles that lie wholly within (area, moment, negative) and the numbers of the undecided ones."""
    sums = np.zeros(5)
    undecided = np.empty(len(lower), np.int64)
    count = 0
    for f in range(len(lower)):
        if lower[f] >= 1.0:
            sums[0] += area[f]
            for k in range(3):
                sums[1 + k] += moment[f, k]
            sums[4] += negative[f]
        elif upper[f] > 0.0:
            undecided[count] = f
            count += 1
    return sums, undecided[:count].copy()


@lean
def _by_one_corner(i, reach, distance, side, slot, threshold, signed):
    """1 when the triangle lies within the threshold for certain, -1 when outside, 0 when one corner cannot tell.

    1-Lipschitz property; a distance given for a point beyond its limit is not above the true one.
    """
    d = distance[i]
    slack = ROUND * (reach + threshold + d)
    if signed and side[i] < 0:
        return 1 if reach - d <= threshold - slack else 0
    if slot[i] >= 0 and d + reach <= threshold - slack:
        return 1
    if side[i] > 0 and d - reach > threshold + slack:
        return -1
    return 0


@lean
def _second_order(v, p, d, s, found, e0, e1, e2, threshold, signed):
    slack = ROUND * (e0 + e1 + e2 + threshold)
    outside = threshold + slack
    # the part certainly farther than T: linear interpolation of d^2 above T^2 + q
    need = (outside * outside + _circle2(e0, e1, e2)) * (1.0 + ROUND)
    f0, f1, f2 = need - d[0] * d[0], need - d[1] * d[1], need - d[2] * d[2]
    if max(f0, max(f1, f2)) < 0.0 and (not signed or min(s[0], min(s[1], s[2])) > 0):
        return 0.0, 0.0
    lower = _surely_within(v, p, found, threshold - slack)
    if lower >= 1.0:
        return 1.0, 1.0
    beyond = fraction_below(f0, f1, f2)
    if beyond > 0.0:
        inside = signed and ((f0 < 0.0 and s[0] < 0) or (f1 < 0.0 and s[1] < 0) or (f2 < 0.0 and s[2] < 0))
        outer = not signed or (f0 < 0.0 and s[0] > 0) or (f1 < 0.0 and s[1] > 0) or (f2 < 0.0 and s[2] > 0)
        if inside and not outer:
            return min(lower + beyond, 1.0), 1.0
        if outer and not inside:
            return lower, max(1.0 - beyond, lower)
    return lower, 1.0


@lean
def _surely_within(v, p, found, threshold):
    best = 0.0
    most2 = threshold * threshold if threshold > 0.0 else 0.0
    for j in range(3):
        if not found[j]:
            continue
        a2, b2, c2 = _apart2(v, 0, p, j), _apart2(v, 1, p, j), _apart2(v, 2, p, j)
        if max(a2, max(b2, c2)) <= most2:
            return 1.0
        if min(a2, min(b2, c2)) <= most2:
            share = fraction_below(np.sqrt(a2) - threshold, np.sqrt(b2) - threshold, np.sqrt(c2) - threshold)
            best = max(best, share)
    return best


@lean
def _apart2(v, i, p, j):
    """Squared distance of row i of v to row j of p."""
    x, y, z = v[i, 0] - p[j, 0], v[i, 1] - p[j, 1], v[i, 2] - p[j, 2]
    return x * x + y * y + z * z


@lean
def _circle2(a, b, c):
    """Squared radius of the smallest circle that contains a triangle of these edge lengths."""
    a2, b2, c2 = a * a, b * b, c * c
    longest2 = max(a2, b2, c2)
    if a2 + b2 + c2 <= 2.0 * longest2 * (1.0 + 1e-9):
        return 0.25 * longest2
    sixteen_area2 = 2.0 * (a2 * b2 + b2 * c2 + c2 * a2) - (a2 * a2 + b2 * b2 + c2 * c2)
    return a2 * b2 * c2 / sixteen_area2
