"""Levels of noise are found, by few evaluations of how likely residuals are."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from numpy.testing import assert_allclose

from geocontact.identify.noise.covariance import Layout
from geocontact.identify.noise.input_noise import Instant
from geocontact.identify.noise.noise_levels import BEYOND, NoiseLevels, NoisePriors
from geocontact.identify.noise.noise_search import CostSurface, SearchPoint, most_likely, secant
from tests.identify.synthetic_noise import COUNT, LEVELS, PASSED, STEP, layout, noise_of


def unlimited(prior: NoiseLevels) -> NoisePriors:
    """Every logarithm is known to about one."""
    sensors, inputs = np.full(len(prior.white), np.inf), np.full(len(prior.inputs), np.inf)
    return NoisePriors(prior, np.eye(len(prior.logarithms())), sensors, inputs)


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
    assert (loud.sensors > 3.0 * LEVELS.sensors).all()
    assert (held.sensors < np.exp(BEYOND) * LEVELS.sensors).all()
    assert (held.inputs < np.exp(BEYOND) * LEVELS.inputs).all()


def test_a_slow_part_is_told_from_a_quick_one() -> None:
    """Two processes with a memory: one would leave what is slow out, and sums over seconds would look like a gap."""
    time, rng = STEP * np.arange(400), np.random.default_rng(5)
    nothing = np.zeros((400, 1, 1))
    heard = Instant(time, nothing, nothing, (PASSED,))
    layouts = [Layout.of(time, np.ones((400, 1), bool), heard, np.ones((400, 1)), np.zeros((400, 1))) for _ in range(6)]
    true = NoiseLevels(
        np.array([0.3]), np.array([[0.3], [0.25]]), np.array([[0.03], [0.5]]), np.ones(1), np.array([1.0])
    )
    residuals = [noise_of(each, true, rng) for each in layouts]
    prior = NoiseLevels(
        np.array([0.3]), np.array([[0.3], [0.1]]), np.array([[0.04], [0.4]]), np.ones(1), np.array([1.0])
    )
    none = [np.zeros((400, 1, 0)) for _ in layouts]
    found, _, nats = most_likely(layouts, residuals, none, unlimited(prior), prior)
    assert found.coloured[1, 0] == pytest.approx(0.25, rel=0.3)
    assert found.memory[1, 0] > 5.0 * found.memory[0, 0]
    quick = NoiseLevels(prior.white, prior.coloured[:1], prior.memory[:1], prior.growing, prior.inputs)
    assert nats > most_likely(layouts, residuals, none, unlimited(quick), quick)[2] + 10.0


def test_a_search_ends_where_it_does_not_matter_from_where_it_set_out() -> None:
    """Noise of the inputs and of the sensor, alike but for their spectra, where one is far quieter than the other."""
    time, rng = STEP * np.arange(300), np.random.default_rng(6)
    answers = np.full((300, 1, 1), 5.0)
    heard = Instant(time, answers, np.zeros((300, 1, 1)), (PASSED,))
    layouts = [Layout.of(time, np.ones((300, 1), bool), heard, np.ones((300, 1)), np.zeros((300, 1))) for _ in range(6)]
    true = NoiseLevels(
        np.array([0.002]), np.array([[0.1], [0.05]]), np.array([[0.03], [0.6]]), np.ones(1), np.array([0.02])
    )
    residuals = [noise_of(each, true, rng) for each in layouts]
    prior = NoiseLevels(
        np.array([0.07]), np.array([[0.07], [0.02]]), np.array([[0.08], [0.4]]), np.ones(1), np.array([0.005])
    )
    none = [np.zeros((300, 1, 0)) for _ in layouts]
    ends = [most_likely(layouts, residuals, none, unlimited(prior), start)[2] for start in (prior, true)]
    assert ends[0] == pytest.approx(ends[1], abs=0.05)


def drawn() -> tuple[list[Layout], list[np.ndarray], list[np.ndarray]]:
    rng = np.random.default_rng(3)
    layouts = [layout() for _ in range(5)]
    return layouts, [noise_of(each, LEVELS, rng) for each in layouts], [0.05 * np.ones((COUNT, 2, 1)) for _ in layouts]


def test_slope_is_that_of_the_cost() -> None:
    limited = replace(unlimited(LEVELS), sensors=0.6 * LEVELS.sensors, inputs=0.6 * LEVELS.inputs)
    surface, x = CostSurface.of(*drawn(), limited), np.linspace(-0.3, 0.3, 9)
    exact = surface.gradient(surface.at(x))
    for k, each in enumerate(1e-5 * np.eye(9)):
        assert exact[k] == pytest.approx((surface.at(x + each).cost - surface.at(x - each).cost) / 2e-5, rel=1e-4)


def test_information_is_what_its_formula_says() -> None:
    """½ rᵀ V⁻¹ V_k V⁻¹ V_l V⁻¹ r with all matrices written out, limits included."""
    limited = replace(unlimited(LEVELS), sensors=0.6 * LEVELS.sensors, inputs=0.6 * LEVELS.inputs)
    surface, x = CostSurface.of(*drawn(), limited), np.linspace(-0.3, 0.3, 9)
    expected = np.eye(9)
    for piece in surface.pieces:
        inverse = np.linalg.inv(piece.block.covariance(limited.levels(x)) + piece.moved)
        slopes = [
            (piece.block.covariance(limited.levels(x + e)) - piece.block.covariance(limited.levels(x - e))) / 2e-5
            for e in 1e-5 * np.eye(9)
        ]
        moved = np.array([each @ inverse @ piece.residual for each in slopes])
        expected += 0.5 * moved @ inverse @ moved.T
    assert_allclose(surface.information(surface.at(x)), expected, rtol=1e-5)


def test_a_secant_keeps_what_was_seen_and_stays_positive_definite() -> None:
    rng = np.random.default_rng(1)
    curvature, step = np.diag([1.0, 10.0, 100.0]), rng.standard_normal(3)
    change = np.array([[2.0, 0.5, 0.0], [0.5, 8.0, 1.0], [0.0, 1.0, 50.0]]) @ step
    assert_allclose(secant(curvature, step, change) @ step, change)
    assert np.linalg.eigvalsh(secant(curvature, step, -change)).min() > 0.0


def test_a_search_from_noise_a_hundred_times_too_quiet_takes_few_evaluations(monkeypatch: pytest.MonkeyPatch) -> None:
    """Secants alone take four times as many; average information of the first place alone does not end in time."""
    evaluations: list[float] = []
    at = CostSurface.at

    def counted(self: CostSurface, x: np.ndarray) -> SearchPoint:
        found = at(self, x)
        evaluations.append(found.cost)
        return found

    monkeypatch.setattr(CostSurface, "at", counted)
    layouts, residuals, jitter = drawn()
    prior = LEVELS.at(LEVELS.logarithms() + 0.5)
    loud = NoisePriors(prior, 2.0 * np.eye(9), np.full(2, np.inf), np.full(1, np.inf))
    quiet = LEVELS.times(np.full(2, 0.01), np.full(1, 0.01))
    _, _, nats = most_likely(layouts, residuals, jitter, loud, quiet)
    assert len(evaluations) < 30
    assert nats == pytest.approx(most_likely(layouts, residuals, jitter, loud, LEVELS)[2], abs=1e-5)


def test_a_search_sets_out_from_the_likeliest_of_the_levels_that_are_known(monkeypatch: pytest.MonkeyPatch) -> None:
    """A place that is left at once takes no slope."""
    slope, slopes = CostSurface.gradient, []

    def counted(self: CostSurface, place: SearchPoint) -> np.ndarray:
        slopes.append(place.x)
        return slope(self, place)

    monkeypatch.setattr(CostSurface, "gradient", counted)
    layouts, residuals, jitter = drawn()
    loud = NoisePriors(LEVELS.at(LEVELS.logarithms() + 0.5), 2.0 * np.eye(9), np.full(2, np.inf), np.full(1, np.inf))
    quiet = LEVELS.times(np.full(2, 0.01), np.full(1, 0.01))
    end, _, nats = most_likely(layouts, residuals, jitter, loud, quiet)
    far = len(slopes)
    again = most_likely(layouts, residuals, jitter, loud, quiet, others=[quiet, end, LEVELS])
    assert again[2] == pytest.approx(nats, abs=1e-5)
    assert len(slopes) - far <= 3 < far


def test_a_search_that_falls_far_again_takes_information_anew() -> None:
    """Secants of where a step gained little, kept on a slope that is long again, end a third of a nat short here."""
    rng = np.random.default_rng(18)
    layouts = [layout() for _ in range(5)]
    residuals = [noise_of(each, LEVELS, rng) for each in layouts]
    jitter = [0.05 * np.ones((COUNT, 2, 1)) for _ in layouts]
    prior = LEVELS.at(LEVELS.logarithms() + rng.normal(0.0, 1.0, 9))
    limit = float(rng.uniform(0.4, 1.5))
    beliefs = NoisePriors(prior, 2.0 * np.eye(9), limit * LEVELS.sensors, limit * LEVELS.inputs)
    start = LEVELS.at(LEVELS.logarithms() + rng.normal(0.0, 1.5, 9))
    there, _, nats = most_likely(layouts, residuals, jitter, beliefs, start)
    assert nats == pytest.approx(most_likely(layouts, residuals, jitter, beliefs, there)[2], abs=1e-3)
    assert nats == pytest.approx(most_likely(layouts, residuals, jitter, beliefs, prior)[2], abs=1e-3)


def test_a_search_ends_where_steps_no_longer_move(monkeypatch: pytest.MonkeyPatch) -> None:
    """From the third place on every step leads uphill, as rounding may have it, however short it is."""
    layouts, residuals, jitter = drawn()
    near = most_likely(layouts, residuals, jitter, unlimited(LEVELS), LEVELS)[0]
    at, count = CostSurface.at, [0]

    def uphill(self: CostSurface, x: np.ndarray) -> SearchPoint:
        found = at(self, x)
        count[0] += 1
        return replace(found, cost=found.cost + count[0]) if count[0] > 2 else found

    monkeypatch.setattr(CostSurface, "at", uphill)
    start = near.times(np.full(2, 1.02), np.full(1, 1.02))
    found, _, nats = most_likely(layouts, residuals, jitter, unlimited(LEVELS), start, rounds=400)
    assert 10 < count[0] < 100
    assert np.isfinite(nats) and np.isfinite(found.logarithms()).all()
