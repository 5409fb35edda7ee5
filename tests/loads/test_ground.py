"""Grounds answer the shared query: stairs beside brute force and planes, sheets beside half-spaces."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.geometry.shapes import HalfSpace
from geocontact.geometry.surface import Surface
from geocontact.loads.ground import Sheet, Stairs, ground_of_surface, plane_of

STAIRS = Stairs((0.3, 0.6, 0.8), (0.0, 0.15, 0.35, 0.1))
coordinate = st.floats(-1.0, 2.0)


def boundary(spacing: float = 1e-4) -> np.ndarray:
    """Points along the profile of `STAIRS`, far enough on both sides."""
    ends = np.array([-3.0, *STAIRS.edges, 4.0])
    x, y = [], []
    for k, height in enumerate(STAIRS.heights):
        tread = np.arange(ends[k], ends[k + 1] + spacing / 2, spacing)
        x.append(tread)
        y.append(np.full_like(tread, height))
    for edge, low, high in zip(STAIRS.edges, STAIRS.heights, STAIRS.heights[1:], strict=False):
        riser = np.arange(min(low, high), max(low, high) + spacing / 2, spacing)
        x.append(np.full_like(riser, edge))
        y.append(riser)
    return np.column_stack([np.concatenate(x), np.concatenate(y)])


PROFILE = boundary()


@given(coordinate, st.floats(-0.5, 1.0), coordinate)
def test_stairs_are_as_far_as_the_nearest_of_many_points(x: float, y: float, z: float) -> None:
    near = STAIRS.proximity(np.array([[x, y, z]]))
    nearest = np.hypot(*(PROFILE - [x, y]).T).min()
    inside = y < STAIRS.heights[sum(x >= edge for edge in STAIRS.edges)]
    assert abs(abs(near.distance[0]) - nearest) <= 1e-4
    assert near.distance[0] <= 0.0 if inside else near.distance[0] >= 0.0
    np.testing.assert_allclose(near.closest[0] + near.distance[0] * near.normal[0], [x, y, z], atol=1e-12)
    assert np.linalg.norm(near.normal[0]) == pytest.approx(1.0, abs=1e-9)


def test_stairs_have_normals_on_the_surface_itself() -> None:
    near = STAIRS.proximity(np.array([[0.1, 0.0, 0.0], [0.3, 0.07, 1.0], [0.8, 0.2, 0.0]]))
    np.testing.assert_array_equal(near.distance, 0.0)
    np.testing.assert_array_equal(near.normal, [[0, 1, 0], [-1, 0, 0], [1, 0, 0]])


def test_a_stair_without_edges_is_a_half_space() -> None:
    points = np.random.default_rng(0).normal(size=(200, 3))
    stair, plane = Stairs((), (0.2,)).proximity(points, 1.0), HalfSpace((0.0, 0.2, 0.0)).proximity(points, 1.0)
    np.testing.assert_allclose(stair.distance, plane.distance, atol=1e-15)
    np.testing.assert_allclose(stair.normal, plane.normal, atol=1e-9)


@pytest.mark.parametrize("arguments", [((1.0, 0.0), (0.0, 1.0, 2.0)), ((0.0,), (1.0,)), ((), (0.0,), (1.0, 1.0, 0.0))])
def test_impossible_stairs_are_refused(arguments: tuple) -> None:
    with pytest.raises(ValueError, match=r"stairs|unit vectors"):
        Stairs(*arguments)


def test_sheet_is_a_half_space_over_its_extent() -> None:
    corners = np.array([[-1.0, 0.1, -1.0], [-1.0, 0.1, 1.0], [1.0, 0.1, 1.0], [1.0, 0.1, -1.0]])
    sheet = Sheet(Surface(corners, np.array([[0, 1, 2], [0, 2, 3]])))
    points = np.random.default_rng(1).uniform(-0.5, 0.5, (300, 3))
    near, plane = sheet.proximity(points, 0.3), HalfSpace((0.0, 0.1, 0.0)).proximity(points, 0.3)
    far = ~np.isfinite(plane.distance)
    np.testing.assert_allclose(near.distance[~far], plane.distance[~far], atol=1e-12)
    np.testing.assert_allclose(near.normal[~far], plane.normal[~far], atol=1e-9)
    assert np.isinf(near.distance[far]).all()


def test_a_plane_by_its_equation() -> None:
    """0.6 x + 0.8 y = 0.5 m, its normal of any length: the origin is 0.5 m below, (1, 1, z) 0.9 m above."""
    for length in (1.0, 10.0):
        ground = plane_of((0.6 * length, 0.8 * length, 0.0), 0.5)
        near = ground.proximity(np.array([[0.0, 0.0, 0.0], [1.0, 1.0, 7.0]]))
        np.testing.assert_allclose(near.distance, [-0.5, 0.9], atol=1e-15)
        np.testing.assert_allclose(near.normal, [[0.6, 0.8, 0.0]] * 2, atol=1e-15)
    for normal in ((0.0, 0.0, 0.0), (np.inf, 0.0, 0.0), (np.nan, 1.0, 0.0)):
        with pytest.raises(ValueError, match="no length"):
            plane_of(normal, 0.0)


def test_a_closed_surface_is_a_body_and_an_open_one_a_sheet() -> None:
    """Of a tetrahedron's faces without that below, the slanted one weighs as the three axes together."""
    corners = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    faces = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
    body = Surface(corners, faces)
    assert ground_of_surface(body) is body
    sheet = ground_of_surface(Surface(corners, faces[:3]))
    assert isinstance(sheet, Sheet)
    np.testing.assert_allclose(sheet.up, [0.0, 0.0, 1.0], atol=1e-15)  # (1, 1, 1)/2 - (1, 0, 0)/2 - (0, 1, 0)/2
    roof = ground_of_surface(Surface(corners, faces[:1]))
    assert isinstance(roof, Sheet)
    np.testing.assert_allclose(roof.up, np.full(3, 3.0**-0.5), atol=1e-15)
