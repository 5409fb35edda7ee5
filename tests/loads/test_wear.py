"""Wear of an elastic layer: Archard's law in closed form, cross-shear of known paths, and a second way to slide."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.surface import Surface
from geocontact.geometry.surface_quadrature import SurfaceQuadrature, surface_quadrature
from geocontact.loads.wear import LayerWear, SlidingWork, WearFactor, Wearing, tangents
from meshes.simple_shapes import block

K, MILLION = 1e-16, 1e6
"""m^2/N, which is 1e-7 mm^3/(N m); cycles."""
PLACES = np.array([[0.0, 0.0, 0.0], [5e-3, 0.0, -2e-3], [-3e-3, 0.0, 4e-3]])


def plate(points: np.ndarray = PLACES) -> SurfaceQuadrature:
    """Pieces of 1 mm^2 that look along y."""
    n = len(points)
    return SurfaceQuadrature(points, np.full(n, 1e-6), np.tile([0.0, 1.0, 0.0], (n, 1)), np.arange(n))


def worn(poses: RigidTransform, pressure: np.ndarray, factor: WearFactor, pieces: SurfaceQuadrature) -> LayerWear:
    """After a million cycles of the same poses; pressures by frame and piece [Pa]."""
    wearing = Wearing(pieces, poses)
    for one in np.broadcast_to(pressure, (len(poses), len(pieces.area))):
        wearing.add(one)
    return wearing.after(factor, MILLION)


def shifts(*path: tuple[float, float]) -> RigidTransform:
    """Poses that shift by x and z [m]."""
    return RigidTransform.from_translation(np.array([[x, 0.0, z] for x, z in path]))


def test_depth_is_factor_times_pressure_times_path() -> None:
    found = worn(shifts((0.0, 0.0), (3e-3, 4e-3), (0.0, 0.0)), np.array([2e6, 0.0, 1e6]), WearFactor.same(K), plate())
    np.testing.assert_allclose(found.depth, MILLION * K * np.array([2e6, 0.0, 1e6]) * 10e-3, rtol=1e-12)
    assert found.volume == pytest.approx(MILLION * K * (2.0 + 1.0) * 10e-3, rel=1e-12)  # k F s, with 2 N and 1 N
    assert found.total_work == pytest.approx(3.0 * 10e-3, rel=1e-12)
    assert found.deepest == 0 and found.closing == pytest.approx(0.0, abs=1e-15)


def test_a_body_that_turns_about_the_normal_slides_along_arcs() -> None:
    """The path over a place at the distance r from the axis is r times the angle, however few the frames."""
    turns = RigidTransform.from_rotation(
        Rotation.from_rotvec(np.outer(np.radians([0.0, 80.0, 150.0]), [0.0, 1.0, 0.0]))
    )
    found = worn(turns, np.full(3, 1e6), WearFactor.same(K), plate())
    radius = np.hypot(PLACES[:, 0], PLACES[:, 2])
    np.testing.assert_allclose(found.work, 1e6 * radius * np.radians(150.0), rtol=1e-12, atol=1e-9)


def test_what_moves_along_the_normal_or_rolls_does_not_slide() -> None:
    lifted = RigidTransform.from_translation([[0.0, 0.0, 0.0], [0.0, 1e-3, 0.0]])
    assert worn(lifted, np.full(3, 1e6), WearFactor.same(K), plate()).volume == 0.0
    radius, angles = 20e-3, np.linspace(0.0, 1.0, 2001)
    turn = Rotation.from_rotvec(np.outer(angles, [0.0, 0.0, -1.0]))
    rolled = RigidTransform.from_components(
        np.column_stack([radius * angles, np.full(len(angles), radius), np.zeros(len(angles))]), turn
    )
    touched = plate(np.column_stack([radius * angles, np.zeros(len(angles)), np.zeros(len(angles))]))
    at_contact = 1e6 * np.eye(len(angles))
    work = worn(rolled, at_contact, WearFactor.same(K), touched).work
    assert work.max() < 1e6 * radius * 1e-6  # second order in the angle of a step, 0.5 mrad


def test_work_is_that_of_points_followed_in_many_small_steps() -> None:
    """Another derivation: a point of MOVING is carried by interpolated poses, and the path over a place summed up."""
    rng = np.random.default_rng(1)
    turn = Rotation.from_rotvec(0.3 * rng.standard_normal((4, 3)))
    poses = RigidTransform.from_components(4e-3 * rng.standard_normal((4, 3)), turn)
    pressure = 1e6 * rng.random((4, 3))
    found = worn(poses, pressure, WearFactor.same(K), plate())
    expected = np.zeros(3)
    for k in range(3):
        twist = (poses[k + 1] * poses[k].inv()).as_exp_coords()
        share = np.linspace(0.0, 1.0, 201)
        along = [RigidTransform.from_exp_coords(s * twist) * poses[k] for s in share]
        for j in range(len(share) - 1):
            mean = pressure[k] + 0.5 * (share[j] + share[j + 1]) * (pressure[k + 1] - pressure[k])
            middle = RigidTransform.from_exp_coords(0.5 * (share[j] + share[j + 1]) * twist) * poses[k]
            touching = middle.inv().apply(PLACES)  # points of MOVING that are at the places in between
            slid = along[j + 1].apply(touching) - along[j].apply(touching)
            expected += mean * np.hypot(slid[:, 0], slid[:, 2])
    np.testing.assert_allclose(found.work, expected, rtol=1e-5)


@pytest.mark.parametrize(("width", "expected"), [(0.0, 0.0), (1.0, 0.5), (0.5, 1.0 / 3.0)])
def test_cross_shear_of_a_rectangle_is_its_shorter_share(width: float, expected: float) -> None:
    """Along the sides of a rectangle 1 : w the work across the principal direction is w / (1 + w) of all."""
    path = shifts((0.0, 0.0), (2e-3, 0.0), (2e-3, 2e-3 * width), (0.0, 2e-3 * width), (0.0, 0.0))
    found = worn(path, np.full(3, 1e6), WearFactor.same(K), plate())
    np.testing.assert_allclose(found.ratio, expected, atol=1e-12)


@pytest.mark.parametrize("angle", [10.0, 45.0, 100.0])
def test_cross_shear_is_the_least_share_over_all_directions(angle: float) -> None:
    """Another derivation, which also shows that the ratio does not depend on the axes: a search over directions."""
    path = np.array([[0.0, 0.0], [1.0, 0.2], [1.5, 1.0], [0.4, 1.1], [0.0, 0.0]]) * 1e-3
    c, s = np.cos(np.radians(angle)), np.sin(np.radians(angle))
    turned = path @ np.array([[c, s], [-s, c]])
    found = worn(shifts(*map(tuple, turned)), np.full(3, 1e6), WearFactor.same(K), plate())
    steps = np.diff(path, axis=0)
    lengths, ways = np.linalg.norm(steps, axis=1), np.arctan2(steps[:, 1], steps[:, 0])
    directions = np.linspace(0.0, np.pi, 20_001)
    across = (lengths * np.sin(ways - directions[:, None]) ** 2).sum(axis=1) / lengths.sum()
    np.testing.assert_allclose(found.ratio, across.min(), atol=1e-7)


def test_factors_are_linear_between_ratios_and_held_beyond() -> None:
    factor = WearFactor(np.array([0.1, 0.3]), np.array([1e-16, 5e-16]))
    np.testing.assert_allclose(factor.at(np.array([0.0, 0.1, 0.2, 0.3, 0.5])), [1e-16, 1e-16, 3e-16, 5e-16, 5e-16])
    assert factor.depends and not WearFactor.same(K).depends
    square = shifts((0.0, 0.0), (1e-3, 0.0), (1e-3, 0.5e-3), (0.0, 0.5e-3), (0.0, 0.0))
    found = worn(square, np.full(3, 1e6), factor, plate())
    np.testing.assert_allclose(found.depth, MILLION * 5e-16 * 1e6 * 3e-3, rtol=1e-12)  # a ratio of 1/3


@pytest.mark.parametrize(
    ("ratio", "factor", "what"),
    [
        ([], [], "as many values"),
        ([0.3, 0.1], [1e-16, 2e-16], "must increase"),
        ([0.0, 0.6], [1e-16, 2e-16], "0.5 at most"),
        ([-0.1, 0.2], [1e-16, 2e-16], "from 0"),
        ([0.0, 0.2], [1e-16, -2e-16], "not negative"),
        ([0.0, np.nan], [1e-16, 2e-16], "must increase"),
    ],
)
def test_factors_that_cannot_be_are_refused(ratio: list[float], factor: list[float], what: str) -> None:
    with pytest.raises(ValueError, match=what):
        WearFactor(np.array(ratio), np.array(factor))


def test_an_open_path_and_coarse_frames_show() -> None:
    one_way = worn(shifts((0.0, 0.0), (4e-3, 0.0), (8e-3, 0.0)), np.full(3, 1e6), WearFactor.same(K), plate())
    assert one_way.closing == pytest.approx(one_way.total_work) and one_way.coarser == pytest.approx(0.0)
    path = shifts(*((1e-3 * k, 0.0) for k in range(5)))
    peaks = np.array([[0.0], [1.0], [0.0], [1.0], [0.0]]) * 1e6
    jagged = worn(path, peaks, WearFactor.same(K), plate())
    assert jagged.coarser == pytest.approx(1.0)  # every second frame has no pressure at all
    even = worn(path[:4], peaks[:4], WearFactor.same(K), plate())
    assert even.coarser == pytest.approx(1.0)  # the last frame, which is left out, is not compared


def test_wear_does_not_depend_on_the_frame_of_the_plate() -> None:
    rng = np.random.default_rng(2)
    poses = RigidTransform.from_components(
        3e-3 * rng.standard_normal((5, 3)), Rotation.from_rotvec(0.1 * rng.standard_normal((5, 3)))
    )
    pressure = 1e6 * rng.random((5, 3))
    other = RigidTransform.from_components([0.1, -0.2, 0.3], Rotation.from_rotvec([0.5, -1.0, 0.7]))
    pieces, here = plate(), worn(poses, pressure, WearFactor.same(K), plate())
    moved = SurfaceQuadrature(other.apply(pieces.point), pieces.area, other.rotation.apply(pieces.normal), pieces.face)
    there = worn(other * poses, pressure, WearFactor.same(K), moved)
    np.testing.assert_allclose(there.work, here.work, rtol=1e-9)
    np.testing.assert_allclose(there.ratio, here.ratio, atol=1e-9)


def test_axes_across_normals_are_unit_and_at_right_angles() -> None:
    normal = np.random.default_rng(3).standard_normal((50, 3))
    normal = np.vstack([normal / np.linalg.norm(normal, axis=1)[:, None], np.eye(3), -np.eye(3)])
    first, second = tangents(normal)
    frames = np.stack([first, second, normal], axis=1)
    np.testing.assert_allclose(frames @ frames.transpose(0, 2, 1), np.tile(np.eye(3), (len(normal), 1, 1)), atol=1e-12)


def test_one_frame_has_no_wear() -> None:
    found = worn(shifts((0.0, 0.0)), np.full(3, 1e6), WearFactor.same(K), plate())
    assert found.volume == 0.0 and found.coarser == 0.0 and (found.ratio == 0.0).all()


def test_pieces_of_a_body_wear_on_the_side_that_is_pressed() -> None:
    vertices, faces = block(20.0, 20.0, 5.0, 4)
    body = Surface(vertices * 1e-3, faces, "plate")
    pieces = surface_quadrature(body, 2e-3)
    top = pieces.normal[:, 1] > 0.9
    work = SlidingWork(pieces, shifts((0.0, 0.0), (1e-3, 0.0)))
    for _ in range(2):
        work.add(np.where(top, 1e6, 0.0))
    np.testing.assert_allclose(work.work, np.where(top, 1e3, 0.0), rtol=1e-12)
