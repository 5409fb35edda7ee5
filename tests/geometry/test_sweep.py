"""Turning about an axis: Rodrigues' formula, what stays in place, which angles are visited."""

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st

from geocontact.geometry.sweep import Axis, sweep

COORDINATE = st.floats(-2.0, 2.0)
PLACE = st.tuples(COORDINATE, COORDINATE, COORDINATE)
ANGLE = st.floats(-7.0, 7.0)


def length(vector):
    return float(np.linalg.norm(vector))


def rodrigues(axis, angle, point):
    """p + cos v + sin k x v + (1 - cos)(k.v) k, with v from the axis's point and k along it."""
    k = np.array(axis.direction) / length(axis.direction)
    v = np.asarray(point) - axis.point
    return axis.point + np.cos(angle) * v + np.sin(angle) * np.cross(k, v) + (1 - np.cos(angle)) * (k @ v) * k


@given(PLACE, PLACE, ANGLE, PLACE)
def test_turned_is_rodrigues_formula(point, direction, angle, place):
    assume(length(direction) > 1e-3)
    axis = Axis(point, direction)
    found = axis.turned(np.array([angle])).apply(place)
    np.testing.assert_allclose(found.reshape(3), rodrigues(axis, angle, place), atol=1e-13)


@given(PLACE, PLACE, ANGLE, ANGLE)
def test_turns_about_one_axis_add_up(point, direction, first, second):
    assume(length(direction) > 1e-3)
    one, two, both = Axis(point, direction).turned(np.array([first, second, first + second]))
    np.testing.assert_allclose((one * two).as_matrix(), both.as_matrix(), atol=1e-12)


@given(PLACE, PLACE, ANGLE, st.floats(-5, 5), st.floats(1e-3, 1e3))
def test_only_the_line_and_its_sense_matter(point, direction, angle, along, factor):
    """Another point of the line, another length of the direction; the opposite direction turns back."""
    assume(length(direction) > 1e-3)
    angles = np.array([angle])
    turned = Axis(point, direction).turned(angles).as_matrix()
    slid = Axis(tuple(np.add(point, along * np.array(direction)).tolist()), direction).turned(angles).as_matrix()
    scaled = Axis(point, tuple((factor * np.array(direction)).tolist())).turned(angles).as_matrix()
    back = Axis(point, tuple((-np.array(direction)).tolist())).turned(-angles).as_matrix()
    for other in (slid, scaled, back):
        np.testing.assert_allclose(other, turned, atol=1e-12)


def test_a_quarter_turn_is_right_handed():
    """About the vertical through (1, 0, 0): the origin goes from behind to the right hand's side."""
    turned = Axis((1.0, 0.0, 0.0), (0.0, 0.0, 5.0)).turned(np.array([np.pi / 2]))
    np.testing.assert_allclose(turned.apply([2.0, 0.0, 3.0]).reshape(3), [1.0, 1.0, 3.0], atol=1e-15)


VISITED = [
    ((0.0, 90.0, 30.0), [0.0, 30.0, 60.0, 90.0]),
    ((90.0, 0.0, -45.0), [90.0, 45.0, 0.0]),
    ((-10.0, 10.0, 5.0), [-10.0, -5.0, 0.0, 5.0, 10.0]),
    ((0.0, 1.0, 0.3), [0.0, 0.3, 0.6, 0.9]),
    ((5.0, 5.0, 1.0), [5.0]),
    ((0.0, 0.7, 0.1), [0.1 * k for k in range(8)]),
]


@pytest.mark.parametrize(("given_range", "angles"), VISITED)
def test_angles_visited(given_range, angles):
    """Up to the stop, which is there when the steps meet it in spite of rounding; one frame a second."""
    axis = Axis((0.1, 0.2, 0.3), (1.0, -2.0, 0.5))
    motion = sweep(axis, *np.radians(given_range).tolist(), name="flexion")
    name, angle = motion.coordinate
    assert (name, motion.time_unit, motion.source) == ("flexion", "s", "sweep of flexion")
    np.testing.assert_allclose(np.degrees(angle), angles, atol=1e-12)
    np.testing.assert_array_equal(motion.time, np.arange(len(angles)))
    np.testing.assert_allclose(motion.poses.as_matrix(), axis.turned(np.radians(angles)).as_matrix(), atol=1e-14)


@given(st.integers(1, 2000), st.sampled_from([0.1, 0.25, 0.5, 1.0, 1 / 3, -0.7]))
def test_steps_that_meet_the_stop_include_it(count, step):
    step = float(np.radians(step))
    motion = sweep(Axis((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), 0.1, 0.1 + count * step, step)
    assert len(motion) == count + 1


def test_the_bodies_coincide_at_angle_zero():
    motion = sweep(Axis((0.4, -0.1, 0.2), (1.0, 1.0, 1.0)), -0.2, 0.2, 0.1)
    np.testing.assert_allclose(motion.poses[2].as_matrix(), np.eye(4), atol=1e-16)


@pytest.mark.parametrize(
    "bad",
    [(0.0, 1.0, 0.0), (0.0, 1.0, -0.1), (1.0, 0.0, 0.1), (np.nan, 1.0, 0.1), (0.0, np.inf, 0.1), (0.0, 1.0, np.nan)],
)
def test_sweeps_that_never_arrive_are_refused(bad):
    with pytest.raises(ValueError, match="cannot go in steps of"):
        sweep(Axis((0.0, 0.0, 0.0), (0.0, 0.0, 1.0)), *bad)


@pytest.mark.parametrize(
    ("point", "direction"),
    [
        ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
        ((0.0, 0.0, 0.0), (0.0, np.nan, 1.0)),
        ((0.0, np.inf, 0.0), (0.0, 0.0, 1.0)),
    ],
)
def test_axes_that_are_none_are_refused(point, direction):
    with pytest.raises(ValueError, match="an axis needs a finite point and a direction of some length"):
        Axis(point, direction)
