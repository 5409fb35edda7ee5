"""The device's frame from three markers, beside rotations by scipy, and wherever the laboratory is."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.shoulder_exoskeleton.device_frame import (
    DeviceFrame,
    about_x,
    aligned_with_x,
    device_frame,
    upright_pitch,
)

FRAMES = 200


def placed(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Three reference markers in any position."""
    rng = np.random.default_rng(seed)
    origin = rng.normal(size=(FRAMES, 3))
    return origin, origin + 0.1 * rng.normal(size=(FRAMES, 3)), origin + 0.3 * rng.normal(size=(FRAMES, 3))


@pytest.mark.parametrize("pitch", [0.0, -0.08, 0.6])
def test_it_is_the_rotation_that_scipy_finds(pitch: float) -> None:
    """The bar exactly along x, T10 as near as it goes to its place: one alignment of two vectors, in each frame."""
    origin, left, below = placed(1)
    found = device_frame(origin, left, below, pitch)
    target = [[1.0, 0.0, 0.0], [0.0, np.sin(pitch), -np.cos(pitch)]]
    for k in range(FRAMES):
        bar, spine = left[k] - origin[k], below[k] - origin[k]
        spine = spine - (spine @ bar) / (bar @ bar) * bar  # scipy rejects pairs that disagree about the angle between
        theirs, _ = Rotation.align_vectors(target, [bar, spine / np.linalg.norm(spine)], weights=[np.inf, 1.0])
        np.testing.assert_allclose(found.rotation[k], theirs.as_matrix(), atol=1e-12)
    np.testing.assert_allclose(found.points(origin), 0.0, atol=1e-15)
    np.testing.assert_allclose(found.points(left)[:, 1:], 0.0, atol=1e-14)


def test_first_turn_is_the_shortest() -> None:
    """Eq. 2 with the skew form that the paper's print lacks, where the vector does not point against x."""
    vectors = np.random.default_rng(2).normal(size=(FRAMES, 3))
    vectors[:, 0] = np.abs(vectors[:, 0])
    for vector, found in zip(vectors, aligned_with_x(vectors), strict=True):
        unit = vector / np.linalg.norm(vector)
        axis = np.cross(unit, [1.0, 0.0, 0.0])
        angle = np.arccos(unit[0])
        theirs = Rotation.from_rotvec(angle * axis / np.linalg.norm(axis)).as_matrix()
        np.testing.assert_allclose(found, theirs, atol=1e-12)


def test_a_bar_against_x_is_no_exception() -> None:
    """A wearer who faces backwards in the laboratory: the axis of the shortest turn is not defined there."""
    away = 10.0 ** -np.arange(1.0, 17.0)
    vectors = np.column_stack((-np.ones(16), away, 0.5 * away))
    turns = aligned_with_x(vectors)
    turned = np.einsum("tij,tj->ti", turns, vectors / np.linalg.norm(vectors, axis=1, keepdims=True))
    np.testing.assert_allclose(turned, np.tile([1.0, 0.0, 0.0], (16, 1)), atol=1e-15)
    np.testing.assert_allclose(turns @ turns.transpose(0, 2, 1), np.tile(np.eye(3), (16, 1, 1)), atol=1e-15)
    np.testing.assert_allclose(np.linalg.det(turns), 1.0, atol=1e-15)


def test_second_turn_is_about_x() -> None:
    angles = np.linspace(-4.0, 4.0, 9)
    theirs = Rotation.from_rotvec(angles[:, None] * [1.0, 0.0, 0.0])
    np.testing.assert_allclose(about_x(angles), theirs.as_matrix(), atol=1e-15)


def test_the_laboratory_does_not_matter() -> None:
    """The same markers in a laboratory that is turned and shifted are at the same places in the device."""
    origin, left, below = placed(3)
    point = np.random.default_rng(4).normal(size=(FRAMES, 3))
    moved = Rotation.from_rotvec([0.4, -2.1, 1.3])
    shift = np.array([3.0, -2.0, 0.5])
    here = device_frame(origin, left, below, 0.1)
    there = device_frame(*(moved.apply(each) + shift for each in (origin, left, below)), 0.1)
    np.testing.assert_allclose(there.points(moved.apply(point) + shift), here.points(point), atol=1e-12)


def test_pitch_of_an_upright_wearer_makes_z_upright() -> None:
    up = np.array([0.0, 2.0, 0.0])
    turn = Rotation.from_rotvec(np.linspace(0.0, 3.0, FRAMES)[:, None] * [0.0, 1.0, 0.0])  # turning on the spot
    origin = np.zeros((FRAMES, 3))
    left, below = turn.apply([0.0, 0.0, -0.1]), turn.apply([0.03, -0.25, 0.0])
    pitch = upright_pitch(origin, left, below, up)
    assert pitch == pytest.approx(-np.arctan2(0.03, 0.25), abs=1e-14)
    vertical = device_frame(origin, left, below, pitch).vectors(up)
    np.testing.assert_allclose(vertical, np.tile([0.0, 0.0, 2.0], (FRAMES, 1)), atol=1e-14)


def test_at_other_times_it_turns_and_moves_on_evenly() -> None:
    """A turn of 1 rad/s about z and a way of 2 m/s: exact between the frames and across one that is not seen."""

    def pose(time: np.ndarray) -> DeviceFrame:
        turns = Rotation.from_rotvec(np.outer(time, [0.0, 0.0, 1.0])).as_matrix()
        return DeviceFrame(np.outer(time, [2.0, 0.0, 0.0]), turns)

    time = np.arange(5.0) * 0.5
    frame = pose(time)
    frame.rotation[2] = np.nan
    wanted = np.array([-1.0, 0.3, 1.1, 1.9, 9.0])
    found, truth = frame.at(time, wanted), pose(np.clip(wanted, 0.0, 2.0))
    np.testing.assert_allclose(found.origin, truth.origin, atol=1e-12)
    np.testing.assert_allclose(found.rotation, truth.rotation, atol=1e-12)


def test_a_marker_on_the_device_stands_still_in_its_frame() -> None:
    origin, left, below = placed(3)
    frame = device_frame(origin, left, below)
    place = np.array([0.1, -0.2, 0.3])
    there = origin + np.einsum("tji,j->ti", frame.rotation, place)
    seen = MarkerTrajectories(np.arange(float(FRAMES)), there[:, None], ("M",))
    np.testing.assert_allclose(frame.markers(seen, seen.time + 0.4)[:, 0], np.tile(place, (FRAMES, 1)), atol=1e-12)
