"""Synthetic areas and forces with a known E*: smooth areas over one step, force by a reading, noise with a memory."""

from __future__ import annotations

import numpy as np

from geocontact.contact.area_hertz import READINGS, Reading
from geocontact.elastic_modulus.area_force import MODULUS, AreaForce, ThresholdAreas

TRUE = 6.8e6  # Pa
RADIUS, LENGTH, DURATION = 0.037, 0.06, 1.1
THRESHOLDS = np.array([1.0, 2.0, 3.0, 4.0, 5.0]) * 1e-3
READING = {reading.name: reading for reading in READINGS}


def synthetic_areas(time: np.ndarray, scale: float = 1.0) -> np.ndarray:
    """Areas (t, k) [m^2] of a step: growing with the threshold, two humps over time."""
    phase = np.pi * time / DURATION
    humps = 500.0 * np.sin(phase) ** 2 + 150.0 * np.sin(3.0 * phase)
    grown = 250.0 * THRESHOLDS / 1e-3 + 30.0 * np.outer(np.sin(phase), THRESHOLDS / 1e-3)
    return (600.0 + scale * humps[:, None] + grown) * 1e-6


def synthetic_model(
    reading: str | Reading = "disc", frames: int = 101, inner: slice = slice(None), threshold: float = 4e-3
) -> AreaForce:
    """The law on the frames of a step."""
    time = np.linspace(0.0, DURATION, frames)
    evolution = ThresholdAreas(time, THRESHOLDS, synthetic_areas(time), np.full(frames, RADIUS), LENGTH)
    law = READING[reading] if isinstance(reading, str) else reading
    return AreaForce(evolution, law, time[inner], 0.0, threshold)


def coloured(time: np.ndarray, sd: float, tau: float, rng: np.random.Generator) -> np.ndarray:
    """Ornstein-Uhlenbeck noise by the Cholesky factor of its covariance, not by the recursion under test."""
    covariance = sd**2 * np.exp(-np.abs(time[:, None] - time) / tau)
    return np.linalg.cholesky(covariance) @ rng.standard_normal(len(time))


def coverage(runs: int, frames: int, sd: float, tau: float, replicates: int, seed: int) -> dict[str, float]:
    """Share of runs whose intervals of 95 % hold the true E*, by profile likelihood and by block bootstrap.

    Beside it the median half-width of the former over the standard deviation of E* between runs; 1.96 if the noise were
    known.
    """
    from geocontact.elastic_modulus.identify import identify

    rng = np.random.default_rng(seed)
    model = synthetic_model(frames=frames)
    force = model.force({MODULUS: TRUE})
    held, found_at, half = np.zeros(2), np.empty(runs), np.empty(runs)
    for k in range(runs):
        found = identify(model, force + coloured(model.frames, sd, tau, rng), replicates=replicates, starts=0)
        profile, drawn = found.profiles[MODULUS], found.replicates
        held += profile.lower <= TRUE <= profile.upper, drawn is not None and drawn.lower[0] <= TRUE <= drawn.upper[0]
        found_at[k], half[k] = found.modulus, 0.5 * (profile.upper - profile.lower)
    wide = float(np.median(half) / found_at.std())
    return {
        "profile likelihood": float(held[0] / runs),
        "block bootstrap": float(held[1] / runs),
        "half_width_over_sd": round(wide, 3),
    }
