"""A simulated stance: momentum, and what its numbers are when nothing is simulated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import cumulative_trapezoid
from scipy.spatial.transform import RigidTransform, Rotation

from benchmarks.prosthesis.soles import static_share
from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import GRAVITY, whole_tree
from geocontact.below_knee_prosthesis.simulate import Stance, share_of_foot, simulate_stance
from geocontact.dynamics.recorded_inputs import recorded_inputs
from geocontact.geometry.shapes import HalfSpace
from meshes.gait_course import course
from meshes.gait_persons import PARTICIPANTS, true_leg

FULCRUM, BELOW = 0.1174, 0.03


@pytest.fixture(scope="module")
def landing() -> Stance:
    """From before touch-down into the loading of a person of 77 kg."""
    leg = true_leg(PARTICIPANTS[0], BELOW)
    one = course(leg, vsf_foot(), FULCRUM, 0.72)
    return simulate_stance(one.motion, vsf_foot(), FULCRUM, one.push, (-0.06, 0.16), tolerance=3e-5, machine_code=False)


@pytest.mark.slow
def test_momentum_is_what_the_forces_leave(landing: Stance) -> None:
    """Of the whole tree's mass centre: the simulation knows only the tree cut at the socket."""
    s, motion = landing, landing.motion
    recorded = recorded_inputs(motion.time, motion.values).at(s.time)
    recorded[:, 3:5] = s.found.q[:, :2]
    whole = whole_tree(motion.leg, s.foot.keel)
    assert whole.mass == pytest.approx(77.3, rel=1e-12)
    centre = whole.mass_centre(np.hstack([recorded, s.found.q[:, 2:]]))
    speed = np.gradient(centre, s.time, axis=0, edge_order=2)
    push = recorded_inputs(motion.time, s.push.at(motion.time)).at(s.time)
    acting = s.force + push - np.array([0.0, whole.mass * GRAVITY, 0.0])
    gained = whole.mass * (speed - speed[0])
    given = cumulative_trapezoid(acting, s.time, axis=0, initial=0.0)
    assert s.force[:, 1].max() > 0.8 * whole.mass * GRAVITY
    np.testing.assert_allclose(gained[5:-5, :2], given[5:-5, :2], atol=0.6)  # of about 100 N s


@pytest.mark.slow
def test_force_is_within_a_hundredth_of_body_weight_of_a_finer_tolerance(landing: Stance) -> None:
    """Short form of `benchmarks/prosthesis/stance.py`, at touch-down, where steps are hardest."""
    s = landing
    fine = simulate_stance(
        s.motion, s.foot, s.fulcrum, s.push, (s.time[0], s.time[-1]), tolerance=1e-6, machine_code=False
    )
    off = np.linalg.norm(fine.force - s.force, axis=1) / (77.3 * GRAVITY)
    assert off.max() < 0.01


@pytest.mark.slow
def test_friction_in_the_keel_takes_its_share_of_what_is_stored(landing: Stance) -> None:
    """While the heel is loaded only: 0.15 of the energy of the springs, and no damper beside it."""
    usual, s = vsf_foot(), landing
    keel = replace(usual.keel, hysteresis=0.15, retardation=0.0)
    foot = replace(usual, keel=keel)
    given = s.motion, foot, s.fulcrum, s.push, (s.time[0], s.time[-1])
    rubs = simulate_stance(*given, tolerance=3e-4, machine_code=False)
    assert np.abs(rubs.found.z).max() <= 1.0 + 1e-6
    assert np.diff(rubs.lost).min() > -1e-4
    assert rubs.lost[-1] == pytest.approx(0.15 * rubs.stored.max(), rel=0.1)


def test_a_person_who_stands_is_carried() -> None:
    """Short form of `benchmarks/prosthesis/soles.py`: 6 s from rest, half of the weight on the other foot."""
    off, slid, _ = static_share(1, "low", lasting=6.0, machine_code=False)
    assert abs(off) < 1e-3  # the study's, of body weight
    assert slid < 2e-3


@pytest.mark.slow
def test_a_person_who_stands_on_a_slope_is_carried_uphill_of_it() -> None:
    """The ground's force stays upright, half of the weight; the foot keeps to the slope and creeps down it."""
    slope = HalfSpace(normal=(-np.sin(0.06), np.cos(0.06), 0.0))
    off, slid, _ = static_share(1, "low", lasting=3.0, machine_code=False, ground=slope)
    assert abs(off) < 5e-3
    assert 1e-3 < slid < 10e-3


def test_share_of_foot_turns_with_the_foot() -> None:
    turn = Rotation.from_euler("yz", [0.3, -0.5])
    poses = RigidTransform.from_components(np.array([[0.2, 0.05, -0.1]]), Rotation.concatenate([turn]))
    point = poses.apply(np.array([0.75 * 0.229, -0.03, 0.02]))
    assert share_of_foot(poses, 0.229, point)[0] == pytest.approx(0.75, rel=1e-12)
