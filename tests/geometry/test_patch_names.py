"""What a region may speak of beside places and normals: about an axis, about a centre, flexion, another body."""

import numpy as np
import pytest

from geocontact.geometry.regions import about, about_flexion, about_other, faces_where
from geocontact.geometry.sagittal import Sagittal
from geocontact.geometry.sweep import Axis
from meshes.simple_shapes import cup, cylinder, sphere
from tests.geometry.bodies import MM, surface

ROD, CUP, BALL = surface(cylinder(15.0, 40.0, 8), "rod"), surface(cup(24.0, 5.0, 12), "cup"), surface(sphere(20.0, 8))
Y = Axis((0.0, 0.0, 0.0), (0.0, 1.0, 0.0))


def centroids(body):
    return body.vertices[body.faces].mean(axis=1) / MM


def axis_of(body):
    """The coordinate axis along which the rod lies."""
    return Axis((0.0, 0.0, 0.0), tuple(np.eye(3)[int(np.argmax(np.ptp(body.vertices, axis=0)))]))


def test_wall_and_ends_of_a_rod():
    axis = axis_of(ROD)
    names = about(ROD, axis.point, axis.direction, MM)
    wall = faces_where(ROD, "outward > 0.9", MM, names)
    along = np.abs(ROD.face_normal @ axis.direction)
    np.testing.assert_array_equal(wall, along < 0.5)
    assert 0 < wall.sum() < len(wall)
    far = faces_where(ROD, "radial > 10", MM, names)
    off = np.linalg.norm(np.cross(centroids(ROD), axis.direction), axis=1)
    np.testing.assert_array_equal(far, off > 10.0)


def test_inside_and_outside_of_a_cup():
    names = about(CUP, (0.0, 0.0, 0.0), None, MM)
    size = np.linalg.norm(centroids(CUP), axis=1)
    rim = np.ptp(CUP.vertices[CUP.faces][:, :, 1], axis=1) < 1e-9
    np.testing.assert_array_equal(faces_where(CUP, "outward < -0.9", MM, names), (size < 24.2) & ~rim)
    np.testing.assert_array_equal(faces_where(CUP, "outward > 0.9", MM, names), (size > 28.0) & ~rim)
    np.testing.assert_array_equal(faces_where(CUP, "radial < 26", MM, names), size < 26.0)


def test_flexion_is_an_angle_in_degrees():
    sagittal = Sagittal(Y, (0.0, 0.0, 1.0), (1.0, 0.0, 0.0))
    chosen = faces_where(BALL, "30 < flexion < 60", MM, about_flexion(BALL, sagittal))
    at = np.degrees(np.arctan2(centroids(BALL)[:, 0], centroids(BALL)[:, 2]))
    np.testing.assert_array_equal(chosen, (at > 30) & (at < 60))
    assert chosen.sum() == pytest.approx(len(chosen) / 12, rel=0.15)


def test_distance_is_that_of_the_proximity_query_in_the_mesh_unit():
    """The ball of radius 20 in the cavity of radius 24: the cavity is 4 mm away, the back 9."""
    names = about_other(CUP, BALL, MM)
    near = faces_where(CUP, "distance < 4.5", MM, names)
    np.testing.assert_array_equal(near, np.linalg.norm(centroids(CUP), axis=1) < 24.4)
    assert 0 < near.sum() < len(near)
    assert faces_where(CUP, "distance < 0.0045", 1.0, about_other(CUP, BALL)).sum() == near.sum()


def test_names_are_computed_only_where_they_are_used_and_pass_on_what_they_refuse():
    def refuse():
        raise ValueError("flexion needs an axis")

    assert faces_where(BALL, "x > 0", MM, {"flexion": refuse}).any()
    with pytest.raises(ValueError, match="flexion needs an axis"):
        faces_where(BALL, "x > 0 and flexion > 3", MM, {"flexion": refuse})
    with pytest.raises(ValueError, match=r"only x, y, z, nx, ny, nz, flexion, numbers"):
        faces_where(BALL, "radial > 3", MM, {"flexion": refuse})
