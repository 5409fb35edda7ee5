"""Standard deviations of what is sought, beside normal equations by hand."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.below_knee_prosthesis.calibration.known_numbers import with_memory

SD = np.array([1.1, 2.3, 0.7])


def linear(size: float) -> tuple[np.ndarray, np.ndarray]:
    """White residuals of that size over the stated noise, and a slope; the data do not hang on the third number."""
    rng = np.random.default_rng(8)
    slope = rng.normal(size=(400, 3)) * np.array([0.3, 0.1, 1e-6])
    off = size * rng.normal(size=400)
    return off - slope @ np.linalg.lstsq(slope, off, rcond=None)[0], slope


def found(size: float) -> np.ndarray:
    """Of each number."""
    off, slope = linear(size)
    memory, covariance = with_memory(0.005 * np.arange(400.0), off, slope, np.zeros(3), SD)
    return np.sqrt(np.einsum("g,gkk->k", memory.weight, covariance))


def test_small_residuals_make_no_number_better_known_than_the_stated_noise() -> None:
    """Before, residuals of a fifth of the noise made a fifth of every standard deviation, the prior's too."""
    _, slope = linear(0.2)
    stated = np.sqrt(np.diag(np.linalg.inv(slope.T @ slope + np.diag(1.0 / SD**2))))
    np.testing.assert_allclose(found(0.2), stated, rtol=0.02)
    assert found(0.2)[2] == pytest.approx(SD[2], rel=1e-3)


def test_large_residuals_widen_what_the_data_tell_and_leave_the_prior() -> None:
    """Three times the noise, three times a standard deviation that is the data's: B (9 J'J + P) B, B the inverse."""
    _, slope = linear(3.0)
    bread = np.linalg.inv(slope.T @ slope + np.diag(1.0 / SD**2))
    by_hand = np.sqrt(np.diag(bread @ (9.0 * slope.T @ slope + np.diag(1.0 / SD**2)) @ bread))
    now = found(3.0)
    np.testing.assert_allclose(now[:2], by_hand[:2], rtol=0.12)
    assert now[2] == pytest.approx(SD[2], rel=1e-3)
