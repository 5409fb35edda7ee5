"""The weighted centre: closed forms, invariances, and no answer where there is none."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import RigidTransform

from geocontact.loads.resultant import weighted_centre
from tests.loads.scenes import rigid

seeds = st.integers(0, 2**31)


def draw(seed: int) -> tuple[np.ndarray, np.ndarray]:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 40))
    return rng.normal(size=(count, 3)), rng.uniform(0.0, 5.0, count) + (np.arange(count) == 0)


def test_lever() -> None:
    centre = weighted_centre(np.array([[0.0, 0.0, 0.0], [0.3, 0.0, 0.0]]), np.array([100.0, 200.0]))
    np.testing.assert_allclose(centre, [0.2, 0.0, 0.0], atol=1e-16)


@given(seeds, rigid)
def test_centre_moves_with_the_body(seed: int, pose: RigidTransform) -> None:
    points, weights = draw(seed)
    moved = weighted_centre(pose.apply(points), weights)
    np.testing.assert_allclose(moved, pose.apply(weighted_centre(points, weights)), atol=1e-12)


@given(seeds, st.floats(1e-3, 1e6))
def test_unit_of_the_weights_and_order_do_not_matter(seed: int, unit: float) -> None:
    points, weights = draw(seed)
    order = np.random.default_rng(seed).permutation(len(points))
    again = weighted_centre(points[order], weights[order] * unit)
    np.testing.assert_allclose(again, weighted_centre(points, weights), atol=1e-12)


@given(seeds)
def test_centre_of_centres_is_the_centre(seed: int) -> None:
    points, weights = draw(seed)
    half = max(1, len(points) // 2)
    parts = [(points[:half], weights[:half]), (points[half:], weights[half:])]
    parts = [(x, w) for x, w in parts if w.sum() > 0.0]
    centres = np.array([weighted_centre(x, w) for x, w in parts])
    together = weighted_centre(centres, np.array([w.sum() for _, w in parts]))
    np.testing.assert_allclose(together, weighted_centre(points, weights), atol=1e-12)
    assert (together >= points.min(axis=0) - 1e-12).all() and (together <= points.max(axis=0) + 1e-12).all()


def test_points_without_weight_may_be_unknown() -> None:
    points = np.array([[np.nan, np.nan, np.nan], [1.0, 2.0, 3.0]])
    np.testing.assert_array_equal(weighted_centre(points, np.array([0.0, 2.0])), [1.0, 2.0, 3.0])


def test_no_centre_without_weight() -> None:
    with pytest.raises(ValueError, match="no centre of pressure: the 4 weights sum to 0"):
        weighted_centre(np.zeros((4, 3)), np.zeros(4), "centre of pressure")
    with pytest.raises(ValueError, match="not negative, smallest is -1"):
        weighted_centre(np.zeros((2, 3)), np.array([2.0, -1.0]))
    with pytest.raises(ValueError, match="finite"):
        weighted_centre(np.zeros((2, 3)), np.array([2.0, np.nan]))
