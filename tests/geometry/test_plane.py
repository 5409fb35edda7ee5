"""The splitting plane."""

import numpy as np
import pytest

from geocontact.geometry.plane import Plane


def test_height_is_the_distance_along_the_normal():
    points = np.random.default_rng(0).normal(size=(50, 3))
    assert Plane((0.6, 0.0, 0.8), 0.3).height(points) == pytest.approx(0.6 * points[:, 0] + 0.8 * points[:, 2] - 0.3)


@pytest.mark.parametrize(("axis", "column"), [("x", 0), ("y", 1), ("z", 2)])
def test_across_an_axis(axis, column):
    points = np.random.default_rng(1).normal(size=(50, 3))
    assert Plane.across(axis, 0.25).height(points) == pytest.approx(points[:, column] - 0.25, abs=1e-15)


def test_other_axes_are_refused():
    with pytest.raises(ValueError, match="axis must be x, y or z, not 'w'"):
        Plane.across("w")
