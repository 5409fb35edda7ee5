"""Trials of synthetic noise: two channels, one input, white, quick coloured and growing noise."""

from __future__ import annotations

import numpy as np

from geocontact.identify.noise.covariance import Layout
from geocontact.identify.noise.input_noise import Instant, NoiseSpectrum
from geocontact.identify.noise.noise_levels import NoiseLevels
from geocontact.identify.signals.low_pass import LowPass

COUNT, STEP = 150, 0.02
LEVELS = NoiseLevels(
    np.array([0.3, 0.2]), np.array([[0.5, 0.1]]), np.array([[0.1, 0.05]]), np.array([0.1, 0.05]), np.array([0.04])
)


def exact(frequency: np.ndarray) -> np.ndarray:
    return 2.0 * np.pi * frequency


PASSED = NoiseSpectrum.after(LowPass(6.0, STEP), exact)


def layout(present: np.ndarray | None = None) -> Layout:
    time = STEP * np.arange(COUNT)
    there = np.ones((COUNT, 2), bool) if present is None else present
    to_value = np.ones((COUNT, 2, 1)) * np.array([[[5.0], [2.0]]])
    to_rate = np.zeros((COUNT, 2, 1))
    to_rate[:, 1] = 0.3
    signal = np.abs(np.sin(2.0 * np.pi * time))[:, None] * np.array([2.0, 1.0])
    return Layout.of(time, there, Instant(time, to_value, to_rate, (PASSED,)), np.ones(there.shape), signal)


def noise_of(one: Layout, levels: NoiseLevels, rng: np.random.Generator) -> np.ndarray:
    """A draw of one trial's residual."""
    flat, whitener = np.zeros(one.shape[0] * one.shape[1]), one.whitener(levels)
    flat[np.concatenate(whitener.rows)] = whitener.coloured(rng.standard_normal(len(one.rows)))
    return flat.reshape(one.shape)
