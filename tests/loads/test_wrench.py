"""Wrenches: a load stays itself about any point and in any frame, and force-plate formulas hold."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from jaxtyping import TypeCheckError
from scipy.spatial.transform import RigidTransform

from geocontact.data.wrench import Wrench
from geocontact.loads.resultant import resultant, weighted_centre
from tests.loads.scenes import rigid, vectors

seeds = st.integers(0, 2**31)
UP = np.array([0.0, 0.0, 1.0])


def sample(seed: int, count: int = 5) -> Wrench:
    """Loads of a plate with z up: mostly upwards."""
    rng = np.random.default_rng(seed)
    force = rng.normal(size=(count, 3)) * [100.0, 100.0, 50.0] + [0.0, 0.0, 600.0]
    return Wrench(force, rng.normal(size=(count, 3)) * 50.0, rng.normal(size=(count, 3)) * 0.2, "plate")


@given(seeds, vectors, vectors)
def test_any_origin_gives_the_same_centre_and_free_moment(seed: int, there: np.ndarray, surface: np.ndarray) -> None:
    wrench = sample(seed)
    moved = wrench.moved_to(there)
    centre = wrench.centre_of_pressure(surface, UP)
    np.testing.assert_allclose(moved.centre_of_pressure(surface, UP), centre, atol=1e-12)
    np.testing.assert_allclose(moved.free_moment(centre, UP), wrench.free_moment(centre, UP), atol=1e-9)
    np.testing.assert_allclose(moved.moved_to(wrench.origin).moment, wrench.moment, atol=1e-11)


@given(seeds, st.floats(-0.1, 0.1))
def test_centre_is_that_of_the_type_2_formulas(seed: int, height: float) -> None:
    wrench = sample(seed)
    wrench = Wrench(wrench.force, wrench.moment, np.zeros((5, 3)), "plate")
    (fx, fy, fz), (mx, my, mz) = wrench.force.T, wrench.moment.T
    x, y = (height * fx - my) / fz, (mx + height * fy) / fz
    centre = wrench.centre_of_pressure(np.array([0.0, 0.0, height]), UP)
    np.testing.assert_allclose(centre, np.column_stack([x, y, np.full(5, height)]), atol=1e-12)
    np.testing.assert_allclose(wrench.free_moment(centre, UP), mz - (x * fy - y * fx), atol=1e-10)


@given(seeds, vectors)
def test_moment_about_the_centre_is_along_the_normal(seed: int, surface: np.ndarray) -> None:
    wrench = sample(seed)
    centre = wrench.centre_of_pressure(surface, UP)
    np.testing.assert_allclose((centre - surface) @ UP, 0.0, atol=1e-12)
    np.testing.assert_allclose(wrench.moved_to(centre).moment[:, :2], 0.0, atol=1e-9)


@given(seeds, vectors, rigid)
def test_centre_moves_with_the_frame(seed: int, surface: np.ndarray, pose: RigidTransform) -> None:
    wrench = sample(seed)
    turned = wrench.seen_from(pose, "laboratory")
    assert turned.frame == "laboratory"
    centre, up = wrench.centre_of_pressure(surface, UP), pose.rotation.apply(UP)
    np.testing.assert_allclose(turned.centre_of_pressure(pose.apply(surface), up), pose.apply(centre), atol=1e-11)
    np.testing.assert_allclose(
        turned.free_moment(pose.apply(centre), up), wrench.free_moment(centre, UP), rtol=1e-9, atol=1e-9
    )


@given(seeds)
def test_resultant_of_parallel_forces_acts_at_their_weighted_centre(seed: int) -> None:
    rng = np.random.default_rng(seed)
    size = rng.uniform(1.0, 100.0, 7)
    points = np.column_stack([rng.normal(size=(7, 2)), np.zeros(7)])
    wrench = resultant(size[:, None] * UP, points, "plate", rng.normal(size=3))
    centre = wrench.centre_of_pressure(np.zeros(3), UP)
    np.testing.assert_allclose(centre, weighted_centre(points, size), atol=1e-12)
    assert abs(float(wrench.free_moment(centre, UP))) < 1e-10


def test_no_centre_below_the_gate() -> None:
    wrench = Wrench(np.array([[0, 0, 19.0], [0, 0, 21.0], [5, 0, 0], [0, 0, np.nan]]), *np.zeros((2, 4, 3)), "plate")
    assert (
        np.isfinite(wrench.centre_of_pressure(np.zeros(3), UP, 20.0)).all(axis=1).tolist()
        == [False, True] + [False] * 2
    )
    assert np.isfinite(wrench.centre_of_pressure(np.zeros(3), UP)).all(axis=1).tolist() == [True, True, False, False]


@pytest.mark.shapes
def test_shapes_are_checked() -> None:
    with pytest.raises(TypeCheckError):
        Wrench(np.zeros((2, 3)), np.zeros((3, 3)), np.zeros((2, 3)), "plate")
