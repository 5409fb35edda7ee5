"""Friction of the keel at any rate: the same loop fast and slow, its work, and the tree beside the frames."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.dynamic import dynamic_keel
from geocontact.below_knee_prosthesis.keel.foot import VariableStiffnessFoot
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.resultant import pose_rate

FULCRUM, SHARE = 0.1, 0.15


def foot(hysteresis: float, joints: int = 8, friction: float = 0.0) -> VariableStiffnessFoot:
    """Without friction on the floor, damping of sole and keel: what is lost is lost in the keel's friction."""
    usual = vsf_foot(joints=joints)
    law, none = usual.law, np.zeros(len(usual.law.stiffness))
    keel = replace(usual.keel, hysteresis=hysteresis, friction=friction, presliding=0.02, retardation=0.0)
    return replace(usual, keel=keel, law=replace(law, damping=none, static=none, kinetic=none))


def pressed(lasting: float, samples: int) -> tuple[np.ndarray, RigidTransform]:
    """The forefoot goes down and up again."""
    share = np.linspace(0.0, 1.0, samples)
    height = 0.085 - 0.03 * np.sin(np.pi * share) ** 2
    turn = Rotation.from_euler("z", np.full((samples, 1), -0.25))
    return lasting * share, RigidTransform.from_components(np.column_stack([0.0 * height, height, 0.0 * height]), turn)


def force(one: VariableStiffnessFoot, lasting: float, samples: int = 201) -> np.ndarray:
    time, poses = pressed(lasting, samples)
    return one.at(FULCRUM).solve(poses, HalfSpace(), rate=pose_rate(time, poses), time=time).force[:, 1]


def test_the_loop_is_the_same_at_any_rate_and_its_work_that_of_the_share() -> None:
    """Loading and unloading differ by 2 share of the spring's moment; a viscous keel's loop goes with the rate."""
    slow, fast, elastic = force(foot(SHARE), 10.0), force(foot(SHARE), 0.1), force(foot(0.0), 1.0)
    assert elastic.max() > 300.0
    np.testing.assert_allclose(fast, slow, atol=1e-4 * slow.max())
    _, poses = pressed(1.0, 201)
    height = poses.translation[:, 1]
    loop, stored = -np.trapezoid(slow, height), -np.trapezoid(elastic[:101], height[:101])
    assert abs(np.trapezoid(elastic, height)) < 1e-3 * stored
    # the sole, in series, stores a part that is not lost
    assert 0.5 * 2.0 * SHARE * stored < loop < 2.0 * SHARE * stored


def test_friction_at_any_bend_widens_the_loop_evenly() -> None:
    """Twice the friction, twice the loop's width in the middle of the way, whatever the load there."""
    _, _poses = pressed(1.0, 201)
    widths = []
    for curvature in (0.1, 0.2):
        loop = force(foot(0.0, friction=curvature), 1.0)
        widths.append(loop[40:90] - loop[160:110:-1])
    assert widths[0].min() > 3.0
    np.testing.assert_allclose(widths[1][5:-5], 2.0 * widths[0][5:-5], rtol=0.1)


@pytest.mark.slow
def test_the_tree_has_the_same_loop_as_the_frames() -> None:
    one = foot(SHARE, joints=3, friction=0.05)
    one = replace(one, keel=replace(one.keel, retardation=1e-3))
    time, poses = pressed(0.4, 41)
    model = dynamic_keel(one.keel, one.sole, one.law, HalfSpace(), machine_code=False)
    moved = model.simulate(FULCRUM, time, poses, np.zeros(3), tolerance=1e-4)
    still = one.at(FULCRUM)
    there = still.at(moved.q, moved.u, poses, HalfSpace(), pose_rate(time, poses)).force[:, 1]
    frames = force(one, 0.4, 401)[::10]
    assert np.abs(force(foot(0.0, joints=3), 0.4, 401)[::10] - frames).max() > 0.1 * frames.max()
    np.testing.assert_allclose(there[2:-2], frames[2:-2], atol=0.02 * frames.max())


def test_refused() -> None:
    keel = vsf_foot().keel
    for share, curvature in ((-0.1, 0.05), (1.0, 0.05), (0.1, 0.0)):
        with pytest.raises(ValueError, match="hysteresis is a share"):
            replace(keel, hysteresis=share, presliding=curvature)
