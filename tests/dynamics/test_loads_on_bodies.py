"""Measured loads on bodies, against numbers by hand."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.multibody.joint import prismatic
from geocontact.data.multibody.model import GROUND, Body, Multibody
from geocontact.data.wrench import Wrench
from geocontact.dynamics.loads_on_bodies import (
    added,
    farthest_line,
    from_bodies,
    misplaced_loads,
    without_torque,
    without_unloaded,
    zero_unloaded,
)

X, Y, Z = np.eye(3)


def upwards(sizes: list[float], point: np.ndarray, torque: float = 0.0) -> Wrench:
    """Forces along y through a point, with a torque about y."""
    force = np.outer(sizes, Y)
    return Wrench(force, np.tile(torque * Y, (len(sizes), 1)), np.tile(point, (len(sizes), 1)), "ground")


def test_a_small_force_is_none_and_its_point_may_be_missing() -> None:
    """20 N at 2 m along x have 40 N m about z; 5 N, below 10, have no place."""
    wrench = upwards([20.0, 5.0, 0.0], 2.0 * X, 3.0)
    wrench.origin[1:] = np.nan
    found = without_unloaded(wrench, 10.0)
    np.testing.assert_allclose(found.force, [20.0 * Y, 0.0 * Y, 0.0 * Y])
    np.testing.assert_allclose(found.moment, [40.0 * Z + 3.0 * Y, 0.0 * Y, 0.0 * Y])
    assert np.isnan(without_unloaded(wrench, 1.0).moment[1]).any(), "a loaded sample needs its point"
    np.testing.assert_array_equal(without_unloaded(without_torque(wrench), 10.0).moment[0], 40.0 * Z)


def test_a_missing_force_is_not_small() -> None:
    assert np.isnan(zero_unloaded(upwards([np.nan, 1.0], X), 10.0).force[0, 1])


def test_two_loads_on_a_body_add_up_about_one_point() -> None:
    """10 N at 1 m and 20 N at 3 m along x: 30 N and, about 1 m, 40 N m about z."""
    found = added(upwards([10.0], X), upwards([20.0], 3.0 * X))
    np.testing.assert_allclose(found.force, [30.0 * Y])
    np.testing.assert_allclose(found.moment, [40.0 * Z])


def test_a_load_that_is_expressed_in_bodies_turns_and_moves_with_them() -> None:
    """A force along y in a body a quarter turn about z points along -x; its point, 1 m up a body that is 2 m high."""
    time = np.array([0.0, 1.0])
    wrench = Wrench(np.array([0.0 * Y, 10.0 * Y]), np.array([Z, Z]), np.array([Y, Y]), "body")
    turned = RigidTransform.from_rotation(Rotation.from_euler("z", [90.0], degrees=True))
    raised = RigidTransform.from_translation(2.0 * Y[None])
    found = from_bodies(time, wrench, np.array([0.5]), turned, raised, "ground")
    np.testing.assert_allclose(found.force, [-5.0 * X], atol=1e-14)
    np.testing.assert_allclose(found.moment, [(1.0 + 15.0) * Z], atol=1e-14)
    still = from_bodies(time, wrench, np.array([0.5]), None, None, "ground")
    np.testing.assert_allclose(still.force, [5.0 * Y])
    np.testing.assert_allclose(still.moment, [Z])
    assert still.frame == "ground" and not still.origin.any()


def test_the_farthest_line_is_that_of_the_largest_arm() -> None:
    """Lines 0.3 and 1.2 m beside the body; the one without a force does not count."""
    points = np.array([0.3 * X, 1.2 * X, 9.0 * X])
    wrench = Wrench(np.outer([800.0, 3.0, 0.0], Y), np.zeros((3, 3)), points, "ground")
    line = farthest_line(wrench, np.zeros((3, 3)))
    assert line is not None
    assert (line.distance, line.force) == (pytest.approx(1.2), pytest.approx(3.0))
    assert farthest_line(upwards([0.0, 0.0], X), np.zeros((2, 3))) is None


def test_loads_under_the_other_foot_are_misplaced() -> None:
    """Feet 0.1 and 0.5 m along x, each 1 m high, which does not count; one load that is exchanged hides the other's."""
    bodies = tuple(Body(name, 1.0, np.zeros(3), np.zeros((3, 3))) for name in ("left", "right"))
    joints = tuple(prismatic(f"{b.name}_x", GROUND, b.name, X, RigidTransform.from_translation(Y)) for b in bodies)
    model = Multibody("two feet", bodies, joints, (), -9.81 * Y)
    values = np.tile([0.1, 0.5], (3, 1))
    under = {"left": upwards([700.0] * 3, 0.12 * X), "right": upwards([700.0] * 3, 0.46 * X)}
    assert misplaced_loads(model, values, under) == []
    found = misplaced_loads(model, values, {"left": under["right"], "right": under["left"]})
    assert [(one.body, one.nearest) for one in found] == [("left", "right"), ("right", "left")]
    assert (found[0].distance, found[0].nearest_distance) == (pytest.approx(0.36), pytest.approx(0.04))
    assert misplaced_loads(model, values, {"left": upwards([9.0] * 3, 0.46 * X), "right": under["right"]}) == []
