"""Noise of several kinds: its covariance, its whitening, its levels."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.signal import butter, filtfilt

from geocontact.identify.covariance import Block, Layout, most_likely
from geocontact.identify.input_noise import Instant
from geocontact.identify.low_pass import LowPass
from geocontact.identify.noise_levels import BEYOND, Beliefs, Levels
from geocontact.identify.noise_spectrum import NoiseSpectrum

COUNT, STEP = 150, 0.02


def exact(frequency: np.ndarray) -> np.ndarray:
    return 2.0 * np.pi * frequency


PASSED = NoiseSpectrum.after(LowPass(6.0, STEP), exact)


def layout(present: np.ndarray | None = None) -> Layout:
    time = STEP * np.arange(COUNT)
    there = np.ones((COUNT, 2), bool) if present is None else present
    to_value = np.ones((COUNT, 2, 1)) * np.array([[[5.0], [2.0]]])
    to_rate = np.zeros((COUNT, 2, 1))
    to_rate[:, 1] = 0.3
    return Layout.of(time, there, Instant(time, to_value, to_rate, (PASSED,)))


LEVELS = Levels(np.array([0.3, 0.2]), np.array([[0.5, 0.1]]), np.array([[0.1, 0.05]]), np.array([0.04]))


def differences(frequency: np.ndarray) -> np.ndarray:
    return np.sin(2.0 * np.pi * frequency * 0.005) / 0.005


def whole(block: Block) -> np.ndarray:
    return block.covariance(LEVELS)


def test_rows_are_cut_into_blocks_and_every_measured_sample_is_in_one() -> None:
    there = np.ones((COUNT, 2), bool)
    there[40:60, 1] = False
    found = layout(there)
    assert len(found.blocks) > 1
    assert sorted(found.rows) == sorted(np.flatnonzero(there.ravel()))


def test_covariance_is_symmetric_and_sums_white_coloured_and_input_noise() -> None:
    block = layout().blocks[0]
    total = whole(block)
    assert_allclose(total, total.T, atol=1e-12)
    first, second = np.flatnonzero(block.channel == 0)[:2]
    assert total[first, first] == pytest.approx(0.3**2 + 0.5**2 + 25.0 * 0.04**2, rel=1e-6)
    away = PASSED.covariance(np.array([[STEP]]))[0][0, 0]
    assert total[first, second] == pytest.approx(0.25 * np.exp(-STEP / 0.1) + 25.0 * 0.04**2 * away, rel=1e-6)


@pytest.mark.parametrize("corner", [3.0, 6.0, 12.0])
def test_kernel_is_that_of_filtered_noise(corner: float) -> None:
    rng = np.random.default_rng(0)
    noise = filtfilt(*butter(2, corner, fs=200.0), rng.standard_normal(400_000))
    noise /= noise.std()
    rate = np.gradient(noise, 0.005)
    lags = np.array([0, 4, 10, 20])
    value, mixed, both = NoiseSpectrum.after(LowPass(corner, 0.005), differences).covariance(
        0.005 * lags[None].astype(float)
    )
    ends = len(noise) - lags.max()
    for k, lag in enumerate(lags):
        assert value[0, k] == pytest.approx(np.mean(noise[lag : lag + ends] * noise[:ends]), abs=0.02)
        assert mixed[0, k] == pytest.approx(np.mean(rate[lag : lag + ends] * noise[:ends]), abs=0.1 * corner)
        seen = np.mean(rate[lag : lag + ends] * rate[:ends])
        assert both[0, k] == pytest.approx(seen, rel=0.05, abs=0.02 * both[0, 0])


def test_whitened_noise_is_white_and_colouring_is_the_way_back() -> None:
    rng = np.random.default_rng(1)
    found = layout()
    whitener = found.whitener(LEVELS)
    independent = rng.standard_normal(len(found.rows))
    flat = np.zeros(COUNT * 2)
    flat[np.concatenate(whitener.rows)] = whitener.coloured(independent)
    assert_allclose(whitener(flat.reshape(COUNT, 2, 1))[:, 0], independent, atol=1e-9)
    logdet = sum(np.linalg.slogdet(whole(block))[1] for block in found.blocks)
    assert whitener.log_scale == pytest.approx(0.5 * logdet)


def test_derivatives_are_those_of_the_covariance() -> None:
    block = layout().blocks[0]
    rng = np.random.default_rng(2)
    pull = rng.standard_normal((len(block.rows),) * 2)
    pull = pull + pull.T
    logs = LEVELS.logarithms()
    exact = block.pulls(LEVELS, pull)
    for k in range(len(logs)):
        up, down = logs.copy(), logs.copy()
        up[k] += 1e-5
        down[k] -= 1e-5
        change = (block.covariance(LEVELS.at(up)) - block.covariance(LEVELS.at(down))) / 2e-5
        assert exact[k] == pytest.approx(float((pull * change).sum()), rel=1e-4, abs=1e-6)


def noise_of(one: Layout, levels: Levels, rng: np.random.Generator) -> np.ndarray:
    """A draw of one trial's residual."""
    flat, whitener = np.zeros(one.shape[0] * one.shape[1]), one.whitener(levels)
    flat[np.concatenate(whitener.rows)] = whitener.coloured(rng.standard_normal(len(one.rows)))
    return flat.reshape(one.shape)


def unlimited(prior: Levels) -> Beliefs:
    """Every logarithm is known to about one."""
    sensors, inputs = np.full(len(prior.white), np.inf), np.full(len(prior.inputs), np.inf)
    return Beliefs(prior, np.eye(len(prior.logarithms())), sensors, inputs)


def test_levels_are_found_again() -> None:
    rng = np.random.default_rng(3)
    layouts = [layout() for _ in range(5)]
    residuals = [noise_of(each, LEVELS, rng) for each in layouts]
    prior = LEVELS.at(LEVELS.logarithms() + 0.5)
    nothing = [np.zeros((COUNT, 2, 0)) for _ in layouts]
    found, surprise, _ = most_likely(layouts, residuals, nothing, unlimited(prior), prior)
    assert_allclose(found.coloured[0, 0], 0.5, rtol=0.15)
    assert_allclose(found.memory[0, 0], 0.1, rtol=0.35)
    assert_allclose(found.inputs, 0.04, rtol=0.15)
    assert surprise > 0.0


def test_what_is_limited_does_not_grow_with_what_a_model_misses() -> None:
    """Both channels hold a sine ten times as large as all their noise; limits are what the noise is."""
    rng = np.random.default_rng(7)
    layouts = [layout() for _ in range(3)]
    missed = 8.0 * np.sin(2.0 * np.pi * 0.7 * STEP * np.arange(COUNT))[:, None]
    residuals = [noise_of(each, LEVELS, rng) + missed for each in layouts]
    nothing = [np.zeros((COUNT, 2, 0)) for _ in layouts]
    free = unlimited(LEVELS)
    limited = replace(free, sensors=LEVELS.sensors, inputs=LEVELS.inputs)
    loud = most_likely(layouts, residuals, nothing, free, LEVELS)[0]
    held = most_likely(layouts, residuals, nothing, limited, LEVELS)[0]
    assert (loud.sensors > 3.0).all()
    assert (held.sensors < np.exp(BEYOND) * LEVELS.sensors).all()
    assert (held.inputs < np.exp(BEYOND) * LEVELS.inputs).all()


def test_a_covariance_without_a_factor_is_raised_until_it_has_one() -> None:
    loud = Levels(np.full(2, 1e-9), np.full((1, 2), 1e-9), LEVELS.memory, np.array([1e3]))
    assert np.isfinite(layout().whitener(loud).log_scale)


def test_a_slow_part_is_told_from_a_quick_one() -> None:
    """Two processes with a memory: one would leave what is slow out, and sums over seconds would look like a gap."""
    time, rng = STEP * np.arange(400), np.random.default_rng(5)
    nothing = np.zeros((400, 1, 1))
    heard = Instant(time, nothing, nothing, (PASSED,))
    layouts = [Layout.of(time, np.ones((400, 1), bool), heard) for _ in range(6)]
    true = Levels(np.array([0.3]), np.array([[0.3], [0.25]]), np.array([[0.03], [0.5]]), np.array([1.0]))
    residuals = [noise_of(each, true, rng) for each in layouts]
    prior = Levels(np.array([0.3]), np.array([[0.3], [0.1]]), np.array([[0.04], [0.4]]), np.array([1.0]))
    none = [np.zeros((400, 1, 0)) for _ in layouts]
    found, _, nats = most_likely(layouts, residuals, none, unlimited(prior), prior)
    assert found.coloured[1, 0] == pytest.approx(0.25, rel=0.3)
    assert found.memory[1, 0] > 5.0 * found.memory[0, 0]
    quick = Levels(prior.white, prior.coloured[:1], prior.memory[:1], prior.inputs)
    assert nats > most_likely(layouts, residuals, none, unlimited(quick), quick)[2] + 10.0


def test_a_search_ends_where_it_does_not_matter_from_where_it_set_out() -> None:
    """Noise of the inputs and of the sensor, alike but for their spectra, where one is far quieter than the other."""
    time, rng = STEP * np.arange(300), np.random.default_rng(6)
    answers = np.full((300, 1, 1), 5.0)
    heard = Instant(time, answers, np.zeros((300, 1, 1)), (PASSED,))
    layouts = [Layout.of(time, np.ones((300, 1), bool), heard) for _ in range(6)]
    true = Levels(np.array([0.002]), np.array([[0.1], [0.05]]), np.array([[0.03], [0.6]]), np.array([0.02]))
    residuals = [noise_of(each, true, rng) for each in layouts]
    prior = Levels(np.array([0.07]), np.array([[0.07], [0.02]]), np.array([[0.08], [0.4]]), np.array([0.005]))
    none = [np.zeros((300, 1, 0)) for _ in layouts]
    ends = [most_likely(layouts, residuals, none, unlimited(prior), start)[2] for start in (prior, true)]
    assert ends[0] == pytest.approx(ends[1], abs=0.05)
