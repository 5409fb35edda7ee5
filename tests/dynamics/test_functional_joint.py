"""Joint centres and axes from planted motions of two segments."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.dynamics.functional_joint import functional_axis, functional_centre, segment_poses

FIRST, SECOND = np.array([0.03, -0.41, 0.05]), np.array([-0.02, 0.39, 0.01])
AXIS = np.array([0.1, -0.2, 0.95]) / np.linalg.norm([0.1, -0.2, 0.95])
MOUNTED = Rotation.from_euler("XYZ", [0.3, -0.2, 0.1])
FRAMES = 120


def segments(turns: Rotation, seed: int = 0, noise: float = 0.0) -> tuple[RigidTransform, RigidTransform]:
    """The first moves about; the second turns against it about the centre by these turns, seen in the first's frame."""
    rng = np.random.default_rng(seed)
    time = np.linspace(0, 1, len(turns))
    shift = 0.2 * np.sin(2 * np.pi * time[:, None] * [1.0, 0.7, 1.3])
    first = RigidTransform.from_components(shift, Rotation.from_rotvec(0.3 * shift[:, ::-1]))
    joint = RigidTransform.from_components(np.tile(FIRST, (len(turns), 1)), turns)
    second = first * joint * RigidTransform.from_components(SECOND, MOUNTED).inv()
    moved = second.translation + noise * rng.normal(size=(len(turns), 3))
    return first, RigidTransform.from_components(moved, second.rotation)


def all_round(size: float = 0.5) -> Rotation:
    time = np.linspace(0, 2 * np.pi, FRAMES)
    return Rotation.from_rotvec(size * np.column_stack([np.sin(time), np.cos(1.7 * time), np.sin(2.3 * time)]))


def hinge(size: float = 0.8) -> Rotation:
    return Rotation.from_rotvec(np.linspace(0, size, FRAMES)[:, None] * AXIS)


def test_a_ball_joint_is_found() -> None:
    found = functional_centre(*segments(all_round()))
    np.testing.assert_allclose(found.first, FIRST, atol=1e-12)
    np.testing.assert_allclose(found.second, SECOND, atol=1e-12)
    assert found.rms < 1e-12


def test_standard_errors_hold_what_noise_does() -> None:
    """Errors over standard errors, of 60 draws: their mean square is one."""
    ratios = []
    for seed in range(60):
        found = functional_centre(*segments(all_round(), seed, noise=2e-3))
        ratios.append((found.first - FIRST) / found.first_sd)
        assert found.rms == pytest.approx(2e-3 * np.sqrt(3), rel=0.3)
    assert np.mean(np.square(ratios)) == pytest.approx(1.0, abs=0.3)


def test_less_motion_tells_less() -> None:
    wide, narrow = (functional_centre(*segments(all_round(size), noise=1e-3)) for size in (0.5, 0.1))
    assert narrow.first_sd.max() > 4 * wide.first_sd.max()


def test_a_hinge_is_found() -> None:
    found = functional_axis(*segments(hinge()))
    np.testing.assert_allclose(found.first_direction, AXIS, atol=1e-9)
    np.testing.assert_allclose(found.second_direction, MOUNTED.apply(AXIS), atol=1e-9)
    np.testing.assert_allclose(found.first, FIRST - (FIRST @ AXIS) * AXIS, atol=1e-9)
    away = found.second - SECOND
    np.testing.assert_allclose(np.cross(away, MOUNTED.apply(AXIS)), 0.0, atol=1e-9)
    assert found.looseness < 1e-6 and found.rms < 1e-9


def test_a_ball_is_no_hinge() -> None:
    assert functional_axis(*segments(all_round())).looseness > 0.3


def test_a_hinge_has_no_centre() -> None:
    """Nor with the noise of a cluster of markers, which lets it look like a little more than a hinge."""
    rng = np.random.default_rng(6)
    first, second = segments(hinge())
    with pytest.raises(ValueError, match="turn about one axis"):
        functional_centre(first, second)
    for noise in (1e-4, 1e-3, 3e-3):
        shaken = [
            RigidTransform.from_components(
                each.translation + noise * rng.normal(size=(FRAMES, 3)),
                Rotation.from_rotvec(noise / 0.08 * rng.normal(size=(FRAMES, 3))) * each.rotation,
            )
            for each in (first, second)
        ]
        with pytest.raises(ValueError, match="turn about one axis"):
            functional_centre(*shaken)


@pytest.mark.parametrize("method", [functional_centre, functional_axis])
def test_segments_that_hardly_move_tell_nothing(method: object) -> None:
    with pytest.raises(ValueError, match="turn against each other by 2 deg only"):
        method(*segments(hinge(np.radians(2.0))))  # type: ignore[operator]


def test_poses_of_a_cluster() -> None:
    """Lost markers are left out; a frame with two is not known."""
    first, _ = segments(all_round())
    template = np.array([[0.05, 0.0, 0.0], [0.0, 0.06, 0.01], [-0.04, 0.0, 0.03], [0.0, -0.05, -0.02]])
    places = np.stack([first[k].apply(template) for k in range(FRAMES)])
    places[3, 1] = np.nan
    places[5, :2] = np.nan
    poses, known, off = segment_poses(places, template)
    assert not known[5] and known.sum() == FRAMES - 1 and np.isnan(off[5])
    np.testing.assert_allclose(poses.as_matrix(), first[known].as_matrix(), atol=1e-12)
    assert np.nanmax(off) < 1e-12
    own, _, _ = segment_poses(places)
    turned = own[0].inv() * own[1]
    np.testing.assert_allclose(turned.rotation.magnitude(), (first[0].inv() * first[1]).rotation.magnitude(), atol=1e-9)
    with pytest.raises(ValueError, match="no frame shows all markers"):
        segment_poses(np.where(np.arange(4)[:, None] == 0, np.nan, places))
