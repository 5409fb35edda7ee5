"""Recordings sorted by angle: nothing is lost, empty bins stay empty, tests count what is independent."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import goodness_of_fit, norm

from geocontact.identify.intervals.bin_tests import DRAWS, between_bins, between_neighbours, lilliefors
from geocontact.identify.noise.autocorrelation import mean_covariance
from geocontact.identify.signals.angle_bins import AngleBins, angle_bins, edges_over


def recording(seed: int = 0, seconds: float = 60.0) -> tuple[np.ndarray, np.ndarray]:
    time = np.arange(0.0, seconds, 0.01)
    angle = 1.0 + 0.6 * np.sin(0.9 * time) + 0.2 * np.sin(2.3 * time + 1.0)
    return time, np.column_stack([angle, np.random.default_rng(seed).normal(size=len(time))])


def remembered(count: int, keep: float, rng: np.random.Generator) -> np.ndarray:
    out = rng.normal(size=count)
    for k in range(1, count):
        out[k] = keep * out[k - 1] + np.sqrt(1.0 - keep**2) * out[k]
    return out


def test_edges_end_where_the_recordings_do() -> None:
    """42 bins of 2 degrees are 84 degrees, not 180."""
    edges = np.degrees(edges_over([np.radians([8.1, 60.0]), np.radians([20.0, 91.9])], np.radians(2.0)))
    np.testing.assert_allclose(edges[[0, -1]], [8.0, 92.0])
    assert len(edges) - 1 == 42
    assert np.degrees(edges_over([np.radians([-3.0, 10.0])], np.radians(2.0)))[0] == pytest.approx(-4.0)


def test_means_are_those_of_the_samples_bin_by_bin() -> None:
    time, values = recording()
    edges = edges_over([values[:, 0]], np.radians(5.0))
    v = angle_bins([time], [values], edges, 7.0)
    cells = v.cells()
    place = np.digitize(values[:, 0], edges) - 1
    assert cells.count.sum() == v.count.sum() == len(time)
    for k, where in enumerate(cells.place):
        np.testing.assert_allclose(cells.means[k], values[place == where].mean(axis=0), rtol=1e-12)
    assert len(np.unique(v.stretch)) == 9


def test_a_bin_that_was_hardly_touched_is_not_reached() -> None:
    time = np.arange(0.0, 10.0, 0.01)
    angle = np.where(time < 5.0, 0.1, 0.5)
    angle[300] = 0.3
    values = np.column_stack([angle, angle])
    v = angle_bins([time], [values], edges_over([angle], 0.1), np.inf)
    assert sorted(np.round(v.means[:, 0], 9)) == [0.1, 0.5]


def test_trials_keep_stretches_of_their_own() -> None:
    pairs = [recording(k, 20.0) for k in range(3)]
    edges = edges_over([values[:, 0] for _, values in pairs], 0.1)
    v = angle_bins([t for t, _ in pairs], [c for _, c in pairs], edges, 5.0)
    owners = [set(v.trial[v.stretch == s]) for s in np.unique(v.stretch)]
    assert len(owners) == 12 and all(len(owner) == 1 for owner in owners)


def test_noise_that_remembers_is_not_taken_for_a_difference() -> None:
    """Counting samples would find one nearly always; visits keep to 5 % or below."""
    from scipy.stats import kruskal

    rng, found, naive = np.random.default_rng(1), [], []
    time, values = recording()
    edges = edges_over([values[:, 0]], np.radians(20.0))
    place = np.digitize(values[:, 0], edges) - 1
    for _ in range(60):
        values[:, 1] = remembered(len(time), 0.98, rng)
        test = between_bins(angle_bins([time], [values], edges, 5.0), 1)
        assert test is not None and test.counted < test.samples / 20
        found.append(test.p < 0.05)
        naive.append(kruskal(*[values[place == k, 1] for k in np.unique(place)]).pvalue < 0.05)
    assert np.mean(found) <= 0.1 and np.mean(naive) > 0.9


def test_a_force_that_follows_the_angle_is_a_difference() -> None:
    time, values = recording()
    values[:, 1] += 3.0 * values[:, 0]
    test = between_bins(angle_bins([time], [values], edges_over([values[:, 0]], 0.2), 5.0), 1)
    assert test is not None and test.p < 1e-6
    lone = angle_bins([time], [np.ones((len(time), 2))], np.array([0.9, 1.1]), 5.0)
    assert between_bins(lone, 1) is None


def test_a_small_p_speaks_against_normal_residuals() -> None:
    rng = np.random.default_rng(3)
    null = rng.normal(size=(DRAWS, 80))
    skewed, normal = lilliefors(rng.exponential(size=80), null), lilliefors(rng.normal(size=80), null)
    assert skewed.p < 0.01 and skewed.words.startswith("not normal") and "rejects" in skewed.words
    assert normal.p > 0.05 and "no evidence against" in normal.words and "does not prove" in normal.words


def test_p_of_independent_values_is_scipys() -> None:
    """Which fits mean and SD to draws of its own; Kolmogorov's own table would put nearly all of them above 0.5."""
    rng = np.random.default_rng(4)
    null = rng.normal(size=(DRAWS, 20))
    for k in range(5):
        values = rng.normal(size=20) ** (1 + k % 2)
        theirs = goodness_of_fit(norm, values, statistic="ks", n_mc_samples=999, rng=np.random.default_rng(k))
        ours = lilliefors(values, null)
        assert ours.distance == pytest.approx(float(theirs.statistic), rel=1e-12)
        assert ours.p == pytest.approx(float(theirs.pvalue), abs=0.08)


def test_covariance_of_bin_means_is_the_sum_over_their_pairs() -> None:
    time = np.cumsum(np.random.default_rng(6).uniform(0.01, 0.3, 200))
    place = np.random.default_rng(7).integers(0, 5, 200)
    share = (place == np.arange(6)[:, None]) / np.maximum(np.bincount(place, minlength=6), 1)[:, None]
    expected = share @ np.exp(-np.abs(time[:, None] - time) / 0.4) @ share.T
    np.testing.assert_allclose(mean_covariance(time, place, 6, 0.4), expected, rtol=1e-12, atol=1e-15)


def test_neighbouring_bins_are_told_apart_where_they_differ_only() -> None:
    """A step between the second and the third of five bins; p by Holm are those of his paper's rule worked by hand."""
    rng = np.random.default_rng(5)
    place = np.repeat(np.arange(5), 12)
    values = rng.normal(size=60) + 4.0 * (place >= 2)
    v = AngleBins(np.arange(6.0), np.zeros(60, int), np.arange(60), place, np.full(60, 20.0), values[:, None])
    found = between_neighbours(v, 0)
    assert [pair.places for pair in found] == [(0, 1), (1, 2), (2, 3), (3, 4)]
    assert [pair.p_holm < 0.05 for pair in found] == [False, True, False, False]
    p = np.array([pair.p for pair in found])
    first, second, third, last = np.argsort(p)
    by_hand = {first: 4 * p[first]}
    by_hand[second] = max(by_hand[first], 3 * p[second])
    by_hand[third] = max(by_hand[second], 2 * p[third])
    by_hand[last] = max(by_hand[third], p[last])
    np.testing.assert_allclose([pair.p_holm for pair in found], [min(by_hand[k], 1.0) for k in range(4)])
    gap = place != 2
    apart = AngleBins(v.edges, v.trial[gap], v.stretch[gap], place[gap], v.count[gap], v.means[gap])
    assert [pair.places for pair in between_neighbours(apart, 0)] == [(0, 1), (3, 4)]
