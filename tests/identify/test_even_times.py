"""Curves of an uneven recording on even times."""

from __future__ import annotations

import numpy as np

from geocontact.identify.signals.agreement import agreement
from geocontact.identify.signals.filters import at_times, even_times

EVEN = 0.02 * np.arange(200)
UNEVEN = np.concatenate([EVEN[:15], EVEN[25:100], EVEN[100::2]])
"""Ten samples lost, and every second one from 2 s on."""


def test_even_times_are_left_alone() -> None:
    time, step = even_times(EVEN + 1e-4 * np.sin(np.arange(200)))
    assert len(time) == 200 and abs(step - 0.02) < 3e-4
    curve = np.cos(time)
    assert at_times(time, curve, time, step) is curve


def test_a_straight_curve_is_kept_and_gaps_are_empty() -> None:
    time, step = even_times(UNEVEN)
    assert np.allclose(np.diff(time), step) and time[0] == 0.0 and time[-1] <= UNEVEN[-1] + 1e-12
    found = at_times(UNEVEN, 3.0 * UNEVEN + 1.0, time, step)
    there = np.isfinite(found)
    np.testing.assert_allclose(found[there], 3.0 * time[there] + 1.0, atol=1e-12)
    lost = (time > EVEN[14] + 1e-9) & (time < EVEN[25] - 1e-9)
    assert lost.any() and not there[lost].any() and there[(time < 0.28) | ((time > 0.52) & (time < 1.9))].all()


def test_a_lag_is_that_of_the_clock() -> None:
    """0.1 s, which an index of samples takes for two thirds of it."""
    time, step = even_times(UNEVEN)

    def load(t: np.ndarray) -> np.ndarray:
        return np.exp(-0.5 * ((t - 1.9) / 0.35) ** 2) + 0.3 * np.sin(5.0 * t)

    model, ours = (at_times(UNEVEN, load(UNEVEN - late), time, step) for late in (0.1, 0.0))
    assert abs(agreement(model, ours, step).lag - 0.1) < 2e-3
