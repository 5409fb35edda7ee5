"""The part of a surface that a shape is fitted to: its points, its sides, and which way it looks."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.geometry.fit.catalogue import SHAPES
from geocontact.geometry.fit.patch import Fitting, Patch
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface
from meshes.simple_shapes import cup, sphere
from tests.geometry.bodies import surface

BALL = surface(sphere(20.0, 8), "ball")
UPPER = BALL.vertices[BALL.faces].mean(axis=1)[:, 1] > 0.0


@pytest.mark.parametrize("at_vertices", [True, False])
def test_points_are_those_of_the_faces_that_count(at_vertices: bool) -> None:
    patch = Patch(BALL, UPPER, at_vertices, None, 0)
    used = np.unique(BALL.faces[UPPER])
    assert np.flatnonzero(patch.vertices).tolist() == used.tolist()
    expected = BALL.vertices[used] if at_vertices else BALL.vertices[BALL.faces[UPPER]].mean(axis=1)
    np.testing.assert_array_equal(patch.points, expected)
    assert patch.sides == {}


def test_sides_are_those_of_the_plane() -> None:
    plane = Plane.across("z")
    assert Patch(BALL, UPPER, True, plane, -1).sides == {"medial": (plane, -1), "lateral": (plane, 1)}


def fitted(body: Surface, faces: np.ndarray, shape: str = "sphere") -> Fitting:
    patch = Patch(body, faces, True, None, 0)
    return Fitting(patch, SHAPES[shape](np.ascontiguousarray(patch.points), False), {}, {})


def test_residuals_are_radial_and_none_off_the_patch() -> None:
    found = fitted(BALL, UPPER)
    inside = found.patch.vertices
    radial = np.linalg.norm(BALL.vertices - found.whole.point, axis=1) - found.whole.radius
    np.testing.assert_allclose(found.residual[inside], radial[inside], atol=1e-12)
    assert np.isnan(found.residual[~inside]).all()


def test_a_ball_is_convex_its_socket_concave_and_a_plane_neither() -> None:
    assert fitted(BALL, UPPER).facing == "convex"
    socket = surface(cup(24.0, 5.0, 16), "socket")
    hollow = np.linalg.norm(socket.vertices[socket.faces].mean(axis=1), axis=1) < 24.5e-3
    assert fitted(socket, hollow).facing == "concave"
    assert fitted(BALL, UPPER, "plane").facing is None
