"""How curves agree: closed forms of the errors, lags of shifted curves."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.identify.signals.agreement import (
    agreement,
    by_phase,
    gain_off,
    over_stretches,
    overlap,
    per_phase,
    samples_within,
)
from geocontact.identify.signals.filters import zero_lag

STEP = 0.02
TIME = STEP * np.arange(400)


def curve(late: float = 0.0) -> np.ndarray:
    return np.sin(1.7 * (TIME - late)) + 0.4 * np.sin(4.1 * (TIME - late) + 0.3)


def test_a_constant_offset_and_a_gain() -> None:
    found = agreement(curve() + 0.25, curve(), STEP)
    assert found.mae == pytest.approx(0.25) and found.rmsd == pytest.approx(0.25) and found.bias == pytest.approx(0.25)
    spread = curve() - curve().mean()
    assert found.r2 == pytest.approx(1.0 - len(TIME) * 0.0625 / (spread @ spread))
    assert agreement(1.1 * curve(), curve(), STEP).correlation == pytest.approx(1.0)


@pytest.mark.parametrize("late", [-0.23, -0.011, 0.0, 0.033, 0.31])
def test_lags_are_found_to_a_fraction_of_a_sample(late: float) -> None:
    assert agreement(curve(late), curve(), STEP).lag == pytest.approx(late, abs=0.003)


def test_missing_samples_do_not_count() -> None:
    model, measured = curve() + 0.1, curve()
    model[50:70] = np.nan
    measured[100] = np.nan
    found = agreement(model, measured, STEP)
    assert found.samples == 379 and found.mae == pytest.approx(0.1)
    nothing = agreement(np.full(9, np.nan), np.ones(9), STEP)
    assert nothing.samples == 0 and np.isnan(nothing.mae)
    assert np.isnan(agreement(curve(), np.ones(len(TIME)), STEP).r2)


def test_phases_say_where_it_is_off() -> None:
    model = curve()
    model[200:240] += 2.0
    worst = [each.mae for each in per_phase(model, curve(), STEP, 10)]
    assert np.argmax(worst) == 5 and worst[5] == pytest.approx(2.0) and worst[0] == pytest.approx(0.0)


@pytest.mark.parametrize("step", [0.005, 0.02])
@pytest.mark.parametrize(("frequency", "kept"), [(0.5, 1.0), (6.0, 0.5**0.5), (24.0, 0.0)])
def test_zero_lag_filter_halves_the_power_at_its_cut_off(frequency: float, kept: float, step: float) -> None:
    time = step * np.arange(4000)
    wave = np.sin(2.0 * np.pi * frequency * time)
    passed = zero_lag(wave[:, None], step, 6.0)[500:-500, 0]
    assert np.sqrt(2.0 * np.mean(passed**2)) == pytest.approx(kept, abs=0.02)
    if kept > 0.5:
        assert agreement(passed, wave[500:-500], step, 0.05).lag == pytest.approx(0.0, abs=1e-4)


def test_a_cut_off_beyond_the_sampling_is_refused() -> None:
    with pytest.raises(ValueError, match="needs to lie between"):
        zero_lag(np.zeros(100), 0.1, 6.0)
    with pytest.raises(ValueError, match="too few"):
        zero_lag(np.zeros(4), 0.005, 6.0)


def cycles(late: float) -> tuple[np.ndarray, list[tuple[int, int]]]:
    """A bump in each of three cycles, in a phase of 60 samples; what lies between is another curve."""
    at = np.full(len(TIME), 5.0)
    stretches = [(20, 80), (150, 210), (300, 360)]
    for first, last in stretches:
        middle = 0.5 * (TIME[first] + TIME[last - 1])
        at[first:last] = np.exp(-(((TIME[first:last] - middle - late) / 0.15) ** 2))
    return at, stretches


@pytest.mark.parametrize("late", [-0.11, 0.0, 0.07])
def test_a_phase_that_comes_back_is_pooled_and_tells_its_lag(late: float) -> None:
    model, stretches = cycles(late)
    measured, _ = cycles(0.0)
    found = over_stretches(model, measured, STEP, stretches)
    inside = np.concatenate([np.arange(a, b) for a, b in stretches])
    assert found.samples == 180
    assert found.rmsd == pytest.approx(np.sqrt(np.mean((model - measured)[inside] ** 2)))
    assert found.lag == pytest.approx(late, abs=0.004) and found.correlation > 0.995


def test_pairs_of_samples_never_reach_into_the_next_stretch() -> None:
    """What lies outside, and how stretches follow one another, does not matter."""
    model, stretches = cycles(0.07)
    measured, _ = cycles(0.0)
    outside = np.ones(len(TIME), bool)
    for a, b in stretches:
        outside[a:b] = False
    plain = over_stretches(model, measured, STEP, stretches)
    assert over_stretches(np.where(outside, -90.0, model), measured, STEP, stretches) == plain
    one, other = (2.0 * np.sin(9.0 * (TIME - late)) + TIME for late in (0.05, 0.0))
    ahead, turned = (over_stretches(one, other, STEP, each) for each in (stretches, stretches[::-1]))
    assert ahead.lag == pytest.approx(0.05, abs=0.01)
    assert (turned.lag, turned.correlation) == pytest.approx((ahead.lag, ahead.correlation), rel=1e-9)


@pytest.mark.parametrize("stretches", [[(0, 200), (200, 219)], [(0, 12)]])
def test_a_short_stretch_tells_no_lag(stretches: list[tuple[int, int]]) -> None:
    found = over_stretches(curve(0.1), curve(), STEP, stretches)
    assert np.isnan(found.lag) and found.rmsd > 0.0
    a, b = np.concatenate([np.arange(*each) for each in stretches])[[0, -1]]
    assert found.correlation == pytest.approx(np.corrcoef(curve(0.1)[a : b + 1], curve()[a : b + 1])[0, 1])


def test_a_steady_rise_tells_no_lag() -> None:
    """Every shift of a straight line is a straight line; so is nearly every one of the rise to a plateau's foot."""
    ramp = over_stretches(TIME + 0.2, TIME, STEP, [(50, 150)])
    assert np.isnan(ramp.lag) and ramp.correlation == pytest.approx(1.0)
    assert np.isnan(over_stretches(np.ones(400), curve(), STEP, [(50, 150)]).lag)
    late = over_stretches(curve(0.9), curve(), STEP, [(50, 150)])
    assert np.isnan(late.lag), "a lag beyond the range that is looked at is not one at its end"


def test_samples_of_a_phase_include_its_ends_though_they_are_rounded() -> None:
    time = np.array([0.0, 0.1, 0.2, 0.3, 0.4])
    assert samples_within(time, 0.1, 0.3) == (1, 4)
    assert samples_within(time, 0.1 + 5e-7, 0.3 - 5e-7) == (1, 4)
    assert samples_within(time, 0.11, 0.19) == (2, 2)


def test_stretches_overlap_where_they_share_a_sample() -> None:
    assert not overlap([(5, 9), (0, 5)])
    assert overlap([(5, 9), (0, 6)])


def test_phases_that_are_named_are_taken_together_and_else_parts() -> None:
    model = curve() + np.where(np.arange(len(TIME)) < 100, 1.0, 0.0)
    named = by_phase(model, curve(), STEP, {"early": [(0, 50), (50, 100)], "mixed": [(0, 100), (200, 300)]})
    assert list(named) == ["all", "early", "mixed"]
    assert [each.mae for each in named.values()] == pytest.approx([0.25, 1.0, 0.5])
    parts = by_phase(model, curve(), STEP, parts=4)
    assert list(parts) == ["all", "0-25 %", "25-50 %", "50-75 %", "75-100 %"]
    assert [each.mae for each in parts.values()] == pytest.approx([0.25, 1.0, 0.0, 0.0, 0.0])


def test_an_offset_is_no_gain() -> None:
    """A half sine of 20 N that was recorded 6 N higher is fitted by 1.38 times it: a constant takes all there."""
    force = 20.0 * np.sin(np.pi * np.arange(101) / 100.0)
    assert gain_off(force, 1.35 * force) == pytest.approx(1.35)
    assert float(force @ (force + 6.0) / (force @ force)) == pytest.approx(1.38, abs=0.01)
    assert gain_off(force, force + 6.0) == 1.0
