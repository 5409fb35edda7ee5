"""Points of a Latin hypercube: one in each slice, and those that scipy draws."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import qmc

from geocontact.identify.optimise.quasi_newton import latin_hypercube


@pytest.mark.parametrize(("dimensions", "count", "seed"), [(1, 5, 0), (3, 12, 7), (2, 0, 1)])
def test_points_are_those_of_scipy(dimensions: int, count: int, seed: int) -> None:
    found = latin_hypercube(dimensions, count, seed)
    np.testing.assert_array_equal(found, qmc.LatinHypercube(dimensions, rng=seed).random(count))
    for column in found.T:
        assert sorted(np.floor(column * count)) == list(range(count))
