"""Delays and filters: exact on samples and ramps, and the order of their error between."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import signal
from scipy.interpolate import CubicHermiteSpline

from geocontact.chain.history import delayed, lagged


def column(values: np.ndarray) -> np.ndarray:
    return values[:, None].copy()


@pytest.mark.parametrize("steps", [1, 3, 17])
def test_a_delay_of_whole_samples_is_exact(steps: int) -> None:
    values = np.random.default_rng(0).normal(size=60)
    got = delayed(np.arange(60) / 64.0, column(values), steps / 64.0)[:, 0]
    np.testing.assert_array_equal(got[steps:], values[:-steps])


def delay_error(count: int) -> float:
    time = np.linspace(0.0, 5.0, count)
    got = delayed(time, column(np.sin(3.0 * time)), 0.123)[:, 0]
    late = time > 0.5
    return float(np.abs(got - np.sin(3.0 * (time - 0.123)))[late].max())


def test_between_samples_a_delay_is_of_third_order() -> None:
    counts = np.array([101, 201, 401, 801])
    order = -np.polyfit(np.log(counts - 1.0), np.log([delay_error(n) for n in counts]), 1)[0]
    assert order > 2.5


def test_a_parabola_is_delayed_exactly_at_unequal_steps() -> None:
    time = np.cumsum(np.random.default_rng(6).uniform(0.02, 0.2, 60))
    got = delayed(time, column(time**2 - 3.0 * time), 0.137)[:, 0]
    late = (time - 0.137 > time[1]) & (time - 0.137 < time[-2])
    np.testing.assert_allclose(got[late], ((time - 0.137) ** 2 - 3.0 * (time - 0.137))[late], rtol=1e-12, atol=1e-12)


def test_before_the_first_sample_it_runs_straight_within_its_range() -> None:
    time = np.arange(50) * 0.1
    rising = delayed(time, column(2.0 + time), 0.3)[:, 0]
    np.testing.assert_allclose(rising[:3], 2.0)  # nothing below 2 was ever there
    swinging = delayed(time, column(np.cos(time) * time + time), 0.2)[:, 0]
    assert swinging[0] >= (np.cos(time) * time + time).min()


def test_unequal_steps_and_missing_values() -> None:
    time = np.array([0.0, 0.1, 0.3, 0.4, 0.45, 0.6, 0.8, 0.9])
    values = np.array([0.0, 0.1, 0.3, np.nan, 0.45, 0.6, 0.8, 0.9])
    got = delayed(time, column(values), 0.05)[:, 0]
    want = time - 0.05
    there = np.isfinite(got)
    np.testing.assert_allclose(got[there][1:], want[there][1:], atol=1e-12)
    assert not there[3:5].any()
    assert not np.isfinite(lagged(time, column(values), 0.1, 2.0)[3, 0])


@pytest.mark.parametrize("order", [1.0, 1.3, 1.999999, 2.0])
def test_a_filtered_ramp_lags_by_the_lag(order: float) -> None:
    time = np.sort(np.random.default_rng(5).uniform(0.0, 6.0, 300))
    got = lagged(time, column(4.0 * time - 12.0), 0.15, order)[:, 0]
    late = time > time[0] + 3.0
    np.testing.assert_allclose(got[late], 4.0 * (time[late] - 0.15) - 12.0, rtol=1e-8, atol=1e-8)


@pytest.mark.parametrize(("order", "slow", "quick"), [(1.0, 0.2, 0.0), (1.5, 0.15, 0.05), (2.0, 0.1, 0.1)])
def test_filter_is_exact_for_the_cubic_between_samples_in_four_straight_pieces(
    order: float, slow: float, quick: float
) -> None:
    values = np.random.default_rng(4).normal(size=80)
    values[:30] = values[0]  # sets out at rest
    time = np.arange(80) * 0.07
    got = lagged(time, column(values), 0.2, order)[:, 0]
    fine = np.arange(4 * 79 + 1) * 0.07 / 4
    cubic = CubicHermiteSpline(time, values, np.gradient(values, 0.07, edge_order=1))(fine)
    system = signal.lti([1.0], np.polymul([slow, 1.0], [quick, 1.0]))
    _, want, _ = signal.lsim(system, cubic - values[0], fine, interp=True)
    np.testing.assert_allclose(got, want[::4] + values[0], rtol=1e-9, atol=1e-9)


def test_filter_over_uneven_steps_solves_its_differential_equations() -> None:
    """Columns that share their times, one at rest at first and one missing in the middle: Runge and Kutta's rule."""
    rng = np.random.default_rng(8)
    time = np.cumsum(rng.uniform(0.02, 0.12, 40))
    values = rng.normal(size=(40, 2))
    values[:2, 0], values[17, 1] = values[0, 0], np.nan
    got = lagged(time, values, 0.2, 1.5)
    spline, state = CubicHermiteSpline(time, values[:, 0], np.gradient(values[:, 0], time)), np.full(2, values[0, 0])
    for i in range(1, 40):
        for a in np.linspace(time[i - 1], time[i], 5)[:-1]:
            state = _runge_kutta(state, float(spline(a)), float(spline(a + (time[i] - time[i - 1]) / 4)), time, i)
        if i > 1:
            assert got[i, 0] == pytest.approx(state[1], abs=1e-7)
    assert np.isnan(got[17, 1])
    np.testing.assert_array_equal(got[:, 1], lagged(time, values[:, 1:], 0.2, 1.5)[:, 0])


def _runge_kutta(state: np.ndarray, start: float, end: float, time: np.ndarray, i: int) -> np.ndarray:
    """Both stages (0.15 s, 0.05 s) a quarter of a step on, for an input that runs straight from `start` to `end`."""
    h, parts = (time[i] - time[i - 1]) / 4, 50

    def slope(x: np.ndarray, share: float) -> np.ndarray:
        return np.array([(start + share * (end - start) - x[0]) / 0.15, (x[0] - x[1]) / 0.05])

    for k in range(parts):
        step, at = h / parts, k / parts
        one = slope(state, at)
        two = slope(state + 0.5 * step * one, at + 0.5 / parts)
        three = slope(state + 0.5 * step * two, at + 0.5 / parts)
        four = slope(state + step * three, at + 1.0 / parts)
        state = state + step / 6.0 * (one + 2.0 * two + 2.0 * three + four)
    return state


@pytest.mark.parametrize("order", [1.0, 2.0])
def test_a_lag_far_shorter_than_a_step_is_a_delay(order: float) -> None:
    time = np.arange(200) * 0.04
    values = column(np.sin(6.0 * time))
    filtered, late = lagged(time, values, 0.002, order), delayed(time, values, 0.002)
    moved = np.abs(late - values)[5:].max()
    assert np.abs(filtered - late)[5:].max() < 0.05 * moved


def test_no_lag_and_no_delay_are_exactly_nothing() -> None:
    values = column(np.random.default_rng(4).normal(size=20))
    np.testing.assert_array_equal(lagged(np.arange(20.0), values, 0.0, 1.5), values)
    np.testing.assert_array_equal(delayed(np.arange(20.0), values, 0.0), values)


def test_a_very_short_second_stage_is_a_wire() -> None:
    time, values = np.arange(40) * 0.1, column(np.sin(np.arange(40.0)))
    np.testing.assert_allclose(lagged(time, values, 0.2, 1.0 + 1e-7), lagged(time, values, 0.2, 1.0), atol=1e-6)
