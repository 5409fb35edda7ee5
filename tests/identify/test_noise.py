"""Noise with a memory: whitened by its own covariance, recovered from samples."""

import numpy as np
import pytest
from scipy.stats import kstest

from geocontact.identify.noise.autoregressive import AutoregressiveNoise, noise_of


def covariance(time, sd, tau):
    """Of the Ornstein-Uhlenbeck process."""
    apart = np.abs(time[:, None] - time[None])
    return sd**2 * (np.exp(-apart / tau) if tau > 0.0 else np.eye(len(time)))


def drawn(time, sd, tau, rng, count=1):
    return np.linalg.cholesky(covariance(time, sd, tau)) @ rng.normal(size=(len(time), count))


UNEVEN = np.cumsum(np.random.default_rng(0).uniform(0.002, 0.03, 60))


@pytest.mark.parametrize(("sd", "tau"), [(2.0, 0.05), (0.3, 0.0), (1.0, 3.0)])
def test_whitening_is_the_inverse_square_root_of_the_covariance(sd, tau):
    """W C W^T = 1 and log|W^-1| = half the log determinant, on uneven samples with some missing."""
    values = np.eye(len(UNEVEN))[:, None, :].copy()
    values[7:11] = np.nan
    there = np.isfinite(values[:, 0, 0])
    noise = AutoregressiveNoise(np.array([sd]), np.array([tau]))
    white = noise.whitened(UNEVEN, values)[:, there]
    inner = covariance(UNEVEN[there], sd, tau)
    np.testing.assert_allclose(white @ inner @ white.T, np.eye(there.sum()), atol=1e-9)
    expected = 0.5 * np.linalg.slogdet(inner)[1]
    assert noise.log_scale(UNEVEN, values[:, :, 0]) == pytest.approx(expected, rel=1e-9)


def test_channels_are_whitened_each_by_its_own_noise_and_columns_alike():
    rng = np.random.default_rng(1)
    values = rng.normal(size=(60, 2, 3))
    both = AutoregressiveNoise(np.array([1.0, 5.0]), np.array([0.1, 0.0])).whitened(UNEVEN, values)
    one = AutoregressiveNoise(np.array([1.0]), np.array([0.1])).whitened(UNEVEN, values[:, :1])
    np.testing.assert_allclose(both[:60], one)
    np.testing.assert_allclose(both[60:], values[:, 1] / 5.0)


@pytest.mark.parametrize("tau", [0.03, 0.2])
def test_noise_is_recovered_from_trials(tau):
    """Within three standard errors of the maximum-likelihood estimates, which Monte Carlo tells."""
    rng = np.random.default_rng(2)
    time = 0.01 * np.arange(400)
    found = []
    for _ in range(60):
        residuals = [drawn(time, 2.0, tau, rng) for _ in range(3)]
        noise = noise_of([time] * 3, residuals)
        found.append((noise.sd[0], noise.tau[0]))
    mean, error = np.mean(found, axis=0), np.std(found, axis=0) / np.sqrt(60)
    assert abs(mean[0] - 2.0) < 3 * error[0] + 0.02
    assert abs(mean[1] / tau - 1.0) < 3 * error[1] / tau + 0.05


def test_white_noise_is_found_to_be_white():
    time = 0.01 * np.arange(2000)
    noise = noise_of([time], [np.random.default_rng(3).normal(size=(2000, 1))])
    assert np.exp(-0.01 / noise.tau[0]) < 0.06
    assert noise.sd[0] == pytest.approx(1.0, abs=0.05)


def test_innovations_are_standard_normal():
    rng = np.random.default_rng(4)
    sample = drawn(UNEVEN, 3.0, 0.08, rng, count=100)
    noise = AutoregressiveNoise(np.array([3.0]), np.array([0.08]))
    white = noise.whitened(UNEVEN, sample[:, None, :])
    assert kstest(white.ravel(), "norm").pvalue > 0.001
