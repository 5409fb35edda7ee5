"""Levenberg-Marquardt within bounds: closed forms, bounds that hold, agreement with another method."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import least_squares

from geocontact.identify.optimise.levenberg_marquardt import levenberg_marquardt

FAR = np.full(2, np.inf)


def rosenbrock(z: np.ndarray) -> np.ndarray:
    return np.array([10.0 * (z[1] - z[0] ** 2), 1.0 - z[0]])


def slopes(z: np.ndarray) -> np.ndarray:
    return np.array([[-20.0 * z[0], 10.0], [-1.0, 0.0]])


def test_a_line_is_found_in_closed_form() -> None:
    x = np.linspace(0.0, 1.0, 20)
    design, y = np.column_stack([np.ones(20), x]), 3.0 - 2.0 * x + 0.1 * np.cos(30.0 * x)
    found = levenberg_marquardt(lambda v: design @ v - y, lambda v: design, np.zeros(2), -FAR, FAR, np.ones(2))
    np.testing.assert_allclose(found.values, np.linalg.lstsq(design, y, rcond=None)[0], rtol=1e-9)
    assert found.converged


def test_a_curved_valley_is_followed_to_its_end() -> None:
    found = levenberg_marquardt(rosenbrock, slopes, np.array([-1.2, 1.0]), -FAR, FAR, np.ones(2))
    np.testing.assert_allclose(found.values, [1.0, 1.0], rtol=1e-8)
    assert found.converged and found.steps < 50


@given(st.floats(-2.0, 0.9), st.floats(-2.0, 2.0))
def test_bounds_hold_and_the_end_is_that_of_another_method(first: float, second: float) -> None:
    lower, upper = np.array([-2.0, -2.0]), np.array([0.9, 2.0])
    start = np.array([first, second])
    found = levenberg_marquardt(rosenbrock, slopes, start, lower, upper, np.ones(2))
    assert (found.values >= lower).all() and (found.values <= upper).all()
    other = least_squares(rosenbrock, np.array([0.0, 0.0]), bounds=(lower, upper), xtol=1e-12, ftol=1e-12)
    np.testing.assert_allclose(found.values, other.x, atol=1e-6)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
def test_units_do_not_matter(scale: float) -> None:
    """One parameter in another unit: the same search, step by step."""
    plain = levenberg_marquardt(rosenbrock, slopes, np.array([-1.2, 1.0]), -FAR, FAR, np.ones(2))
    unit = np.array([1.0, scale])
    found = levenberg_marquardt(
        lambda z: rosenbrock(z / unit), lambda z: slopes(z / unit) / unit, np.array([-1.2, scale]), -FAR, FAR, unit
    )
    assert found.steps == plain.steps
    np.testing.assert_allclose(found.values / unit, plain.values, rtol=1e-9)


def test_a_direction_that_nothing_tells_stays_where_it_began() -> None:
    def residual(z: np.ndarray) -> np.ndarray:
        return np.array([z[0] * z[1] - 6.0, 2.0 * z[0] * z[1] - 12.0])

    def jacobian(z: np.ndarray) -> np.ndarray:
        return np.array([[z[1], z[0]], [2.0 * z[1], 2.0 * z[0]]])

    found = levenberg_marquardt(residual, jacobian, np.array([1.0, 1.0]), np.full(2, 0.1), np.full(2, 50.0), np.ones(2))
    assert found.values[0] * found.values[1] == pytest.approx(6.0, rel=1e-8)
    np.testing.assert_allclose(found.values, np.sqrt(6.0), rtol=1e-6)  # as symmetric as it began
