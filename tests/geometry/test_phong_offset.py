"""Heights of smooth surfaces above their triangles: spheres, tubes, hollows, flat parts and their edges."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.geometry.curvature import corner_normals, phong_offset
from geocontact.geometry.surface import Surface
from meshes.simple_shapes import sphere
from tests.geometry.bodies import MM, cube, surface, turned

R = 20e-3


def places(body: Surface, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """A random point on each face."""
    share = np.random.default_rng(seed).dirichlet(np.ones(3), len(body.faces))
    return np.arange(len(body.faces)), np.einsum("nk,nki->ni", share, body.vertices[body.faces])


def heights(body: Surface) -> np.ndarray:
    return phong_offset(body, corner_normals(body), *places(body))


def ball(n: int) -> Surface:
    return surface(sphere(R / MM, n))


def test_height_above_a_sphere_is_second_order_and_its_error_fourth() -> None:
    error = []
    for n in (6, 12, 24):
        body = ball(n)
        _, points = places(body)
        expected = R - np.linalg.norm(points, axis=1)
        assert expected.max() > 0.1e-3 * (6 / n) ** 2
        error.append(np.abs(heights(body) - expected).max())
    order = np.polyfit(np.log([1 / 6, 1 / 12, 1 / 24]), np.log(error), 1)[0]
    assert order == pytest.approx(4.0, abs=0.3), error


def test_normals_at_corners_of_a_sphere_are_exact() -> None:
    body = ball(5)
    np.testing.assert_allclose(corner_normals(body), body.vertices[body.faces] / R, atol=1e-9)


def test_a_hollow_lies_below_its_triangles_and_turned_faces_do_not_matter() -> None:
    body = ball(6)
    turned_over = Surface(body.vertices, body.faces[:, ::-1])
    assert turned_over.inside_out
    _, points = places(body)
    again = phong_offset(turned_over, corner_normals(turned_over), np.arange(len(body.faces)), points)
    np.testing.assert_allclose(again, heights(body), atol=1e-12)
    open_hollow = Surface(body.vertices, body.faces[1:, ::-1])
    assert not open_hollow.closed
    assert (heights(open_hollow) < 0.0).mean() > 0.95


def test_a_block_keeps_its_edges() -> None:
    body = surface(cube((0.0, 0.0, 0.0), (5.0, 3.0, 2.0)))
    np.testing.assert_allclose(heights(body), 0.0, atol=1e-15)
    np.testing.assert_allclose(corner_normals(body), np.repeat(body.face_normal[:, None, :], 3, axis=1), atol=1e-12)


def test_a_common_motion_changes_nothing() -> None:
    body, turn, shift = ball(6), turned(20, 50, -70), np.array([0.4, -0.1, 2.0])
    there = Surface(turn.apply(body.vertices) + shift, body.faces)
    face, points = places(body)
    moved = phong_offset(there, corner_normals(there), face, turn.apply(points) + shift)
    np.testing.assert_allclose(moved, heights(body), atol=1e-12)
