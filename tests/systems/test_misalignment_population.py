"""Largest forces of many people, against each person's own course and against a closed form."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from geocontact.axis_misalignment.axis_drift import polynomial
from geocontact.axis_misalignment.compensation import Compensation
from geocontact.axis_misalignment.design import Exposure, peak_forces
from geocontact.axis_misalignment.planar_joint import FOLD, POLE, SOUND, STEP, PlanarJoint

STOP = np.radians(120.0)


def people(count: int, sd: float = 0.02, seed: int = 4) -> np.ndarray:
    rng = np.random.default_rng(seed)
    return np.column_stack([
        rng.uniform(100.0, 400.0, count), rng.uniform(0.15, 0.22, count), rng.uniform(0.0, 0.13, count),
        rng.normal(0.0, sd, (count, 2)),
    ])  # fmt: skip


@pytest.mark.parametrize("ends", [(0.0, 0.0), (-0.01, 0.02), (0.005, 0.02)])
def test_each_has_the_peak_of_its_course(ends: tuple[float, float]) -> None:
    drift = polynomial((0.0, -0.008), (0.0, 0.005))
    exposure = Exposure(0.0, STOP, *ends, drift)
    beta = np.linspace(0.0, STOP, 2001)
    drawn = people(60)
    peak, fate = peak_forces(drawn, exposure)
    assert (fate == SOUND).all()
    for (k, l, z, x, y), found in zip(drawn, peak, strict=True):
        course = Compensation(k, *ends).force(PlanarJoint(l, z, x, y, drift).deflection(beta))
        assert found == pytest.approx(np.abs(course).max(), abs=2e-5)


def test_the_order_of_people_and_what_others_are_do_not_matter() -> None:
    drawn, exposure = people(300), Exposure(0.0, STOP)
    peak = peak_forces(drawn, exposure)[0]
    turned = peak_forces(drawn[::-1], exposure)[0][::-1]
    np.testing.assert_array_equal(peak, turned)
    np.testing.assert_array_equal(peak[7], peak_forces(drawn[7:8], exposure)[0][0])


def test_small_offsets_along_y_have_a_closed_distribution() -> None:
    """d = y (1 - cos β) for z = 0: the largest |F| is k |y| (1 - cos 120°), half normal."""
    rng = np.random.default_rng(9)
    sd, count = 1e-6, 20_000
    drawn = np.column_stack(
        [np.full(count, 200.0), np.full(count, 0.2), np.zeros((count, 2)), rng.normal(0, sd, count)]
    )
    peak, _ = peak_forces(drawn, Exposure(0.0, STOP))
    np.testing.assert_allclose(peak, 200.0 * np.abs(drawn[:, 4]) * 1.5, rtol=1e-4, atol=1e-12)
    assert stats.kstest(peak, stats.halfnorm(scale=200.0 * sd * 1.5).cdf).pvalue > 1e-3


def test_poles_and_folds_are_beyond_every_force() -> None:
    drawn = np.array([
        [200.0, 0.1, 0.05, 0.01, 0.01], [200.0, 0.1, 0.05, 0.12, 0.0], [200.0, 0.1, 0.05, 0.09, -0.15],
    ])  # fmt: skip
    peak, fate = peak_forces(drawn, Exposure(0.0, STOP))
    assert fate.tolist() == [SOUND, FOLD, POLE]
    assert np.isfinite(peak).tolist() == [True, False, False] and (peak[1:] == np.inf).all()


def test_the_error_of_the_grid_is_small_and_falls() -> None:
    drawn, exposure = people(2000), Exposure(0.0, STOP)
    fine = peak_forces(drawn, exposure, STEP / 16)[0]
    errors = [fine - peak_forces(drawn, exposure, step)[0] for step in (4.0 * STEP, 2.0 * STEP, STEP)]
    assert min(each.min() for each in errors) > -1e-12, "a largest force is overstated"
    assert errors[2].max() < 1e-4 and errors[0].max() > 20.0 * errors[2].max()
