"""A curve that is later and swings more than another one: found to a fraction of a step, with intervals that hold."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.identify.signals.cycles import style_shift

STEPS = np.arange(101.0)


def curve(later: float, size: float = 1000.0) -> np.ndarray:
    return size * (
        np.exp(-(((STEPS - 25.0 - later) / 9.0) ** 2)) + 0.7 * np.exp(-(((STEPS - 60.0 - later) / 10.0) ** 2))
    )


@pytest.mark.parametrize("later", [-7.3, 0.0, 4.6])
def test_a_shifted_and_larger_curve_is_found(later: float) -> None:
    found = style_shift(curve(later, 1200.0)[None], curve(0.0)[None])
    assert found.later.value == pytest.approx(later, abs=0.05) and found.correlation > 0.998
    assert found.peak_later.value == pytest.approx(later, abs=0.5)
    assert found.swing.value == pytest.approx(np.ptp(curve(later, 1200.0)) - np.ptp(curve(0.0)), rel=1e-12)
    assert np.isnan([found.later.lower, found.swing.upper, found.peak.lower]).all()


@pytest.mark.slow
def test_intervals_hold_the_truth_as_often_as_they_say() -> None:
    """Six cycles each that vary in size by 5 % and in time by 1.5 steps; percentiles of so few are a little narrow."""
    rng = np.random.default_rng(0)
    held = np.zeros(2)
    for seed in range(60):
        style, reference = (
            np.array([curve(at + rng.normal(0, 1.5), size * (1 + rng.normal(0, 0.05))) for _ in range(6)])
            for at, size in ((3.0, 1100.0), (0.0, 1000.0))
        )
        found = style_shift(style, reference, seed)
        held += found.later.lower <= 3.0 <= found.later.upper, found.peak.lower <= 100.0 <= found.peak.upper
    assert (held / 60 >= 0.8).all(), held / 60
