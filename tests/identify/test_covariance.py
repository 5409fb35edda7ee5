"""Noise of several kinds: its covariance, and its whitening."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from numpy.testing import assert_allclose
from scipy.signal import butter, filtfilt

from geocontact.identify.noise.covariance import BLOCK_ROWS, Layout, NoiseBlock
from geocontact.identify.noise.input_noise import Instant, Lasting, NoiseSpectrum
from geocontact.identify.noise.noise_levels import NoiseLevels
from geocontact.identify.signals.low_pass import LowPass
from tests.identify.synthetic_noise import COUNT, LEVELS, PASSED, STEP, layout


def differences(frequency: np.ndarray) -> np.ndarray:
    return np.sin(2.0 * np.pi * frequency * 0.005) / 0.005


def whole(block: NoiseBlock) -> np.ndarray:
    return block.covariance(LEVELS)


def test_rows_are_cut_into_blocks_and_every_measured_sample_is_in_one() -> None:
    there = np.ones((COUNT, 2), bool)
    there[40:60, 1] = False
    found = layout(there)
    assert len(found.blocks) > 1
    assert sorted(found.rows) == sorted(np.flatnonzero(there.ravel()))


def test_a_stretch_in_which_nothing_was_measured_has_no_block() -> None:
    """Nor is there anything in it that noise of an input, whose response lasts, could be felt in."""
    time, there = STEP * np.arange(1000), np.zeros((1000, 1), bool)
    there[:300] = True
    response = np.zeros((1, 1000, 1, 6))
    response[..., 3] = 1.0
    found = Layout.of(time, there, Lasting(time, response, 3, (PASSED,)), np.ones(there.shape), np.zeros(there.shape))
    assert list(found.rows) == list(range(300))


def test_covariance_is_symmetric_and_sums_white_coloured_and_input_noise() -> None:
    block = layout().blocks[0]
    total = whole(block)
    assert_allclose(total, total.T, atol=1e-12)
    first, second = np.flatnonzero(block.channel == 0)[:2]
    assert total[first, first] == pytest.approx(
        0.3**2 + 0.5**2 + (0.1 * block.signal[first]) ** 2 + 25.0 * 0.04**2, rel=1e-6
    )
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
    values = rng.standard_normal(len(block.rows))
    moved = block.derivatives_times(LEVELS, values)
    for k in range(len(logs)):
        up, down = logs.copy(), logs.copy()
        up[k] += 1e-5
        down[k] -= 1e-5
        change = (block.covariance(LEVELS.at(up)) - block.covariance(LEVELS.at(down))) / 2e-5
        assert exact[k] == pytest.approx(float((pull * change).sum()), rel=1e-4, abs=1e-6)
        assert_allclose(moved[k], change @ values, rtol=1e-4, atol=1e-6)


def test_an_input_that_is_not_felt_changes_nothing() -> None:
    """Between two that are felt: everything but its own derivative, which is 0, is as without it."""
    one = layout().blocks[0]
    with_silent = replace(one, inputs=np.stack([one.inputs[0], np.zeros_like(one.inputs[0]), 0.5 * one.inputs[0]]))
    without = replace(one, inputs=with_silent.inputs[[0, 2]])
    levels = replace(LEVELS, inputs=np.array([0.04, 3.0, 0.02]))
    others = replace(LEVELS, inputs=np.array([0.04, 0.02]))
    assert_allclose(with_silent.covariance(levels), without.covariance(others), rtol=1e-14)
    pull, values = one.covariance(LEVELS), np.linspace(-1.0, 1.0, len(one.rows))
    kept = np.delete(np.arange(levels.logarithms().size), -2)
    for name, given in (("pulls", pull), ("derivatives_times", values)):
        found, expected = getattr(with_silent, name)(levels, given), getattr(without, name)(others, given)
        assert_allclose(found[kept], expected, rtol=1e-14)
        assert not found[-2].any()


def test_a_covariance_without_a_factor_is_raised_until_it_has_one() -> None:
    loud = NoiseLevels(np.full(2, 1e-9), np.full((1, 2), 1e-9), LEVELS.memory, np.full(2, 1e-9), np.array([1e3]))
    assert np.isfinite(layout().whitener(loud).log_scale)


def test_noise_that_nobody_filtered_is_white() -> None:
    """Every frequency passes; values two samples apart have nothing in common, and rates are those of differences."""
    spectrum = NoiseSpectrum.after(LowPass.none(0.005), differences)
    value, _, both = spectrum.covariance(0.005 * np.array([[0.0, 1.0, 2.0]]))
    assert_allclose(value, [[1.0, 0.0, 0.0]], atol=0.01)
    assert_allclose(both, 200.0**2 * np.array([[0.5, 0.0, -0.25]]), atol=0.02 * 200.0**2)


@pytest.mark.parametrize("sampled", [50.0, 200.0, 1000.0])
def test_rates_of_unfiltered_noise_are_remembered_as_long_as_they_are_smoothed(sampled: float) -> None:
    """Slopes of straight lines through 70 ms to either side: their covariance is that of the lines' weights."""
    step, half = 1.0 / sampled, round(0.07 * sampled)
    weights = np.arange(-half, half + 1) / (step * np.sum(np.arange(-half, half + 1.0) ** 2))

    def rates(frequency: np.ndarray) -> np.ndarray:
        return np.abs(np.sin(2.0 * np.pi * np.outer(frequency, step * np.arange(-half, half + 1))) @ weights)

    lags = np.arange(4 * half + 1)
    *_, both = NoiseSpectrum.after(LowPass.none(step), rates).covariance(step * lags[None])
    exact = np.zeros(len(lags))
    exact[: 2 * half + 1] = np.correlate(weights, weights, "full")[2 * half :]
    assert_allclose(both[0], exact, atol=0.03 * exact[0])


def test_a_piece_ends_a_block_and_both_sides_weigh_as_two_trials() -> None:
    """Noise is forgotten over a pause; a block of 120 rows would otherwise hold both of its sides."""
    rng, time = np.random.default_rng(4), STEP * np.arange(100)
    paused = np.concatenate([time[:55], time[55:] + 40.0 * STEP])
    felt, one = rng.standard_normal((100, 1, 1)), np.ones((100, 1))
    values = rng.standard_normal((100, 1, 3))
    levels = NoiseLevels(
        *(each[..., :1] for each in (LEVELS.white, LEVELS.coloured, LEVELS.memory, LEVELS.growing)), LEVELS.inputs
    )

    def whitened(rows: slice, *pieces: slice) -> tuple[np.ndarray, float]:
        heard = Instant(paused[rows], felt[rows], 0.1 * felt[rows], (PASSED,))
        found = Layout.of(paused[rows], one[rows] > 0.0, heard, one[rows], 0.0 * one[rows], pieces)
        whitener = found.whitener(levels)
        return whitener(values[rows]), whitener.log_scale

    pieces = slice(0, 55), slice(55, 100)
    both, first, later = whitened(slice(100), *pieces), whitened(pieces[0]), whitened(pieces[1])
    assert_allclose(both[0], np.concatenate([first[0], later[0]]), atol=1e-12)
    assert both[1] == pytest.approx(first[1] + later[1])


def test_blocks_of_a_trial_with_two_rates_are_those_of_its_rows() -> None:
    """600 rows at 1 kHz and 500 at 50 Hz, one of three missing: edges are evenly spaced rows, whatever the steps."""
    time = np.concatenate([0.001 * np.arange(600), 0.6 + 0.02 * np.arange(500)])
    there = (np.arange(1100) % 3 > 0)[:, None]
    felt = np.zeros((1100, 1, 1))
    found = Layout.of(time, there, Instant(time, felt, felt, ()), np.ones((1100, 1)), np.zeros((1100, 1)))
    edges = [round(each) for each in np.linspace(0, 1100, round(there.sum() / BLOCK_ROWS) + 1)]
    expected = [a + np.flatnonzero(there[a:b, 0]) for a, b in pairwise(edges)]
    assert len(found.blocks) == len(expected) == 6
    for block, rows in zip(found.blocks, expected, strict=True):
        np.testing.assert_array_equal(block.rows, rows)
