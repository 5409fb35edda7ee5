"""Whitening with trial-to-trial variation, and evidence, against dense covariances."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.gap.case.whitening import SENSOR_LOUDER, Whitening, usual_levels
from geocontact.gap.selection.evidence import log_evidence
from geocontact.gap.selection.surrogate import _whitened
from geocontact.identify.noise.covariance import Layout, Whitener
from geocontact.identify.noise.input_noise import Instant, NoiseSpectrum
from geocontact.identify.noise.noise_levels import NoiseLevels
from geocontact.identify.signals.low_pass import LowPass
from geocontact.systems.catalogue import system_of
from tests.gap.cases import elbow_case

SPECTRUM = NoiseSpectrum.after(LowPass(6.0, 0.05), lambda frequency: 2.0 * np.pi * frequency)


def parts(rng: np.random.Generator) -> tuple[Layout, NoiseLevels, np.ndarray]:
    time = 0.05 * np.arange(60)
    still = np.zeros((60, 1, 1))
    levels = NoiseLevels(np.array([0.4]), np.array([[0.6]]), np.array([[0.2]]), np.ones(1), np.array([1.0]))
    return (
        Layout.of(
            time, np.ones((60, 1), bool), Instant(time, still, still, (SPECTRUM,)), np.ones((60, 1)), np.zeros((60, 1))
        ),
        levels,
        rng.standard_normal((60, 1, 2)),
    )


def test_weighing_is_the_inverse_root_of_the_whole_covariance() -> None:
    rng = np.random.default_rng(0)
    layout, levels, varied = parts(rng)
    whitening = Whitening.of(layout.whitener(levels), varied)
    dense = layout.blocks[0].covariance(levels) + varied[:, 0] @ varied[:, 0].T
    r = rng.standard_normal((60, 1, 1))
    white = whitening(r)[:, 0]
    assert white @ white == pytest.approx(float(r[:, 0, 0] @ np.linalg.solve(dense, r[:, 0, 0])))
    assert whitening.log_scale == pytest.approx(0.5 * np.linalg.slogdet(dense)[1])


def test_without_variation_it_is_the_whitener() -> None:
    layout, levels, _ = parts(np.random.default_rng(1))
    whitening = Whitening.of(layout.whitener(levels), np.zeros((60, 1, 0)))
    assert whitening.log_scale == layout.whitener(levels).log_scale


def two_channels() -> tuple[np.ndarray, Whitener]:
    """Samples of two channels that were measured, one now and then, and the whitener of their noise."""
    time, present = 0.05 * np.arange(60), np.ones((60, 2), bool)
    present[::7, 0] = present[20:35, 1] = False
    answers = np.random.default_rng(5).standard_normal((60, 2, 1))
    levels = NoiseLevels(np.full(2, 0.4), np.full((1, 2), 0.6), np.full((1, 2), 0.2), np.ones(2), np.array([1.0]))
    heard = Instant(time, answers, answers, (SPECTRUM,))
    return present, Layout.of(time, present, heard, np.ones((60, 2)), np.zeros((60, 2))).whitener(levels)


@pytest.mark.parametrize("channel", [0, 1])
def test_what_one_channel_has_alone_is_whitened_as_with_zeros_in_the_other(channel: int) -> None:
    _, whitener = two_channels()
    values = np.zeros((60, 2, 3))
    values[:, channel] = np.random.default_rng(6).standard_normal((60, 3))
    np.testing.assert_allclose(whitener.of_channel(values[:, channel], channel, 2), whitener(values), atol=1e-12)


def test_features_are_whitened_alike_whether_channels_share_them_or_not() -> None:
    """Features of one channel each, with one more that both have: the former are whitened as they are alone."""
    present, whitener = two_channels()
    rng = np.random.default_rng(7)
    features = np.zeros((60, 2, 5))
    features[:, 0, :2], features[:, 1, 2:4] = rng.standard_normal((2, 60, 2))
    both = features.copy()
    both[..., 4] = 1.0
    whitening = Whitening.of(whitener, rng.standard_normal((60, 2, 2)))
    alone, beside = (_whitened(whitening, each) for each in (features, both))
    np.testing.assert_allclose(alone[:, :4], beside[:, :4], atol=1e-12)
    np.testing.assert_allclose(beside, whitening(both), atol=1e-12)
    assert not alone[:, 4].any() and len(alone) == present.sum()


def test_values_of_measured_samples_alone_are_whitened_as_among_all() -> None:
    """Two channels, of which one is measured in every third sample of the first half, the other in every fifth."""
    rng, time = np.random.default_rng(3), 0.05 * np.arange(60)
    present = np.zeros((60, 2), bool)
    present[:30:3, 0] = present[::5, 1] = True
    still = np.zeros((60, 2, 1))
    levels = NoiseLevels(np.full(2, 0.4), np.full((1, 2), 0.6), np.full((1, 2), 0.2), np.ones(2), np.array([1.0]))
    heard = Instant(time, still, still, (SPECTRUM,))
    whitener = Layout.of(time, present, heard, np.ones((60, 2)), np.zeros((60, 2))).whitener(levels)
    samples = np.flatnonzero(present.any(axis=1))
    values = rng.standard_normal((60, 2, 4))
    assert len(samples) == 20
    np.testing.assert_array_equal(whitener.among(samples, 2)(values[samples]), whitener(values))


def test_evidence_is_that_of_the_dense_normal_distribution() -> None:
    rng = np.random.default_rng(2)
    design, spread, r = rng.standard_normal((40, 3)), np.array([0.5, 2.0, 0.0]), rng.standard_normal(40)
    dense = np.eye(40) + (design * spread) @ (design * spread).T
    expected = -0.5 * r @ np.linalg.solve(dense, r) - 0.5 * np.linalg.slogdet(dense)[1]
    assert log_evidence(r, design, spread) == pytest.approx(expected)


@pytest.mark.parametrize(("told", "limit"), [({"force": 0.2}, 0.2 * SENSOR_LOUDER), ({}, np.inf)])
def test_a_sensor_is_hardly_noisier_than_was_told(told: dict[str, float], limit: float) -> None:
    case = elbow_case(duration=2.0)
    system = system_of(case).scaled(case.calibration)
    assert usual_levels(system, told, np.array([0.15]), {"beta": 0.01}, {}, np.zeros(1)).sensors == pytest.approx(
        [limit]
    )


def test_an_input_is_hardly_noisier_than_is_believed_or_than_its_spectrum_allows() -> None:
    case = elbow_case(duration=2.0)
    system = system_of(case).scaled(case.calibration)
    believed = usual_levels(system, {}, np.array([0.15]), {"beta": 0.01}, {}, np.zeros(1))
    assert believed.inputs == pytest.approx([2.0 * 0.01])
    assert usual_levels(
        system, {}, np.array([0.15]), {"beta": 0.01}, {"beta": 0.02}, np.zeros(1)
    ).inputs == pytest.approx([0.02])
