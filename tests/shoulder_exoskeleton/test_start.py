"""Where an arm is at the first frame: where it would be had it been raised from hanging, however it hung."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.shoulder_exoskeleton.arm_model import arm_model
from geocontact.shoulder_exoskeleton.arm_motion import ArmMotion
from geocontact.shoulder_exoskeleton.arm_numbers import adjusted_numbers
from geocontact.shoulder_exoskeleton.cuff_contact import arm_inputs
from geocontact.shoulder_exoskeleton.device import lucy
from geocontact.shoulder_exoskeleton.simulate import HANGING, PACE, TOLERANCE, elevation_of, raising, simulate_arm
from tests.shoulder_exoskeleton.arms import FITTING, lifted

LUCY, WEARER, REACH = lucy(), FITTING, 0.19


def part(motion: ArmMotion, first: float) -> ArmMotion:
    """From a time on [s]."""
    kept = motion.time >= first - 1e-9
    cut = {name: getattr(motion, name)[kept] for name in ("time", "interface", "shoulder", "elevation")}
    return replace(motion, **cut)


@pytest.mark.parametrize("first", [2.2, 3.0])
@pytest.mark.parametrize("passive", [(20.0, -30.0), (40.0, -60.0), (-10.0, 20.0), (50.0, -70.0)])
def test_however_it_hung_the_raised_arm_is_where_it_is_found(passive: tuple[float, float], first: float) -> None:
    """Four arbitrary passive starts of the whole lift, stepped from there, against the lift that begins held high.

    In the hold friction remembers the way: 0.24 degrees of the active joint, 0.73 of a passive one. Lowered again,
    nothing. With the equilibrium next to passive joints in the middle it was 53 and 91 degrees, and 53 lowered again.
    """
    motion = lifted()
    model, p = arm_model(LUCY), adjusted_numbers(LUCY, WEARER, 1.0)
    start = np.radians([*passive, np.degrees(motion.elevation[0])]), np.zeros(3), np.array([LUCY.peak_force])
    whole = model.stepper.simulate(start, motion.time, inputs=arm_inputs(motion), parameters=p, tolerance=TOLERANCE)
    found = simulate_arm(part(motion, first), LUCY, WEARER, 1.0)
    off = np.degrees(np.abs(found.angles - whole.q[-len(found.angles) :]))
    assert not found.out_of_cuff.any()
    assert off[:, 2].max() < 0.4 and off.max() < 1.2
    assert off[found.motion.time > 5.5].max() < 0.01


def test_an_arm_that_hangs_is_not_moved() -> None:
    motion = lifted()
    low = replace(motion, interface=motion.shoulder + np.array([0.01, -0.01, -0.2]))
    assert elevation_of(low) < HANGING and raising(low) is None


def test_the_way_up_ends_at_the_first_posture_without_a_jerk() -> None:
    """About the shoulder, in the arm's own plane, at most at `PACE`, from rest to rest."""
    motion = part(lifted(), 3.0)
    way = raising(motion)
    assert way is not None
    np.testing.assert_allclose(way.interface[-1], motion.interface[0], atol=1e-12)
    reach = way.interface - motion.shoulder[0]
    np.testing.assert_allclose(np.linalg.norm(reach, axis=1), REACH - 0.03, rtol=1e-9)
    normal = np.cross(reach[0], reach[-1])
    np.testing.assert_allclose(reach @ normal / np.linalg.norm(normal), 0.0, atol=1e-12)
    assert np.arccos(-reach[0, 2] / np.linalg.norm(reach[0])) == pytest.approx(HANGING, abs=1e-9)
    rate = np.gradient(way.elevation, way.time)
    assert rate.max() == pytest.approx(PACE, rel=0.01) and rate.min() > -1e-12
    assert abs(rate[0]) < 1e-2 and abs(rate[-1]) < 1e-9


def test_an_arm_straight_up_is_raised_in_the_plane_of_the_shoulder_blade() -> None:
    motion = lifted()
    up = replace(motion, interface=motion.shoulder + np.array([0.0, 0.0, 0.2]))
    way = raising(up)
    assert way is not None
    half = way.interface[np.argmin(np.abs(way.elevation - 0.5 * np.pi))] - motion.shoulder[0]
    assert np.degrees(np.arctan2(-half[0], -half[1])) == pytest.approx(30.0, abs=1e-6)


def test_a_device_that_cannot_hang_down_starts_at_its_lower_end() -> None:
    """Its elevation begins at 40 degrees: an arm at 115 is raised from there, not from 5 where nothing rests."""
    stiff = LUCY.having(elevation_lower=np.radians(40.0))
    motion = part(lifted(), 3.0)
    usual, found = (simulate_arm(motion, device, WEARER, 1.0) for device in (LUCY, stiff))
    assert np.degrees(np.abs(found.elevation - usual.elevation)[:80]).max() < 1.0
