"""Velocities from poses: exact for cubic motion, third order otherwise, the same in every frame."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.loads.resultant import pose_rate
from tests.loads.scenes import rigid

POINT = np.array([0.2, -0.05, 0.03, 1.0])


def rolling(steps: int) -> tuple[np.ndarray, RigidTransform, np.ndarray]:
    """A wheel of radius 0.3 m that rolls on y = 0: times, poses, and the velocity of `POINT` by formula."""
    time = np.linspace(0.0, 1.0, steps)
    angle, speed = -2.0 * time - 0.5 * time**2, -2.0 - time
    shift = np.column_stack([-0.3 * angle, np.full(steps, 0.3), np.zeros(steps)])
    poses = RigidTransform.from_components(shift, Rotation.from_rotvec(angle[:, None] * [0.0, 0.0, 1.0]))
    arm = poses.rotation.apply(POINT[:3])
    velocity = np.column_stack([-0.3 * speed - speed * arm[:, 1], speed * arm[:, 0], np.zeros(steps)])
    return time, poses, velocity


def test_velocity_converges_at_third_order_or_better() -> None:
    steps, errors = np.array([21, 41, 81, 161]), []
    for count in steps:
        time, poses, velocity = rolling(count)
        errors.append(np.abs((pose_rate(time, poses) @ POINT)[:, :3] - velocity).max())
    order = -np.polyfit(np.log(steps - 1.0), np.log(errors), 1)[0]
    assert order > 2.7, f"observed order {order:.2f}, errors {errors}"


def test_cubic_translation_is_exact() -> None:
    time = np.array([0.0, 0.1, 0.15, 0.4, 0.7, 1.0])
    poses = RigidTransform.from_translation(np.column_stack([time**3, time**2, 1.0 - time]))
    rate = pose_rate(time, poses)
    np.testing.assert_allclose(rate[:, :3, 3], np.column_stack([3 * time**2, 2 * time, -np.ones(6)]), atol=1e-12)
    np.testing.assert_allclose(rate[:, :3, :3], 0.0, atol=1e-12)


@given(rigid, rigid)
def test_frames_of_ground_and_foot_do_not_matter(before: RigidTransform, after: RigidTransform) -> None:
    time, poses, _ = rolling(11)
    changed = pose_rate(time, before * poses * after)
    expected = before.as_matrix() @ pose_rate(time, poses) @ after.as_matrix()
    np.testing.assert_allclose(changed, expected, atol=1e-10)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_few_frames(count: int) -> None:
    time = np.arange(count) * 0.5
    rate = pose_rate(time, RigidTransform.from_translation(np.column_stack([time, 0 * time, 0 * time])))
    np.testing.assert_allclose(rate[:, 0, 3], 1.0 if count > 1 else 0.0, atol=1e-14)
