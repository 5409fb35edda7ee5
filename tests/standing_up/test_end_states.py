"""First and last state of a prediction: bounds about what was recorded, wide enough for its noise."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from geocontact.standing_up.chain import Subject
from geocontact.standing_up.exoskeleton import with_exoskeleton
from geocontact.standing_up.phases import WITHIN, phase_c, slope_error
from geocontact.standing_up.trials import StandingNoise, StandingTrial
from tests.standing_up import test_cost_terms as samples

NOISE = StandingNoise(angle=0.005, rate=0.02)


def legendre_slope(samples: int, seconds: float, degree: int) -> float:
    """Limit for many samples: Legendre polynomials have P_k'(1) = k (k + 1) / 2 and the square mean 1 / (2 k + 1)."""
    k = np.arange(degree + 1)
    return float(np.sqrt(np.sum((2 * k + 1) * (k * (k + 1) / 2) ** 2) / samples)) * 2.0 / seconds


@pytest.mark.parametrize("degree", [1, 3, 7])
def test_the_error_of_a_slope_is_that_of_legendre_polynomials(degree: int) -> None:
    time = np.linspace(0.3, 1.7, 20_001)
    assert slope_error(time, degree) == pytest.approx(legendre_slope(20_001, 1.4, degree), rel=2e-3)


def test_the_error_of_a_slope_is_that_of_many_fits() -> None:
    time, rng = np.linspace(0.0, 1.4, 141), np.random.default_rng(4)
    noise = rng.standard_normal((141, 2000))
    slopes = [np.polynomial.Polynomial.fit(time, each, 7).deriv()(1.4) for each in noise.T]
    assert slope_error(time) == pytest.approx(np.std(slopes), rel=0.05)


def ends(trial: StandingTrial) -> list[tuple[np.ndarray, np.ndarray]]:
    model = with_exoskeleton(Subject())
    only = phase_c(model, Subject(), trial, NOISE, samples.searched(model)).control.trials[0]
    return [only.start, only.end]


def test_rates_at_the_ends_are_those_recorded() -> None:
    """The slope of a polynomial through noisy angles is off by five times as much as a recorded rate."""
    trial = samples.trial(with_exoskeleton(Subject()))
    n = trial.q.shape[1]
    for (low, high), at in zip(ends(trial), (0, -1), strict=True):
        rates = slice(n, 2 * n)
        assert np.allclose(0.5 * (low[rates] + high[rates]), trial.u[at])
        assert np.allclose(high[rates] - low[rates], 2.0 * WITHIN * NOISE.rate)


def test_without_recorded_rates_their_bounds_are_as_wide_as_slopes_are_uncertain() -> None:
    trial = samples.trial(with_exoskeleton(Subject()))
    n = trial.q.shape[1]
    for low, high in ends(replace(trial, u=np.zeros_like(trial.u))):
        angles = slice(n + 2, 2 * n)
        wide = 2.0 * WITHIN * NOISE.angle * slope_error(trial.time)
        assert np.allclose(high[angles] - low[angles], wide)
