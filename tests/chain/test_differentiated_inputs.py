"""Derivatives of measured inputs: exact for cubics however they are sampled, with the frequency response promised."""

from __future__ import annotations

import gc

import numpy as np
import pytest

from geocontact.chain import differentiated_inputs as module
from geocontact.chain.differentiated_inputs import differentiated_inputs, rate_of_waves, recorded
from geocontact.data.motion import Signals


def of(time: np.ndarray, values: np.ndarray) -> module.DifferentiatedInputs:
    return differentiated_inputs(time, ("a",), values[None])


@pytest.mark.parametrize("step", [0.002, 0.005, 0.02, 0.035, 0.04, 0.3])
def test_cubics_are_exact_at_unequal_steps_and_over_missing_rows(step: float) -> None:
    rng = np.random.default_rng(3)
    time = np.cumsum(step * rng.uniform(0.4, 1.6, 200))
    time = np.delete(time, slice(60, 75))
    s = (time - time[90]) / step / 50.0
    got = of(time, 0.3 - s + 0.5 * s**2 - 0.2 * s**3)
    unit = 1.0 / step / 50.0
    np.testing.assert_allclose(got.rate[0], unit * (-1.0 + s - 0.6 * s**2), rtol=1e-7, atol=1e-8 * unit)
    np.testing.assert_allclose(got.acceleration[0], unit**2 * (1.0 - 1.2 * s), rtol=1e-5, atol=1e-5 * unit**2)


@pytest.mark.parametrize(("frequency", "kept"), [(0.5, 1.0), (2.0, 0.9995), (4.0, 0.993), (6.0, 0.967)])
def test_six_hertz_pass_at_200_hz(frequency: float, kept: float) -> None:
    time = np.arange(601) * 0.005
    omega = 2.0 * np.pi * frequency
    got = of(time, np.sin(omega * time))
    gain = 2.0 * np.mean((got.rate[0] / omega * np.cos(omega * time))[100:500])
    assert gain == pytest.approx(kept, abs=5e-4)
    gain = -2.0 * np.mean((got.acceleration[0] / omega**2 * np.sin(omega * time))[100:500])
    assert gain == pytest.approx(kept**2, abs=1e-3)


@pytest.mark.parametrize("step", np.linspace(0.01, 0.08, 29))
def test_no_step_makes_the_fit_degenerate(step: float) -> None:
    values = np.random.default_rng(8).normal(size=60)
    got = of(np.arange(60) * step, values)
    assert np.abs(got.rate).max() < 20.0 * np.abs(np.diff(values)).max() / step


def test_coarse_sampling_gives_the_fourth_order_difference() -> None:
    rng = np.random.default_rng(1)
    values = rng.normal(size=40)
    got = of(np.arange(40) * 0.04, values).rate[0]
    want = (values[:-4] - 8.0 * values[1:-3] + 8.0 * values[3:-1] - values[4:]) / (12.0 * 0.04)
    np.testing.assert_allclose(got[2:-2], want, rtol=1e-9, atol=1e-9)


def test_noise_of_high_frequency_is_damped() -> None:
    noise = np.random.default_rng(2).normal(size=4000)
    got = of(np.arange(4000) * 0.005, noise).rate[0]
    assert got[20:-20].std() < 0.12 * np.gradient(noise, 0.005).std()
    assert np.abs(got[[0, -1]]).max() < 100.0  # at the ends the window looks one way, and as far as it does elsewhere


@pytest.mark.parametrize("reach", [0.0, 0.035, 0.07])
@pytest.mark.parametrize(("frequency", "step"), [(2.0, 0.005), (9.0, 0.005), (20.0, 0.005), (3.0, 0.04)])
def test_rates_of_waves_are_those_that_a_recording_is_given(frequency: float, step: float, reach: float) -> None:
    time = step * np.arange(4000)
    signals = Signals(time, np.sin(2.0 * np.pi * frequency * time)[:, None], ("u",), ("rad",))
    rate = recorded(signals, ("u",), reach).rate[0, 60:-60]
    seen = np.sqrt(2.0 * np.mean(rate**2))
    assert rate_of_waves(np.array([frequency]), step, reach)[0] == pytest.approx(seen, rel=0.02)


def test_empty_cells_are_bridged_and_the_rest_is_left_as_measured() -> None:
    time = np.arange(50) * 0.04
    values = np.sin(time)
    holes = values.copy()
    holes[[0, 20, 21, 49]] = np.nan
    got = of(time, holes)
    there = np.isfinite(holes)
    np.testing.assert_array_equal(got.position[0, there], values[there])
    np.testing.assert_allclose(got.position[0], values, atol=2e-5)


def test_an_input_without_any_value_is_refused() -> None:
    with pytest.raises(ValueError, match="input a has no value"):
        of(np.arange(9.0), np.full(9, np.nan))


@pytest.mark.parametrize("rows", [1, 2, 3, 4])
def test_very_short_recordings_do_not_fail(rows: int) -> None:
    time = np.arange(rows) * 0.1
    got = of(time, 3.0 * time)
    np.testing.assert_allclose(got.rate[0], 3.0 if rows > 1 else 0.0, atol=1e-9)


def test_what_is_remembered_goes_with_its_recording() -> None:
    signals = Signals(np.arange(9.0), np.arange(9.0)[:, None], ("a",), ("m",))
    key = (id(signals), ("a",), module.REACH)
    recorded(signals, ("a",))
    assert key in module._SEEN
    del signals
    gc.collect()
    assert key not in module._SEEN


def fresh(*arguments: object) -> np.ndarray:
    """A fit of which nothing is remembered."""
    module._remembered.cache_clear()
    return module.local_fit(*arguments)


def test_weights_are_remembered_by_times_reach_neighbours_and_degree() -> None:
    rng = np.random.default_rng(4)
    time, values = np.cumsum(rng.uniform(0.004, 0.012, 150)), rng.standard_normal((2, 150))
    gone = np.delete(time, slice(40, 60))
    asked = [
        (time, values, time, 0.07, 5, 3), (time, values, time, 0.035, 5, 3), (time, values, time, 0.07, 9, 3),
        (time, values, time, 0.07, 5, 2), (time, values, time[:50], 0.07, 5, 3),
        (gone, np.delete(values, slice(40, 60), axis=1), time, 0.07, 5, 3),
    ]  # fmt: skip
    alone = [fresh(*each) for each in asked]
    module._remembered.cache_clear()
    for _ in range(2):
        for each, want in zip(asked, alone, strict=True):
            np.testing.assert_array_equal(module.local_fit(*each), want)
    assert module._remembered.cache_info().hits == len(asked)


def test_a_long_recording_is_fitted_piece_by_piece() -> None:
    time = 0.001 * np.arange(module.PIECE + 700)
    values = np.sin(3.0 * time)[None]
    module._remembered.cache_clear()
    got = module.local_fit(time, values, time, 0.01, 5, 3)
    assert not module._remembered.cache_info().currsize
    np.testing.assert_allclose(got[1, 0], 3.0 * np.cos(3.0 * time), atol=1e-3)
    middle = module.local_fit(time, values, time[1500:2500], 0.01, 5, 3)
    np.testing.assert_allclose(middle, got[:, :, 1500:2500], rtol=1e-12)


def test_times_may_be_of_single_precision() -> None:
    time = np.arange(8, dtype=np.float32)
    np.testing.assert_allclose(of(time, np.arange(8.0) ** 2).rate[0], 2.0 * np.arange(8.0), atol=1e-9)
