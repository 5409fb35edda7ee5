"""Triangles divided into their four quarters, each middle of an edge once."""

from __future__ import annotations

import numpy as np

from geocontact.geometry.kernels.compile import inner, kernel, lean

SLACK = 1e-9  # relative allowance for rounding in a limit that neighbours set
ROUNDING = 1e-12  # m; no distance is missed because of rounding
SPREAD = 0x9E3779B97F4A7C15  # 2^64 over the golden ratio: neighbouring keys fall far apart


@kernel
def divided(faces, points, distance, slot, across, beyond):
    """Quarters of all faces, and the middles of their edges, numbered behind the points as they are met.

    faces (k, 3) index points (n, 3), distance (n,), slot (n,), -1 where the distance is a lower bound, across (n,).
    Returns quarters (4 k, 3), four for each face in its order: those at its corners, then the one between; and of each
    middle its place (m, 3), how far it has to be measured (m,), the longest edge of its faces plus `beyond` or as far
    as a neighbour allows since distance is 1-Lipschitz, and the mean (m,) of `across`.
    """
    n = len(points)
    most = 3 * len(faces)
    ends = np.empty((most, 2), np.int64)
    longest = np.zeros(most)
    table = np.full(_size(most), -1)
    quarters = np.empty((4 * len(faces), 3), np.int64)
    middle = np.empty(3, np.int64)
    count = 0
    for f in range(len(faces)):
        edge = 0.0
        for c in range(3):
            i, j = faces[f, (c + 1) % 3], faces[f, (c + 2) % 3]
            middle[c] = _numbered(min(i, j), max(i, j), n, ends, table, count)
            count = max(count, middle[c] + 1)
            edge = max(edge, _apart(points, i, j))
        for c in range(3):
            longest[middle[c]] = max(longest[middle[c]], edge)
            # corner c first, as in the face, between the middles of the edges beside it
            for k in range(3):
                quarters[4 * f + c, k] = faces[f, c] if k == c else n + middle[3 - c - k]
            quarters[4 * f + 3, c] = n + middle[c]
    placed, limit, mean = np.empty((count, 3)), np.empty(count), np.empty(count)
    for m in range(count):
        i, j = ends[m, 0], ends[m, 1]
        for k in range(3):
            placed[m, k] = 0.5 * (points[i, k] + points[j, k])
        mean[m] = 0.5 * (across[i] + across[j])
        nearby = min(distance[i] if slot[i] >= 0 else np.inf, distance[j] if slot[j] >= 0 else np.inf)
        nearby += 0.5 * _apart(points, i, j)
        limit[m] = min(beyond + longest[m], nearby * (1.0 + SLACK) + ROUNDING)
    return quarters, placed, limit, mean


@lean
def _apart(points, i, j):
    x, y, z = points[i, 0] - points[j, 0], points[i, 1] - points[j, 1], points[i, 2] - points[j, 2]
    return np.sqrt(x * x + y * y + z * z)


@inner
def _size(most):
    """A power of two of which `most` entries fill no more than half."""
    size = most - most + 16
    while size < 2 * most:
        size *= 2
    return size


@lean
def _numbered(i, j, n, ends, table, count):
    """Number of the edge from i to j, `count` where it is new: it is entered then."""
    size = len(table)
    at = np.int64(((np.uint64(i) * np.uint64(n) + np.uint64(j)) * np.uint64(SPREAD)) >> np.uint64(32)) & (size - 1)
    while table[at] >= 0:
        m = table[at]
        if ends[m, 0] == i and ends[m, 1] == j:
            return m
        at = (at + 1) & (size - 1)
    table[at] = count
    ends[count, 0] = i
    ends[count, 1] = j
    return count
