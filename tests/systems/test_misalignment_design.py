"""Design of an exoskeleton beside a joint: closed forms for small offsets, homogeneity, and the source's findings."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.axis_misalignment.axis_drift import polynomial
from geocontact.axis_misalignment.compensation import Compensation
from geocontact.axis_misalignment.design import (
    DesignTask,
    boundary,
    disc,
    force_band,
    needed_stroke,
    offset_map,
    sensitivities,
)
from geocontact.axis_misalignment.planar_joint import FOLD, POLE

K, L, Z, X, Y = 222.43, 0.169, 0.127, 0.048, 0.059
"""The values identified in the source, one point of the line along which stiffness and lengths trade."""

RANGE = np.radians([0.0, 120.0])
LOCKED = DesignTask(L, Z, *RANGE, 5.0, Compensation(K))


def peak(task: DesignTask, x: float, y: float) -> float:
    return float(task.compensation.peak(task.extremes(np.array([[x, y]]))[0])[0])


@pytest.mark.parametrize("z", [0.0, 0.06, 0.127])
def test_small_limits_have_a_radius_in_closed_form(z: float) -> None:
    """d = x (sin β - z/l cos β) + y (1 - cos β - z/l sin β) to first order in the offsets."""
    beta, r = np.linspace(*RANGE, 20001), z / L
    steepest = np.hypot(np.sin(beta) - r * np.cos(beta), 1.0 - np.cos(beta) - r * np.sin(beta)).max()
    task = replace(LOCKED, distance=z, limit=1e-3)
    found = boundary(task, (0.0, 0.0), 1e-4)
    assert found.least * K / 1e-3 * steepest == pytest.approx(1.0, abs=2e-5)


def test_on_the_boundary_the_force_is_the_limit() -> None:
    found = boundary(LOCKED, (0.005, -0.004), 0.08)
    passed = found.distances < found.most
    assert passed.sum() > 0 and found.least == found.distances[passed].min()
    for angle, far in zip(found.angles[passed][::40], found.distances[passed][::40], strict=True):
        x, y = 0.005 + far * np.cos(angle), -0.004 + far * np.sin(angle)
        assert peak(LOCKED, x, y) == pytest.approx(5.0, rel=1e-9)
    inside = LOCKED.admissible(disc((0.005, -0.004), found.least * (1.0 - 1e-9)))
    assert inside.all()
    assert not LOCKED.admissible(disc((0.005, -0.004), found.least * 1.01)).all()
    assert not boundary(LOCKED, (X, Y), 0.08).distances.any(), "the centre itself is beyond the limit"


@pytest.mark.parametrize("ends", [(0.0, 0.0), (-0.02, 0.05), (0.01, 0.03)])
@pytest.mark.parametrize(("x", "y"), [(X, Y), (-0.03, 0.02), (0.02, -0.06)])
def test_elasticities_are_those_of_a_homogeneous_function(x: float, y: float, ends: tuple[float, float]) -> None:
    """F(k/s, s · lengths) = F: Euler's theorem."""
    told = sensitivities(replace(LOCKED, compensation=Compensation(K, *ends)), x, y)
    (stiffness,) = [one for one in told if one.name == "k"]
    lengths = [one for one in told if one.name != "k"]
    assert {one.name for one in lengths} >= {"x", "y", "l", "z"}
    for each in ("peak_elasticity", "rms_elasticity"):
        assert getattr(stiffness, each) == pytest.approx(1.0, abs=1e-8)
        assert sum(getattr(one, each) for one in lengths) == pytest.approx(1.0, abs=1e-6)


def test_slopes_are_those_of_the_largest_force() -> None:
    told = {one.name: one for one in sensitivities(LOCKED, X, Y)}
    step = 1e-4
    assert told["x"].peak_slope == pytest.approx((peak(LOCKED, X + step, Y) - peak(LOCKED, X - step, Y)) / (2 * step))
    longer, shorter = (replace(LOCKED, length=L + side * step) for side in (1.0, -1.0))
    assert told["l"].peak_slope == pytest.approx((peak(longer, X, Y) - peak(shorter, X, Y)) / (2 * step), rel=1e-5)


@pytest.mark.parametrize(("ends", "x", "y"), [((-1.0, 1.0), X, Y), ((0.0, 0.0), 0.0, 0.0)])
def test_without_force_there_is_no_sensitivity(ends: tuple[float, float], x: float, y: float) -> None:
    """Within the stroke, and at the kink of |F| where the axes meet."""
    told = sensitivities(replace(LOCKED, compensation=Compensation(K, *ends)), x, y)
    assert all(np.isnan([one.peak_elasticity, one.rms_elasticity, one.peak_slope, one.rms_slope]).all() for one in told)


@given(st.floats(-0.06, 0.06), st.floats(-0.06, 0.06), st.floats(-0.05, 0.05), st.floats(0.0, 0.08))
def test_peak_is_that_of_the_course(x: float, y: float, lower: float, stroke: float) -> None:
    task = replace(LOCKED, compensation=Compensation(K, lower, lower + stroke))
    course = task.compensation.force(task.joint(x, y).deflection(np.linspace(*RANGE, 2001)))
    assert peak(task, x, y) == pytest.approx(np.abs(course).max(), abs=1e-4)


def test_the_needed_stroke_is_just_enough() -> None:
    task = replace(LOCKED, drift=polynomial((0.0, -0.004), (0.0, 0.003)))
    needed = needed_stroke(task, (X, Y), 0.01)
    assert needed.length == pytest.approx(needed.largest - needed.least - 2.0 * 5.0 / K, rel=1e-12)
    offsets = disc((X, Y), 0.01)
    for lower, upper, keeps in (
        (needed.lower, needed.upper, True),
        (needed.lower + 1e-5, needed.upper, False),
        (needed.lower, needed.upper - 1e-5, False),
    ):
        with_it = replace(task, compensation=Compensation(K, lower, upper), limit=5.0 * (1.0 + 1e-12))
        assert with_it.admissible(offsets).all() == keeps
    free = replace(task, compensation=Compensation(K, needed.least, needed.largest))
    assert free.compensation.peak(free.extremes(offsets)[0]).max() == 0.0


def test_the_band_holds_the_forces_of_the_disc() -> None:
    beta = np.linspace(*RANGE, 25)
    low, high = force_band(LOCKED, (X, Y), 0.01, beta)
    for x, y in ((X, Y), (X + 0.01, Y), (X - 0.006, Y + 0.008)):
        force = K * LOCKED.joint(x, y).deflection(beta)
        assert (low <= force + 1e-3).all() and (force <= high + 1e-3).all()  # N; the rim between two rays
    assert low.min() == pytest.approx(K * needed_stroke(LOCKED, (X, Y), 0.01).least, abs=0.01)


def test_the_lower_stroke_end_must_be_further_decreased() -> None:
    """The source's finding: a joint at its lower end leaves a negative force until the deflection crosses zero."""
    unlocked = replace(LOCKED, compensation=Compensation(K, 0.0, 0.1))
    beta = np.radians(np.arange(0.0, 121.0))
    locked, free = (task.compensation.force(task.joint(X, Y).deflection(beta)) for task in (LOCKED, unlocked))
    crossing = int(np.argmax(locked > 0.0))
    assert 60 < crossing < 80  # source: about 67 degrees
    assert (free[:crossing] < 0.0).all() and (free[crossing:] == 0.0).all() and locked[-1] > 18.0
    needed = needed_stroke(unlocked, (X, Y), 0.0)
    decreased = replace(unlocked, compensation=Compensation(K, needed.least, 0.1))
    assert peak(unlocked, X, Y) == pytest.approx(-K * needed.least) and peak(decreased, X, Y) == 0.0
    assert needed.lower == pytest.approx(needed.least + 5.0 / K) and needed.lower < 0.0


def test_without_z_there_is_no_force_at_small_angles() -> None:
    """The source's other finding; d_lin is 0 where the limb is straight and of second order in x at angle 0."""
    straight = np.array([np.arcsin(X / L)])
    with_z, without = (LOCKED.joint(X, Y), replace(LOCKED, distance=0.0).joint(X, Y))
    assert without.deflection(straight)[0] == pytest.approx(0.0, abs=1e-15)
    assert with_z.deflection(straight)[0] == pytest.approx(-Z * X / np.sqrt(L**2 - X**2))
    at_zero = [replace(LOCKED, distance=0.0).joint(s * X, s * Y).deflection(np.zeros(1))[0] for s in (1e-2, 1e-3)]
    assert at_zero[0] / at_zero[1] == pytest.approx(100.0, rel=0.02)
    assert abs(K * without.deflection(np.zeros(1))[0]) < 0.4 * abs(K * with_z.deflection(np.zeros(1))[0])


def test_a_map_names_poles_and_folds() -> None:
    axis = np.array([-0.2, 0.0, 0.2])
    found = offset_map(LOCKED, axis, axis)
    assert found.offsets[:3].tolist() == [[-0.2, -0.2], [0.0, -0.2], [0.2, -0.2]]
    assert found.fate.tolist() == [FOLD, POLE, FOLD, FOLD, 0, FOLD, FOLD, 0, FOLD]
    assert np.isnan(found.peak[found.fate > 0]).all() and found.peak[4] < 1e-12
    with pytest.raises(ValueError, match="pole"):
        needed_stroke(LOCKED, (0.0, -0.1), 0.08)
