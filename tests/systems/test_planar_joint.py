"""The planar joint against its own geometry drawn with lines and circles, the elbow, and closed forms of its drift."""

from __future__ import annotations

from contextlib import nullcontext
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.axis_misalignment.axis_drift import STILL, AxisDrift, from_instant_centre, polynomial, table
from geocontact.axis_misalignment.explicit import POLE_SHARE, Offsets, deflect, require_no_pole
from geocontact.axis_misalignment.planar_joint import FOLD, LOST, POLE, SOUND, PlanarJoint, extremes_of, grid

TURN = np.radians(120.0)
WANDERS = polynomial((0.002, -0.008, 0.003), (-0.001, 0.005, 0.0, -0.001))
offsets = st.floats(-0.08, 0.08)


def crossing(p: np.ndarray, u: np.ndarray, q: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Where the lines p + s u and q + t v meet."""
    s, _ = np.linalg.solve(np.column_stack([u, -v]), q - p)
    return p + s * u


def drawn(tip: np.ndarray, centre: np.ndarray, straight: float, z: float) -> float:
    """How far the attachment is from where it was strapped on, along the limb from `centre` to `tip`; hinge at 0.

    The attachment stands on the link's normal through the tip, on the parallel of the limb behind it at distance z.
    """
    along = (tip - centre) / np.linalg.norm(tip - centre)
    front = np.array([along[1], -along[0]])
    link = tip / np.linalg.norm(tip)
    there = crossing(tip, np.array([link[1], -link[0]]), centre - z * front, along)
    return straight - float((there - centre) @ along)


def strapped(centre: np.ndarray, l: float) -> float:
    """Distance from `centre` of the tip where the limb is straight."""
    return float(np.sqrt(l**2 - centre[0] ** 2) - centre[1])


@given(offsets, offsets, st.floats(0.1, 0.4), st.floats(-0.15, 0.15))
def test_it_is_the_elbow_where_the_axis_stays(x: float, y: float, l: float, z: float) -> None:
    if np.hypot(x, y) > 0.95 * l:
        return
    beta = np.linspace(-0.3, 2.4, 28)
    elbow = deflect(beta, np.zeros(28), np.array([l, z, x, y, 0.0, 0.0, 0.0, 0.0, 1.0, 1.0]))[0]
    np.testing.assert_allclose(PlanarJoint(l, z, x, y).deflection(beta), elbow, rtol=0.0, atol=1e-14)


@given(offsets, offsets, st.floats(-0.1, 0.13), st.booleans())
def test_it_is_its_geometry(x: float, y: float, z: float, wanders: bool) -> None:
    """Over the exoskeleton's angle: the limb's point is known, and so is the tip."""
    l, drift = 0.25, WANDERS if wanders else STILL
    beta = np.linspace(-0.2, 2.3, 11)
    where = [np.array([x + dx, -(y + dy)]) for dx, dy in drift.at(beta)]
    first = 0.0
    for _ in range(60):  # the angle at which the limb is straight
        dx, dy = drift.at(np.array([first]))[0]
        first = np.arcsin((x + dx) / l)
    straight = strapped(np.array([x + dx, -(y + dy)]), l)
    want = [drawn(l * np.array([np.sin(b), np.cos(b)]), o, straight, z) for b, o in zip(beta, where, strict=True)]
    got = PlanarJoint(l, z, x, y, drift).deflection(beta)
    np.testing.assert_allclose(got, want, rtol=0.0, atol=1e-12)


@given(offsets, offsets, st.floats(-0.1, 0.13))
def test_a_drift_over_the_joints_own_angle(x: float, y: float, z: float) -> None:
    """The limb is drawn first; the exoskeleton's angle is that of where its line meets the circle of the tip."""
    l, drift = 0.25, replace(WANDERS, over_joint=True)
    alpha = np.linspace(-0.2, 2.2, 9)
    beta, want = np.empty(9), np.empty(9)
    dx, dy = drift.at(np.zeros(1))[0]
    straight = strapped(np.array([x + dx, -(y + dy)]), l)
    for k, a in enumerate(alpha):
        dx, dy = drift.at(np.array([a]))[0]
        o, u = np.array([x + dx, -(y + dy)]), np.array([np.sin(a), np.cos(a)])
        reach = -(o @ u) + np.sqrt((o @ u) ** 2 - o @ o + l**2)
        tip = o + reach * u
        beta[k], want[k] = np.arctan2(tip[0], tip[1]), drawn(tip, o, straight, z)
    got = PlanarJoint(l, z, x, y, drift).deflection(beta)
    np.testing.assert_allclose(got, want, rtol=0.0, atol=1e-12)


def test_a_still_instant_centre_is_a_hinge() -> None:
    alpha = np.linspace(-0.2, 2.0, 12)
    drift = from_instant_centre(alpha, np.full(12, 0.02), np.full(12, -0.03))
    np.testing.assert_allclose(drift.at(alpha), np.tile([0.02, -0.03], (12, 1)), atol=1e-15)
    beta = np.linspace(0.0, 1.8, 7)
    want = PlanarJoint(0.3, 0.1, 0.02, -0.03).deflection(beta)
    np.testing.assert_allclose(PlanarJoint(0.3, 0.1, 0.0, 0.0, drift).deflection(beta), want, atol=1e-14)


def test_a_limb_that_rolls_has_a_point_on_a_cycloid() -> None:
    """The instant centre of a wheel of radius r that rolls along x is at r α."""
    r, alpha = 0.03, np.linspace(-0.5, 2.5, 31)
    drift = from_instant_centre(alpha, r * alpha, np.zeros(31))
    cycloid = np.column_stack([r * (alpha - np.sin(alpha)), r * (np.cos(alpha) - 1.0)])
    np.testing.assert_allclose(drift.at(alpha), cycloid, rtol=0.0, atol=1e-11)
    assert drift.over_joint


def test_an_instant_centre_needs_the_straight_joint() -> None:
    with pytest.raises(ValueError, match="straight joint"):
        from_instant_centre(np.linspace(0.1, 1.0, 5), np.zeros(5), np.zeros(5))


def test_a_table_of_a_cubic_is_the_polynomial() -> None:
    beta = np.linspace(-0.2, 2.2, 7)
    told = table(beta, *WANDERS.at(beta).T)
    between = np.linspace(-0.2, 2.2, 100)
    np.testing.assert_allclose(told.at(between), WANDERS.at(between), rtol=0.0, atol=1e-14)
    np.testing.assert_allclose(told.at(np.array([-9.0, 9.0])), told.at(beta[[0, -1]]), atol=1e-17)
    powers = 0.002 - 0.008 * between + 0.003 * between**2
    np.testing.assert_allclose(WANDERS.at(between)[:, 0], powers, rtol=0.0, atol=1e-14)


@pytest.mark.parametrize(("angles", "said"), [([0.0, 1.0, 2.0], "3 rows"), ([0.0, 1.0, 1.0, 2.0], "do not rise")])
def test_a_table_that_is_none(angles: list[float], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        table(np.array(angles), np.zeros(len(angles)), np.zeros(len(angles)))


@pytest.mark.parametrize("drift", [STILL, WANDERS, replace(WANDERS, over_joint=True)], ids=["still", "exo", "joint"])
def test_extremes_converge_at_fourth_order_from_inside(drift: AxisDrift) -> None:
    rng = np.random.default_rng(11)
    joints = np.column_stack([np.full(300, 0.17), np.full(300, 0.12), rng.uniform(-0.06, 0.06, (300, 2))])
    true = extremes_of(grid(0.0, TURN, np.radians(0.05)), joints, drift)[0]
    steps = np.radians([8.0, 4.0, 2.0, 1.0])
    inside = [(extremes_of(grid(0.0, TURN, h), joints, drift)[0] - true) * [1.0, -1.0] for h in steps]
    errors = [float(np.sqrt(np.mean(each**2))) for each in inside]
    order = np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert 3.6 < order < 4.6, f"observed order {order:.2f}, errors {errors}"
    assert min(each.min() for each in inside) > -1e-15, "an extreme is overstated"
    assert inside[2].max() < 1e-8  # m, at 2 degrees


@given(offsets, offsets, st.floats(0.2, 2.5))
def test_extremes_hold_every_angle_and_are_taken_on(x: float, y: float, stop: float) -> None:
    joint = PlanarJoint(0.17, 0.1, x, y, WANDERS)
    ends, where = joint.extremes(0.0, stop)
    course = joint.deflection(np.linspace(0.0, stop, 400))
    assert ends[0] <= course.min() + 1e-7 and ends[1] >= course.max() - 1e-7
    np.testing.assert_allclose(joint.deflection(where), ends, rtol=0.0, atol=1e-15)


@given(st.floats(-0.4, 0.4), st.floats(-0.4, 0.4))
def test_a_pole_is_found_wherever_it_is(x: float, y: float) -> None:
    """l + y cos β - x sin β = l + r cos(β + φ) has its least value at β = π - φ or at an end."""
    l = 0.17
    r, phase = np.hypot(x, y), np.arctan2(x, y)
    lowest = [b for b in (np.pi - phase + 2.0 * np.pi * np.arange(-2, 3)) if 0.0 <= b <= TURN]
    bottom = min(l + r * np.cos(b + phase) for b in [0.0, TURN, *lowest])
    if abs(bottom - POLE_SHARE * l) < 1e-6 or abs(abs(x) - l) < 1e-9:
        return
    (fate,) = extremes_of(grid(0.0, TURN), np.array([[l, 0.1, x, y]]), STILL)[2]
    assert fate == (FOLD if abs(x) > l else POLE if bottom < POLE_SHARE * l else SOUND)


def test_a_pole_is_where_the_elbows_model_has_one() -> None:
    """So near that its denominator is half a thousandth of the link, and twice as far."""
    beta = np.linspace(0.0, np.pi, 181)
    for share, is_pole in ((0.5e-3, True), (2e-3, False)):
        elbow = Offsets(l=0.169, z=0.1, x=0.0, y=0.169 * (1.0 - share))
        joint = PlanarJoint(elbow.l, elbow.z, elbow.x, elbow.y)
        with pytest.raises(ValueError, match="tan γ") if is_pole else nullcontext():
            require_no_pole(beta, elbow)
        with pytest.raises(ValueError, match="tan γ has a pole") if is_pole else nullcontext():
            joint.deflection(beta)
        assert (extremes_of(beta, joint.numbers, joint.drift)[2][0] == POLE) == is_pole


def test_what_has_no_deflection_says_why() -> None:
    beta = np.linspace(0.0, 2.0, 5)
    with pytest.raises(ValueError, match=r"x = 180 mm.*straight at no angle"):
        PlanarJoint(0.17, 0.1, 0.18, 0.0).deflection(beta)
    with pytest.raises(ValueError, match=r"y = 180 mm: tan γ has a pole.*at 180 deg"):
        PlanarJoint(0.17, 0.1, 0.0, 0.18).extremes(0.0, np.pi)
    between = PlanarJoint(0.17, 0.1, 0.0, 0.169847)  # what counts as pole lies between two angles of the grid
    with pytest.raises(ValueError, match="between two angles"):
        between.extremes(np.pi - np.radians(3.0), np.pi + np.radians(5.0))
    fast = replace(polynomial((0.0, 0.3), ()), over_joint=True)
    with pytest.raises(ValueError, match="drifts so fast"):
        PlanarJoint(0.17, 0.1, 0.0, 0.05, fast).deflection(beta)
    assert extremes_of(grid(0.0, 2.0), np.array([[0.17, 0.1, 0.0, 0.05]]), fast)[2][0] == LOST
