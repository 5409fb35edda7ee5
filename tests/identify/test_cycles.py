"""Cycles: onsets and ends of a load against closed forms, noise at the level, and the way to 0 … 100 %."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geocontact.data.trial import mean_and_sd
from geocontact.identify.signals.agreement import rms_difference
from geocontact.identify.signals.cycles import STEPS, Span, loaded_spans, normalised, strides

PERIOD, PEAK = 1.1, 1500.0
TIME = np.arange(0.0, 5.0, 1.0 / 120.0)


def walk(time: np.ndarray, phase: float = 0.3) -> np.ndarray:
    """Synthetic load: a raised cosine per stride, on from its level for a known part of it."""
    return 0.5 * PEAK * (1.0 - np.cos(2.0 * np.pi * (time - phase) / PERIOD))


def crossings(level: float, phase: float = 0.3) -> tuple[np.ndarray, np.ndarray]:
    """Where `walk` rises and falls through the level, every stride."""
    half = np.arccos(1.0 - 2.0 * level / PEAK) / (2.0 * np.pi) * PERIOD
    start = phase + PERIOD * np.arange(-2, 8)
    return start + half, start + PERIOD - half


@given(st.floats(100.0, 1200.0), st.floats(0.0, PERIOD))
def test_onsets_and_ends_are_those_of_the_curve(level: float, phase: float) -> None:
    found = loaded_spans(TIME, walk(TIME, phase), level)
    rises, falls = crossings(level, phase)
    # a load that is on for all but a moment, or begins or ends at the rim of the recording, may be cut
    inside = [(r, f) for r, f in zip(rises, falls, strict=True) if r > TIME[0] + 0.2 and f < TIME[-1] - 0.2]
    for rise, fall in inside:
        assert any(abs(s.start - rise) < 2e-3 and abs(s.end - fall) < 2e-3 for s in found), (level, phase)
    assert len(found) <= len(inside) + 2
    assert all(0.3 < s.end - s.start < PERIOD for s in found)


def test_strides_run_from_onset_to_onset() -> None:
    found = strides(TIME, walk(TIME), 400.0)
    assert len(found) == 4
    assert [s.end - s.start for s in found] == pytest.approx([PERIOD] * 4, abs=2e-3)
    assert all(a.end == b.start for a, b in pairwise(found))


def test_incomplete_loads_are_left_out() -> None:
    """The recording begins and ends under load."""
    time = TIME[(TIME > 0.8) & (TIME < 3.3)]
    found = loaded_spans(time, walk(time), 400.0)
    rises, falls = crossings(400.0)
    whole = [(r, f) for r, f in zip(rises, falls, strict=True) if r > time[0] and f < time[-1]]
    np.testing.assert_allclose([(s.start, s.end) for s in found], whole, atol=2e-3)
    assert len(strides(time, walk(time), 400.0)) == 1


@pytest.mark.parametrize("seed", range(20))
def test_noise_at_the_level_is_one_crossing(seed: int) -> None:
    noise = np.random.default_rng(seed).normal(0.0, 40.0, len(TIME))
    assert len(loaded_spans(TIME, walk(TIME) + noise, 400.0)) == len(loaded_spans(TIME, walk(TIME), 400.0)) == 4


def test_a_short_pause_ends_no_load_and_a_knock_is_none() -> None:
    load = walk(TIME)
    top, bottom = (TIME > 0.83) & (TIME < 0.90), (TIME > 1.388) & (TIME < 1.432)
    assert load[top].min() > 1400.0 and load[bottom].max() < 30.0
    spoilt = np.where(top, 0.0, np.where(bottom, 900.0, load))
    np.testing.assert_allclose(
        [(s.start, s.end) for s in loaded_spans(TIME, spoilt, 400.0)],
        [(s.start, s.end) for s in loaded_spans(TIME, load, 400.0)],
    )


def test_a_long_dip_just_below_the_level_ends_no_load() -> None:
    """A slow walker's middle of stance: 0.3 s at 0.9 of the level, then at 0.7 of it."""
    dip = (TIME > 0.7) & (TIME < 1.0)
    shallow, deep = (np.where(dip, share * 400.0, walk(TIME)) for share in (0.9, 0.7))
    assert len(loaded_spans(TIME, shallow, 400.0)) == len(loaded_spans(TIME, walk(TIME), 400.0)) == 4
    assert len(loaded_spans(TIME, deep, 400.0)) == 5


def test_no_load_no_cycles() -> None:
    assert loaded_spans(TIME, walk(TIME), 2000.0) == strides(TIME, walk(TIME), 2000.0) == []


def test_a_straight_line_stays_one_in_per_cent() -> None:
    np.testing.assert_allclose(normalised(TIME, 3.0 * TIME - 1.0, 0.77, 2.13), 3.0 * (0.77 + 1.36 * STEPS / 100) - 1.0)
    assert len(normalised(TIME, TIME, 0.0, float(TIME[-1]))) == 101


def test_span_of_a_gap_is_missing() -> None:
    values = np.where((TIME > 1.0) & (TIME < 1.2), np.nan, TIME)
    out = normalised(TIME, values, 0.5, 2.5)
    assert np.isnan(out[26:35]).all() and np.isfinite(out[:24]).all() and np.isfinite(out[37:]).all()


def test_rms_difference() -> None:
    wave = np.sin(2.0 * np.pi * np.arange(100) / 100.0)
    assert rms_difference(wave, np.zeros(100)) == pytest.approx(np.sqrt(0.5), rel=1e-12)
    assert rms_difference(np.array([1.0, np.nan, 5.0]), np.array([2.0, 7.0, 5.0])) == pytest.approx(np.sqrt(0.5))
    assert np.isnan(rms_difference(np.array([np.nan]), np.array([1.0])))


def test_mean_and_sd_are_numpys_where_nothing_is_missing() -> None:
    trials = np.random.default_rng(1).normal(size=(6, 30))
    mean, sd = mean_and_sd(trials)
    np.testing.assert_allclose(mean, trials.mean(axis=0), rtol=1e-12)
    np.testing.assert_allclose(sd, trials.std(axis=0, ddof=1), rtol=1e-12)
    assert np.isnan(mean_and_sd(trials[:1])[1]).all()


def test_span_holds_both_ends() -> None:
    assert Span(1.0, 2.0) == Span(start=1.0, end=2.0)
