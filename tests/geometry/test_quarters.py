"""Triangles divided into quarters by the kernel, beside the same written in numpy."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.geometry.kernels.quarter import divided
from meshes.simple_shapes import sphere


def by_numpy(faces, points, distance, slot, across, beyond):
    """Quarters, and of each middle its ends' mean, limit and mean of `across`, by sorting edges."""
    ends = np.sort(faces[:, [[1, 2], [2, 0], [0, 1]]], axis=2).reshape(-1, 2)
    unique, which = np.unique(ends, axis=0, return_inverse=True)
    which = which.reshape(-1, 3)
    length = np.linalg.norm(points[unique[:, 0]] - points[unique[:, 1]], axis=1)
    longest = np.zeros(len(unique))
    np.maximum.at(longest, which, length[which].max(axis=1)[:, None])
    known = np.where(slot >= 0, distance, np.inf)[unique].min(axis=1) + 0.5 * length
    corners = np.concatenate([faces, len(points) + which], axis=1)
    quarters = corners[:, [[0, 5, 4], [5, 1, 3], [4, 3, 2], [3, 4, 5]]].reshape(-1, 3)
    limit = np.minimum(beyond + longest, known * (1.0 + 1e-9) + 1e-12)
    return quarters, points[unique].mean(axis=1), limit, across[unique].mean(axis=1)


@pytest.mark.parametrize("beyond", [4e-3, np.inf])
@pytest.mark.parametrize("count", [0, 1, 7, 400])
def test_quarters_are_those_of_numpy(count, beyond):
    """Any choice of faces; the order of new points is free, the order of quarters and their corners is not."""
    rng = np.random.default_rng(count)
    vertices, faces = sphere(20.0, 8)
    points, faces = 1e-3 * vertices, faces[rng.permutation(len(faces))[:count]]
    n = len(points)
    distance, across, slot = rng.random(n) * 1e-2, rng.normal(size=n), rng.integers(-1, 3, n)
    found = divided(faces, points, distance, slot, across, beyond)
    wanted = by_numpy(faces, points, distance, slot, across, beyond)
    assert [len(each) for each in found] == [len(each) for each in wanted]
    if count == 0:
        return
    order = np.empty(len(wanted[1]), np.int64)  # where the kernel has what numpy has at each place
    new = wanted[0] >= n
    assert np.array_equal(found[0] >= n, new)
    order[wanted[0][new] - n] = found[0][new] - n
    assert np.array_equal(np.sort(order), np.arange(len(order)))
    again = wanted[0].copy()
    again[new] = n + order[wanted[0][new] - n]
    assert np.array_equal(found[0], again)
    for ours, theirs in zip(found[1:], wanted[1:], strict=True):
        np.testing.assert_allclose(ours[order], theirs, rtol=1e-14, atol=0.0)
