"""Geodesics and mats on the smooth segments against closed forms: unrolled cones, Clairaut, mirror planes."""

from itertools import pairwise

import numpy as np
import pytest

from meshes.geodesics import along, heading, onward, velocity
from meshes.mat_placement import THIGH_MAT, TORSO_MAT, Mat
from meshes.segments import SEGMENTS, Oval, Segment

CONE = Segment("cone", 300.0, Oval(60.0, 60.0), 0.002, 0.0)
TUBE = Segment("tube", 300.0, Oval(60.0, 60.0), 0.0, 0.0)
BARREL = Segment("barrel", 300.0, Oval(60.0, 60.0), 0.001, -8e-6)
each_mat = pytest.mark.parametrize("mat", [THIGH_MAT, TORSO_MAT], ids=lambda m: m.name)


def started(segment, theta, y, turn):
    return Mat("mat", segment, 8, 8, theta, y, turn).start()


def unrolled_cone(at):
    """The cone laid flat about its apex: y = -500 here, half-angle atan(0.12)."""
    slant = (at[..., 1] + 500.0) * np.hypot(1.0, 0.12)
    turn = at[..., 0] * 0.12 / np.hypot(1.0, 0.12)
    return np.stack([slant * np.cos(turn), slant * np.sin(turn)], axis=-1)


@pytest.mark.parametrize("turn", [0.0, 0.7, 1.5, 3.0])
def test_geodesics_of_a_cone_are_straight_when_it_is_unrolled(turn):
    ways = np.array([-120.0, -30.0, 0.0, 50.0, 110.0])
    flat = unrolled_cone(along(CONE, started(CONE, 0.3, 20.0, turn), ways)[:, :2])
    direction = (flat[-1] - flat[2]) / 110.0
    assert np.linalg.norm(direction) == pytest.approx(1.0, abs=1e-11)
    assert flat == pytest.approx(flat[2] + ways[:, None] * direction, abs=1e-9)


def test_clairaut_on_a_barrel():
    states = along(BARREL, started(BARREL, 0.0, 10.0, 1.2), np.linspace(-150, 150, 31))
    momentum = BARREL.radius(states[:, :2])[:, 0] ** 2 * states[:, 2]
    assert np.ptp(states[:, 1]) > 50
    assert momentum == pytest.approx(momentum[15], rel=1e-11)


@pytest.mark.parametrize("segment", SEGMENTS, ids=lambda s: s.name)
def test_speed_stays_and_the_way_back_is_the_way_there(segment):
    start = started(segment, 0.4, -20.0, 0.9)
    there = onward(segment, start, 120.0)
    assert np.linalg.norm(heading(segment, there)) == pytest.approx(1.0, abs=1e-10)
    assert onward(segment, there, -120.0) == pytest.approx(start, abs=1e-10)


def test_error_falls_with_the_fourth_power_of_the_step():
    segment, steps = SEGMENTS[0], np.array([16.0, 8.0, 4.0, 2.0])
    start = started(segment, 0.4, -20.0, 0.9)
    end = segment.points(onward(segment, start, 128.0)[:2])
    errors = [np.linalg.norm(segment.points(onward(segment, start, 128.0, h)[:2]) - end) for h in steps]
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order == pytest.approx(4.0, abs=0.3), f"observed order {order:.2f}, errors {errors}"


def test_velocity_is_the_inverse_of_heading():
    segment, at = SEGMENTS[3], np.array([0.7, 30.0])
    tangent = segment.tangents(at).T @ [0.01, -0.6]
    assert velocity(segment, at, tangent) == pytest.approx([0.01, -0.6], rel=1e-12)


def test_middle_line_on_the_thigh_is_its_profile():
    """The mirror plane z = 0 cuts out a geodesic; its length is a quadrature of the profile, no equation solved."""
    marks = THIGH_MAT.landmark_points().reshape(3, 3, 3)[:, 1]
    assert np.abs(marks[:, 2]).max() < 1e-12
    nodes, weights = np.polynomial.legendre.leggauss(60)
    for upper, lower in pairwise(marks):
        half = (upper[1] - lower[1]) / 2
        y = (upper[1] + lower[1]) / 2 + half * nodes
        slope = THIGH_MAT.segment.radius(np.column_stack([np.zeros_like(y), y]))[:, 2]
        assert half * weights @ np.hypot(1.0, slope) == pytest.approx(8 * THIGH_MAT.pitch, abs=1e-9)


@pytest.mark.parametrize("segment", [TUBE, CONE], ids=lambda s: s.name)
def test_mat_on_a_developable_segment_keeps_all_its_distances(segment):
    mat = Mat("mat", segment, 12, 6, 0.2, 5.0, 0.5)
    u, v = np.arange(13.0), np.arange(7.0)
    at = mat.parameters(u, v)
    flat = unrolled_cone(at) if segment is CONE else np.stack([60.0 * at[..., 0], at[..., 1]], axis=-1)
    there = mat.pitch * np.stack(np.meshgrid(u, v, indexing="ij"), axis=-1)
    for a in ((0, 0), (12, 0), (5, 3)):
        expected = np.linalg.norm(there - there[a], axis=-1)
        assert np.linalg.norm(flat - flat[a], axis=-1) == pytest.approx(expected, abs=1e-9)


def positions(mat, u, v):
    return mat.segment.points(mat.parameters(u, v))


def beside(places, *steps):
    """Each place with every step added, in one row that increases: geodesics are followed once for all."""
    return (places[:, None] + np.array(steps)).ravel()


def gaussian_curvature(segment, at):
    d = segment.derivatives(at)
    n = segment.normals(at)
    second = [np.sum(n * d[..., k, :], axis=-1) for k in (2, 3, 4)]
    first = np.linalg.norm(segment.area_vector(at), axis=-1) ** 2
    return (second[0] * second[2] - second[1] ** 2) / first


@pytest.mark.slow
@each_mat
def test_ribs_draw_together_by_the_gaussian_curvature(mat):
    """|S_u| = 1 - K v^2/2 + O(v^3) beside the middle line (u and v in mm), and 1 on it."""
    u, h, v = np.array([3.0, mat.rows / 2, mat.rows - 2.0]), 1e-3, 0.2
    at = positions(mat, beside(u, -h, h), mat.columns / 2 + np.array([-v, 0.0, v]))
    wide = np.linalg.norm(at[1::2] - at[::2], axis=-1).T[..., None]
    scale = 2 * h * mat.pitch
    assert wide[1] / scale == pytest.approx(np.ones((3, 1)), abs=1e-8)
    curvature = gaussian_curvature(mat.segment, mat.parameters(u, np.array([mat.columns / 2])))
    bend = -(wide[0] - 2 * wide[1] + wide[2]) / scale / (v * mat.pitch) ** 2
    assert bend == pytest.approx(curvature, rel=2e-3, abs=2e-8)
    assert np.abs(curvature).max() > 3e-6, "the skin is doubly curved here"


@pytest.mark.slow
@each_mat
def test_rows_and_columns_are_at_right_angles_and_look_outwards(mat):
    u, v, h = np.arange(1.0, mat.rows), np.arange(1.0, mat.columns), 1e-3
    at = positions(mat, beside(u, -h, 0.0, h), beside(v, -h, 0.0, h))
    along_u = (at[2::3, 1::3] - at[::3, 1::3]) / (2 * h * mat.pitch)
    along_v = (at[1::3, 2::3] - at[1::3, ::3]) / (2 * h * mat.pitch)
    assert np.sum(along_u * along_v, axis=-1) == pytest.approx(np.zeros((len(u), len(v))), abs=1e-7)
    assert np.linalg.norm(along_v, axis=-1) == pytest.approx(np.ones((len(u), len(v))), abs=1e-7)
    outward = np.sum(np.cross(along_u, along_v) * mat.segment.normals(mat.parameters(u, v)), axis=-1)
    assert outward.min() > 0.95
    assert outward.max() < 1.02


@each_mat
def test_landmarks_stand_to_a_picometre(mat):
    u, v = (np.unique(c) for c in mat.landmarks.T)
    finer = mat.segment.points(mat.parameters(u, v, step=0.1)).reshape(-1, 3)
    assert mat.landmark_points() == pytest.approx(finer, abs=1e-9)
    assert np.abs(mat.segment.off_surface(finer)).max() < 1e-11
