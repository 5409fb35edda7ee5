"""Noise of inputs as it comes through models with and without a motion of their own."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geocontact.identify.noise.input_noise import Instant, Lasting, NoiseSpectrum
from geocontact.identify.signals.low_pass import LowPass

COUNT, STEP, AHEAD = 80, 0.02, 3


def spectrum(left: float = 1.0) -> NoiseSpectrum:
    return NoiseSpectrum.after(
        LowPass(6.0, STEP), lambda frequency: 2.0 * np.pi * frequency, lambda f: np.full_like(f, left)
    )


def test_what_answers_at_once_is_the_same_either_way() -> None:
    """A response of one sample is a sensitivity to values."""
    time, rng = STEP * np.arange(COUNT), np.random.default_rng(0)
    to_value = rng.normal(size=(COUNT, 2, 1))
    response = np.zeros((1, COUNT, 2, AHEAD + 6))
    response[0, :, :, AHEAD] = to_value[..., 0]
    at, channel = np.tile(np.arange(20, 50), 2), np.repeat([0, 1], 30)
    instant = Instant(time, to_value, np.zeros_like(to_value), (spectrum(),)).covariance(at, channel)
    lasting = Lasting(time, response, AHEAD, (spectrum(),)).covariance(at, channel)
    assert_allclose(lasting, instant, rtol=1e-12, atol=1e-12)


def test_what_lasts_is_the_sum_of_all_responses() -> None:
    """R C Rᵀ of whole trials, dense, whatever rows are asked for."""
    time, rng = STEP * np.arange(COUNT), np.random.default_rng(1)
    response = rng.normal(size=(1, COUNT, 2, 9))
    dense = np.zeros((2, COUNT, COUNT))
    for i in range(COUNT):
        for lag in range(9):
            j = i - lag + AHEAD
            if 0 <= j < COUNT:
                dense[:, i, j] = response[0, i, :, lag]
    within = spectrum().covariance(time[:, None] - time)[0]
    at, channel = np.array([0, 1, 40, 41, 79, 3, 79]), np.array([0, 0, 0, 0, 0, 1, 1])
    rows = dense[channel, at]
    found = Lasting(time, response, AHEAD, (spectrum(),)).covariance(at, channel)[0]
    assert_allclose(found, rows @ within @ rows.T, rtol=1e-10, atol=1e-12)


@pytest.mark.parametrize("left", [0.25, 1.0])
def test_noise_that_was_taken_off_is_not_there_any_more(left: float) -> None:
    value, _, rate = spectrum(left).covariance(np.zeros((1, 1)))
    whole, _, fast = spectrum().covariance(np.zeros((1, 1)))
    assert value[0, 0] == pytest.approx(left * whole[0, 0])
    assert rate[0, 0] == pytest.approx(left * fast[0, 0])


def test_each_input_has_its_own_noise() -> None:
    time = STEP * np.arange(COUNT)
    both = Instant(time, np.ones((COUNT, 1, 2)), np.zeros((COUNT, 1, 2)), (spectrum(), spectrum(0.5)))
    first, second = both.covariance(np.arange(5), np.zeros(5, int))
    assert_allclose(second, 0.5 * first)
