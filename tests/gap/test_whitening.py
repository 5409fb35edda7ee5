"""Whitening with trial-to-trial variation, and evidence, against dense covariances."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.gap.case.whitening import SENSOR_LOUDER, Whitening, usual_levels
from geocontact.gap.selection.evidence import log_evidence
from geocontact.identify.noise.covariance import Layout
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
