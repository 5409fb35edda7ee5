"""A recording cut into cycles."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.identify.signals.cycles import cut


def test_a_linear_signal_is_resampled_exactly() -> None:
    time = np.sort(np.random.default_rng(0).uniform(0.0, 3.0, 200))
    starts = np.array([0.2, 1.3, 2.7])
    found = cut(time, 5.0 * time - 1.0, starts)
    share = np.linspace(0.0, 1.0, 101)
    expected = [5.0 * (a + (b - a) * share) - 1.0 for a, b in ((0.2, 1.3), (1.3, 2.7))]
    np.testing.assert_allclose(found, expected, rtol=0.0, atol=1e-12)


def test_interpolation_is_of_second_order() -> None:
    steps = np.array([50, 100, 200, 400])
    errors = []
    for n in steps:
        time = np.linspace(0.0, 1.0, n + 1)
        found = cut(time, np.sin(6.0 * time), np.array([0.013, 0.989]))[0]
        errors.append(np.abs(found - np.sin(6.0 * np.linspace(0.013, 0.989, 101))).max())
    order = -np.polyfit(np.log(steps), np.log(errors), 1)[0]
    assert order == pytest.approx(2.0, abs=0.2)


def test_gaps_are_not_bridged() -> None:
    values = np.arange(101.0)
    values[40:50] = np.nan
    found = cut(np.arange(101.0), values, np.array([0.0, 100.0]))[0]
    np.testing.assert_array_equal(np.flatnonzero(np.isnan(found)), np.arange(40, 50))


@pytest.mark.parametrize(
    ("time", "starts", "said"),
    [
        ([0.0, 1.0, 1.0], [0.0, 1.0], "time: not strictly increasing"),
        ([0.0, 1.0, 2.0], [0.0], "two or more, increasing"),
        ([0.0, 1.0, 2.0], [1.0, 0.0], "two or more, increasing"),
        ([0.0, 1.0, 2.0], [0.0, 2.5], "0 to 2.5 s, but the recording has 0 to 2 s"),
    ],
)
def test_what_cannot_be_cut_is_refused(time: list[float], starts: list[float], said: str) -> None:
    with pytest.raises(ValueError, match=said):
        cut(np.array(time), np.array([1.0, 2.0, 3.0]), np.array(starts))
