"""A stance as that of the person's own side: signs of a left leg's coordinates, and where the ground pushes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geocontact.below_knee_prosthesis.leg_tree import RECORDED
from geocontact.below_knee_prosthesis.own_side import coordinates_of_side, ground_reaction
from tests.below_knee_prosthesis.stances import a_stance

TIME = np.arange(0.1, 0.3, 0.002)


def test_a_left_leg_has_the_laboratory_s_signs_and_its_own_angles() -> None:
    """A mirror image turns the pelvis' rotation and list round, and its place across; a leg's angles mean the same."""
    stance = a_stance(TIME)
    q = stance.found.q + np.linspace(0.1, 0.2, stance.found.q.shape[1])
    stance = replace(stance, found=replace(stance.found, q=q))
    right, left = (coordinates_of_side(stance, side) for side in ("right", "left"))
    assert left.names[:6] == RECORDED[:6] and left.names[6:8] == ("hip_flexion_l", "hip_adduction_l")
    sign = np.array([-1.0 if name in ("pelvis_rotation", "pelvis_list", "pelvis_tz") else 1.0 for name in left.names])
    np.testing.assert_array_equal(left.values, sign * right.values)
    of = dict(zip(right.names, right.values.T, strict=True))
    np.testing.assert_array_equal(of["pelvis_ty"], q[:, 1])  # found, not recorded
    np.testing.assert_array_equal(of["socket_tx_r"], q[:, 5])
    np.testing.assert_allclose(of["knee_flexion_r"], stance.motion.at(TIME)[:, 9])


def test_angles_are_in_degrees_and_lengths_in_metres() -> None:
    found = coordinates_of_side(a_stance(TIME), "right")
    long = [name for name, is_long in zip(found.names, found.lengths, strict=True) if is_long]
    assert long == ["pelvis_tx", "pelvis_ty", "pelvis_tz", "socket_tx_r", "socket_ty_r", "socket_tz_r"]
    factor = np.where(found.lengths, 1.0, 180.0 / np.pi)
    np.testing.assert_allclose(found.in_degrees, factor * found.values, rtol=1e-14)


def test_the_ground_pushes_at_the_centre_of_pressure_else_below_the_heel() -> None:
    force = np.zeros((len(TIME), 3))
    force[:50] = [30.0, 700.0, 20.0]
    stance = a_stance(TIME, force)
    pushed, place = ground_reaction(stance, "left")
    np.testing.assert_allclose(pushed, force * [1.0, 1.0, -1.0], atol=1e-9)
    np.testing.assert_allclose(place[:50], np.tile([0.1, 0.0, 0.0], (50, 1)), atol=1e-12)
    np.testing.assert_allclose(place[50:], 0.0, atol=1e-12)
