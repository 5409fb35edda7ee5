"""How curves agree: closed forms of the errors, lags of shifted curves."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.identify.agreement import agreement, per_phase
from geocontact.identify.zero_lag import zero_lag

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
