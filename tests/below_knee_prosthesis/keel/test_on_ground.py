"""The keel on grounds that are no floor: along hinges as in the kernel, on stairs, over an edge."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from benchmarks.prosthesis.grounds import SLOPE, strip, turned
from benchmarks.prosthesis.keel_stance import Stance
from geocontact.below_knee_prosthesis.keel.quasi_static import loads_at
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Stairs
from geocontact.loads.resultant import pose_rate

FAR = Stairs((-5.0,), (-1.0, 0.0))
"""Stairs whose one tread is the floor."""


def moving(frames: int = 6) -> tuple[np.ndarray, RigidTransform]:
    time = np.linspace(0.0, 0.1, frames)
    turn = Rotation.from_euler("zx", np.column_stack([np.linspace(-0.1, -0.3, frames), np.linspace(0.0, 0.05, frames)]))
    return time, RigidTransform.from_components(
        np.column_stack([0.1 * time, np.linspace(0.034, 0.055, frames), 0.0 * time]), turn
    )


def test_segments_as_feet_of_their_own_are_the_keel_of_the_kernel() -> None:
    keel, rng = vsf_foot().at(0.1), np.random.default_rng(1)
    time, poses = moving()
    angles, speeds = rng.normal(0.02, 0.02, (len(time), 8)), rng.normal(0.0, 0.5, (len(time), 8))
    rate = np.zeros((len(time), 4, 4))
    turn = poses.rotation.as_matrix()
    rate[:, :3, :3] = np.cross(np.array([0.2, -0.1, -1.5]), turn.swapaxes(1, 2)).swapaxes(1, 2)
    rate[:, :3, 3] = [0.1, -0.2, 0.05]
    floor, stairs = (loads_at(keel, angles, speeds, poses, rate, ground) for ground in (HalfSpace(), FAR))
    assert floor.pressing.sum(axis=1).min() > 50.0
    np.testing.assert_allclose(stairs.force, floor.force, atol=1e-6 * np.abs(floor.force).max())
    np.testing.assert_allclose(stairs.centre, floor.centre, atol=1e-12)


@pytest.mark.parametrize("edge", [0.06, 0.10])
def test_what_is_behind_the_edge_of_a_step_hangs_in_the_air(edge: float) -> None:
    """Equilibrium on an edge, found in turns: every sphere presses from where the stairs are nearest to it."""
    keel = vsf_foot().at(0.1)
    height = np.linspace(0.036, 0.022, 6)
    poses = RigidTransform.from_components(
        np.column_stack([0.0 * height, height, 0.0 * height]), Rotation.from_euler("z", np.full((6, 1), -0.05))
    )
    stairs = Stairs((edge,), (-0.17, 0.0))
    found, level = keel.solve(poses, stairs), keel.solve(poses, HalfSpace())
    behind = keel.sole.spheres.centre[:, 0] < edge - 0.02
    assert not found.loads.pressing[:, behind].any()
    assert level.loads.pressing[-1, behind].any()
    near = stairs.proximity(found.loads.centre.reshape(-1, 3)).distance.reshape(found.loads.depth.shape)
    touching = found.loads.depth > 0.0
    np.testing.assert_allclose(
        found.loads.depth[touching], (keel.sole.spheres.radius - near)[touching], rtol=0.0, atol=2e-6
    )
    assert np.abs(found.loads.normal[touching][:, 0]).max() > 0.05  # some of them on the edge itself


def test_a_ramp_is_a_turned_floor_and_a_mesh_is_its_formula() -> None:
    """Short form of `benchmarks/prosthesis/grounds.py`: damping and friction along a known motion."""
    keel = vsf_foot().at(0.1)
    time, poses = moving(12)
    level = Stance(time, poses, pose_rate(time, poses))
    uphill, s, c = turned(level, SLOPE), np.sin(SLOPE), np.cos(SLOPE)
    floor = keel.solve(poses, HalfSpace(), rate=level.rate, time=time)
    gravity = (9.80665 * s, -9.80665 * c, 0.0)
    given = {"rate": uphill.rate, "time": time, "gravity": gravity}
    ramp = keel.solve(uphill.poses, HalfSpace(normal=(-s, c, 0.0)), **given)
    size = np.abs(floor.force).max()
    assert size > 300.0
    np.testing.assert_allclose(Rotation.from_euler("z", -SLOPE).apply(ramp.force), floor.force, atol=1e-9 * size)
    mesh = keel.solve(uphill.poses, strip(2.0 * np.array([[-c, -s], [c, s]])), **given)
    np.testing.assert_allclose(mesh.force, ramp.force, atol=1e-9 * size)
    steps = Stairs((0.19,), (-0.15, 0.0))
    sheet = strip(np.array([[-2.0, -0.15], [0.19, -0.15], [0.19, 0.0], [2.0, 0.0]]))
    both = [keel.solve(poses, ground, rate=level.rate, time=time) for ground in (steps, sheet)]
    assert np.abs(both[0].force - floor.force).max() > 0.05 * size
    np.testing.assert_allclose(both[1].force, both[0].force, atol=1e-7 * size)
