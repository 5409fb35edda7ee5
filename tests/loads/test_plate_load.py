"""What a force plate shows of a foot at the frames of a motion."""

from __future__ import annotations

import numpy as np

from geocontact.data.wrench import Wrench
from geocontact.loads.plate_load import load_on_plate, same_way_up

UP = np.array([0.0, 1.0, 0.0])


def test_force_centre_and_free_moment_by_hand() -> None:
    """100 N up and 10 N ahead at (0.2, 0.03, 0.1) with 3 N m about the normal; then 5 N, below the gate."""
    place, force, free = np.array([0.2, 0.03, 0.1]), np.array([10.0, 100.0, 0.0]), 3.0
    forces = np.array([force, [0.0, 5.0, 0.0]])
    moments = np.array([np.cross(place, force) + free * UP, [0.0, 0.0, 1.0]])
    there = np.array([4, 5])
    shown = load_on_plate(
        there, Wrench(forces, moments, np.zeros((2, 3)), "ground"), np.array([9.0, 0.03, 9.0]), UP, 20.0
    )
    np.testing.assert_array_equal(shown.frames, there)
    np.testing.assert_array_equal(shown.force, forces)
    np.testing.assert_allclose(shown.centre[0], place, atol=1e-15)
    np.testing.assert_allclose(shown.free_moment[0], free, rtol=1e-13)
    assert np.isnan(shown.centre[1]).all() and np.isnan(shown.free_moment[1])


def test_a_ground_that_is_the_plates_own_is_the_same_way_up() -> None:
    unknown = np.full(3, np.nan)
    for angle, same in ((0.0, True), (45.0, True), (46.0, False), (90.0, False), (180.0, False)):
        turned = np.array([np.sin(np.radians(angle)), np.cos(np.radians(angle)), 0.0])
        assert same_way_up(np.array([unknown, turned, turned]), UP) == same
    assert same_way_up(np.array([unknown]), UP), "nothing is known of a foot in the air"
