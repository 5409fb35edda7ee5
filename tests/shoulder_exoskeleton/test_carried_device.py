"""Weight and inertia that a person carries, against momenta counted by hand from the angles."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.shoulder_exoskeleton.arm_motion import Side
from geocontact.shoulder_exoskeleton.carried_device import forces_of_device, weight_and_inertia
from geocontact.shoulder_exoskeleton.device import lucy
from geocontact.shoulder_exoskeleton.simulate import simulate_arm
from tests.shoulder_exoskeleton.arms import FITTING, GRAVITY, lifted
from tests.shoulder_exoskeleton.device_by_hand import MASSES, weight_and_inertia_by_hand


@pytest.mark.parametrize("side", ["right", "left"])
def test_weight_and_inertia_are_those_of_the_momenta(side: Side) -> None:
    """Along a lift, m (g - a) and its moment by differences of 1 ms; the left arm is the mirror image."""
    s = simulate_arm(lifted(seconds=4.0, step=1e-3, side=side), lucy(), FITTING, 1.0, tolerance=1e-9)
    force, moment = weight_and_inertia(s)
    wanted, turned = weight_and_inertia_by_hand(s)
    inside = slice(5, -5)
    assert np.abs(wanted[inside] - MASSES.sum() * GRAVITY).max() > 1.0, "it is accelerated"
    assert np.percentile(np.abs(force - wanted)[inside], 99) < 0.02
    assert np.percentile(np.abs(moment - turned)[inside], 99) < 0.01


def test_at_rest_it_is_the_weight() -> None:
    """Closed form: 1.3 kg; no weight turns the arm about the upright first joint."""
    s = simulate_arm(lifted(seconds=4.0), lucy(), FITTING, 0.5)
    force, moment = weight_and_inertia(s)
    np.testing.assert_allclose(force[0], 1.3 * GRAVITY, atol=0.02)
    assert abs(moment[0, 2]) < 0.01


def test_arm_and_trunk_together_carry_the_weight_only() -> None:
    """The cuff acts on both, in opposite ways at one point; what is left is the device at its first joint."""
    s = simulate_arm(lifted(seconds=4.0), lucy(), FITTING, 0.5)
    found = forces_of_device(s)
    assert list(found) == ["cuff", "trunk", "device"] and np.abs(found["cuff"][0]).max() > 5.0
    force = sum(force for force, _, _ in found.values())
    moment = sum(np.cross(place, force) + own for force, place, own in found.values())
    np.testing.assert_allclose(force[0], 1.3 * GRAVITY, atol=0.02)
    carried, joint, own = found["device"]
    np.testing.assert_allclose(moment, np.cross(joint, carried) + own, atol=1e-9)
