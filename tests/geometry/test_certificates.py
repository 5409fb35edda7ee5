"""Certified shares of triangles by the same rules written out plainly, for corners near and far, inside and outside."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.geometry.kernels.certify import certify
from geocontact.geometry.kernels.clip import fraction_below

T = 4.0


def drawn(seed, inside, count=4000):
    """Triangles over a bumpy set of points, about as far as the threshold: corners, distances and nearest points."""
    rng = np.random.default_rng(seed)
    there = np.column_stack([rng.uniform(-9.0, 9.0, (400, 2)), rng.normal(0.0, 0.4, 400)])
    first = np.column_stack([rng.uniform(-5.0, 5.0, (count, 2)), rng.uniform(1.5, 5.5, count)])
    size = 10.0 ** rng.uniform(-2.0, 0.3, (count, 1, 1))
    corners = (first[:, None] + size * rng.normal(size=(count, 3, 3))).reshape(-1, 3)
    apart = np.linalg.norm(corners[:, None] - there, axis=2)
    return corners, apart.min(axis=1), there[apart.argmin(axis=1)], -1 if inside else 1


def circle2(a, b, c):
    """Squared radius of the smallest circle about a triangle of these edges, by the angles."""
    x, y, z = sorted((a, b, c))
    if x * x + y * y <= z * z:
        return 0.25 * z * z
    cosine = (x * x + y * y - z * z) / (2.0 * x * y)
    return z * z / (4.0 * (1.0 - cosine * cosine))


def by_rule(v, d, p, side, signed):
    """Lower and upper share: within by the best nearest point, beyond by the concave square, either by one corner."""
    edges = [np.linalg.norm(v[(c + 1) % 3] - v[(c + 2) % 3]) for c in range(3)]
    for c in range(3):
        reach = max(edges[(c + 1) % 3], edges[(c + 2) % 3])
        if (d[c] + reach <= T and not (signed and side < 0)) or (signed and side < 0 and reach - d[c] <= T):
            return 1.0, 1.0
        if side > 0 and d[c] - reach > T:
            return 0.0, 0.0
    low = max(fraction_below(*(np.linalg.norm(v - p[j], axis=1) - T).tolist()) for j in range(3))
    clear = fraction_below(*(T * T + circle2(*edges) - d * d).tolist())
    if signed and side < 0:
        return min(low + clear, 1.0), 1.0
    return low, max(1.0 - clear, low)


@pytest.mark.parametrize(("signed", "inside"), [(True, False), (True, True), (False, False)])
def test_shares_are_those_of_the_rules(signed, inside):
    corners, distance, closest, side = drawn(1, inside)
    faces = np.arange(len(corners)).reshape(-1, 3)
    v = corners[faces]
    edges = np.stack([np.linalg.norm(v[:, (c + 1) % 3] - v[:, (c + 2) % 3], axis=1) for c in range(3)], axis=1)
    sides = np.full(len(corners), side, np.int8)
    slot = np.zeros(len(corners), np.int64)
    lower, upper = certify(faces, corners, distance, sides, slot, closest, edges, T, signed)
    expected = np.array([by_rule(corners[f], distance[f], closest[f], side, signed) for f in faces])
    np.testing.assert_allclose(np.stack([lower, upper], axis=1), expected, atol=1e-6)
    if not inside:
        kinds = ((upper <= 0.0).sum(), (lower >= 1.0).sum(), ((lower > 0.0) & (lower < 1.0)).sum())
        assert min(kinds) > 200, kinds
        assert ((upper > 0.0) & (upper < 1.0)).sum() > 200
