"""Shares of the squared error: by hand, closed to 1, and noise that never takes what a model misses."""

from __future__ import annotations

import numpy as np
import pytest

from geocontact.gap.levels import DEVIATIONS
from geocontact.gap.reduction.error_budget import (
    PARTS,
    ErrorTrial,
    beyond_noise,
    deviations,
    loudest,
    share_taken,
    shares,
)


def trial(before: float, after: float, cleared: float, sensor: float, inputs: float, n: int = 240) -> ErrorTrial:
    """Errors of constant size, their signs changing from sample to sample."""
    sign = (-1.0) ** np.arange(n)
    return ErrorTrial(before * sign, after * sign, cleared * sign, np.full(n, sensor), np.full(n, inputs))


def test_parts_by_hand() -> None:
    """Of 100: effects 100 - 36, variation 36 - 25, sensor 4, inputs 1, and 20 that nothing explains."""
    found = shares([trial(10.0, 6.0, 5.0, 4.0, 1.0)] * 2)
    assert list(found) == list(PARTS)
    expected = {"sensor": 0.04, "inputs": 0.01, "variation": 0.11, "effects": 0.64, "unexplained": 0.20}
    assert {name: part.share for name, part in found.items()} == pytest.approx(expected)
    assert sum(part.share for part in found.values()) == pytest.approx(1.0)
    low, high = found["sensor"].ci95
    assert low == pytest.approx(0.04 / 1.2 ** (2.0 * 1.96), rel=0.1)
    assert high == pytest.approx(0.04 * 1.2 ** (2.0 * 1.96), rel=0.1)
    assert found["effects"].ci95 == pytest.approx((0.64, 0.64)), "all blocks are alike"


def test_noise_that_is_more_than_the_error_takes_no_more_than_there_is() -> None:
    found = shares([trial(2.0, 2.0, 2.0, 12.0, 4.0)])
    assert found["sensor"].share == pytest.approx(0.75) and found["inputs"].share == pytest.approx(0.25)
    assert found["unexplained"].share == pytest.approx(0.0, abs=1e-12)
    assert shares([]) == {} and shares([trial(0.0, 0.0, 0.0, 1.0, 0.0)]) == {}


def test_blocks_that_differ_make_an_interval_wide() -> None:
    """Half of the trial has no error: the sensor's share depends on how many such blocks are drawn."""
    half, whole = trial(0.0, 0.0, 0.0, 1.0, 0.0, 120), trial(10.0, 10.0, 10.0, 1.0, 0.0, 120)
    joined = ErrorTrial(*(np.concatenate([getattr(half, name), getattr(whole, name)]) for name in vars(half)))
    low, high = shares([joined])["unexplained"].ci95
    share = shares([joined])["unexplained"].share
    assert share == pytest.approx(1.0 - 2.0 / 100.0) and low < share < high
    assert 0.0 < high - low < 0.05


def test_no_noise_takes_what_repeats() -> None:
    """Noise of 20 in an error of 4, half of which repeats: noise gets the other half, in proportion."""
    found = shares([trial(2.0, 2.0, 2.0, 12.0, 4.0)], repeating=0.5)
    assert found["unexplained"].share == pytest.approx(0.5)
    assert found["sensor"].share == pytest.approx(0.375) and found["inputs"].share == pytest.approx(0.125)


@pytest.mark.parametrize(("size", "share"), [(1.0, 0.0), (1.6, 0.0), (4.0, (16.0 - loudest() ** 2) / 16.0)])
def test_beyond_noise_is_what_neighbours_share_above_its_largest_size(size: float, share: float) -> None:
    """A constant error beside noise of 1; one that changes its sign from sample to sample is noise, however large."""
    n = 4000
    flat = np.full(n, size)
    one = ErrorTrial(flat, flat, flat, np.ones(n), np.zeros(n))
    assert loudest() == pytest.approx(1.2 * np.exp(0.3))
    assert beyond_noise([one]) == pytest.approx(share, abs=1e-3)
    assert beyond_noise([trial(size, size, size, 1.0, 0.0)]) == 0.0 and beyond_noise([]) == 0.0
    more = ErrorTrial(flat, flat, 2.0 * flat, np.ones(n), np.zeros(n))
    assert beyond_noise([more]) == beyond_noise([one]), "what taking deviations off adds is not missed"


def test_a_trial_deviates_by_three_usual_deviations_at_most() -> None:
    """Residuals of 2 and of 5 usual deviations."""
    n = 4000
    column, there = np.full((n, 1, 1), 0.5), np.ones((n, 1), bool)
    residuals = [np.full((n, 1), 0.5 * each) for each in (2.0, 5.0)]
    found = deviations(residuals, [column] * 2, [there] * 2, np.array([0.1]))
    np.testing.assert_allclose(found[:, 0], [2.0, DEVIATIONS], rtol=1e-3)


def test_what_an_effect_takes_by_hand() -> None:
    """Squares of 100 without anything, 64 without the effect and 25 with it: 39 of 100, all blocks alike."""
    base, lacking, having = ([np.full(160, size)] * 2 for size in (10.0, 8.0, 5.0))
    assert share_taken(base, lacking, having) == pytest.approx((0.39, 0.39, 0.39))
    assert share_taken([np.zeros(160)], [np.zeros(160)], [np.zeros(160)]) is None
    growing = [np.concatenate([np.full(80, 8.0), np.full(80, 5.0)])]
    share, low, high = share_taken([np.full(160, 10.0)], [np.full(160, 8.0)], growing) or (0.0, 0.0, 0.0)
    assert share == pytest.approx(0.195) and 0.08 < low < share < high < 0.3
