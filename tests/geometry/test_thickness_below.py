"""Thickness along the normal: closed forms, a loop over all faces as second opinion, rays through edges and holes."""

from __future__ import annotations

from functools import cache

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.data.mesh import Mesh
from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import thickness_below
from geocontact.io.mesh.meshes import read_mesh
from tests.cli.calls import MESHES
from tests.geometry.bodies import MM, cube, joined, moved, surface, turned

BODIES = ("torus_r25_r8.stl", "cup_r24.stl", "tibial_insert_right_coarse.stl", "femoral_component_right_coarse.stl")


@cache
def sample(name: str) -> Surface:
    mesh: Mesh = read_mesh(MESHES / name, "mm")
    return Surface.of(mesh)


def middles(body: Surface) -> np.ndarray:
    return body.vertices[body.faces].mean(axis=1)


def by_all_faces(body: Surface, point: np.ndarray, inwards: np.ndarray) -> float:
    """Moeller and Trumbore on every face: the nearest crossing from inside to outside."""
    a, b, c = np.moveaxis(body.vertices[body.faces], 1, 0)
    one, two = b - a, c - a
    across = np.cross(inwards, two)
    det = np.einsum("ij,ij->i", one, across)
    with np.errstate(all="ignore"):
        s = point - a
        u = np.einsum("ij,ij->i", s, across) / det
        q = np.cross(s, one)
        v = q @ inwards / det
        t = np.einsum("ij,ij->i", two, q) / det
        leaving = np.cross(one, two) @ inwards > 0.0
        good = leaving & (u >= 0.0) & (v >= 0.0) & (u + v <= 1.0) & (t >= -1e-12)
    return float(t[good].min(initial=np.inf))


def test_cube_is_as_thick_as_its_side() -> None:
    body = surface(cube((3.0, -2.0, 40.0), (5.0, 7.0, 11.0)))
    found = thickness_below(body, middles(body), body.face_normal)
    side = 2.0 * np.abs(body.face_normal) @ np.array([5.0, 7.0, 11.0]) * MM
    np.testing.assert_allclose(found, side, rtol=1e-12)


@pytest.mark.parametrize("name", BODIES)
def test_every_face_agrees_with_a_loop_over_all_faces(name: str) -> None:
    body = sample(name)
    some = np.random.default_rng(3).choice(len(body.faces), 150, replace=False)
    start, normal = middles(body)[some], body.face_normal[some]
    expected = [by_all_faces(body, p, -n) for p, n in zip(start, normal, strict=True)]
    np.testing.assert_allclose(thickness_below(body, start, normal), expected, rtol=1e-9, atol=1e-12)
    assert np.isfinite(expected).all(), "closed bodies let no ray in that they do not let out"


def test_rays_through_edges_and_corners_are_not_lost() -> None:
    """Down the middle of a block of twelve faces: along the diagonals of two of them, and through corners."""
    diagonal = np.array([[1.0, 1.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 0.0]])
    normal = diagonal / np.linalg.norm(diagonal, axis=1, keepdims=True)
    for shape in (np.eye(3), turned(30, 40, 50).as_matrix()):
        tilted = surface(moved(cube((0.0, 0.0, 0.0), 10.0), Rotation.from_matrix(shape), np.zeros(3)))
        found = thickness_below(tilted, np.zeros((5, 3)), normal @ shape.T)
        np.testing.assert_allclose(found, 10.0 * MM * np.linalg.norm(diagonal, axis=1), rtol=1e-9)


def test_rigid_motion_changes_nothing() -> None:
    body = sample("tibial_insert_right_coarse.stl")
    turn, shift = turned(20, -70, 130), np.array([0.4, -3.0, 1.5])
    there = Surface(turn.apply(body.vertices) + shift, body.faces)
    before = thickness_below(body, middles(body), body.face_normal)
    after = thickness_below(there, middles(there), there.face_normal)
    same = np.isclose(after, before, rtol=1e-9)
    assert same.mean() > 0.999, "a ray that runs along an edge of the rim may take either side"


def test_inside_out_bodies_are_as_thick() -> None:
    body = sample("torus_r25_r8.stl")
    turned_over = Surface(body.vertices, body.faces[:, ::-1])
    np.testing.assert_allclose(
        thickness_below(turned_over, middles(turned_over), turned_over.face_normal),
        thickness_below(body, middles(body), body.face_normal),
        rtol=1e-12,
    )


def test_only_the_first_way_out_counts() -> None:
    """Two plates above each other, and a sheet without an underside."""
    pair = surface(joined(cube((0, 0, 0), (9.0, 1.0, 9.0)), cube((0, -20.0, 0), (9.0, 1.0, 9.0))))
    top = np.array([[0.1, 1.0, 0.2]]) * MM
    up = np.array([[0.0, 1.0, 0.0]])
    np.testing.assert_allclose(thickness_below(pair, top, up), [2.0 * MM], rtol=1e-12)
    assert thickness_below(pair, top, up, limit=1.9 * MM)[0] == np.inf
    vertices, faces = cube((0, 0, 0), (9.0, 1.0, 9.0))
    one, two = (vertices[faces][:, k] - vertices[faces][:, 0] for k in (1, 2))
    lid = surface((vertices, faces[np.cross(one, two)[:, 1] >= 0.0]))
    assert len(lid.faces) == 10 and np.isinf(thickness_below(lid, top, up)).all()


def test_points_that_are_no_numbers_are_refused() -> None:
    body = sample("torus_r25_r8.stl")
    with pytest.raises(ValueError, match="must be finite"):
        thickness_below(body, np.full((1, 3), np.nan), np.array([[0.0, 0.0, 1.0]]))
