"""Cells of phase, state and rate: structure that both sets of trials have is found, by hand and at its rate."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import t

from geocontact.gap.localise.regions import touching
from geocontact.gap.localise.structure import SHAPE, StateCells, benjamini_yekutieli, followed

CELLS, FITTED, TRIALS, N = int(np.prod(SHAPE)), 3, 5, 640


def grid(rng: np.random.Generator) -> StateCells:
    """One channel, all cells equally often."""
    which = tuple(rng.permutation(np.arange(N) % CELLS)[:, None] for _ in range(TRIALS))
    return StateCells(which, ("angle",), FITTED)


def noise(rng: np.random.Generator) -> list[np.ndarray]:
    return [rng.standard_normal((N, 1)) for _ in range(TRIALS)]


def by_hand(one: StateCells, white: list[np.ndarray]) -> np.ndarray:
    """The same p-values, cell by cell."""
    means, counts = np.zeros((2, CELLS)), np.zeros((2, CELLS))
    for s, trials in enumerate((range(FITTED), range(FITTED, TRIALS))):
        for k in range(CELLS):
            own = [white[i][j, 0] for i in trials for j in range(N) if one.which[i][j, 0] == k]
            means[s, k], counts[s, k] = np.mean(own), len(own)
    variance = np.mean([(a - b) ** 2 / (1 / n + 1 / m) for a, b, n, m in zip(*means, *counts, strict=True)])
    found = []
    for k in range(CELLS):
        z = means[:, k] * np.sqrt(counts[:, k] / variance)
        found.append(2.0 * (1.0 - t.cdf(min(abs(z)), CELLS)) ** 2 if z[0] * z[1] > 0 else 0.5)
    return np.array(found)


def test_p_values_are_those_by_hand() -> None:
    rng = np.random.default_rng(1)
    one, white = grid(rng), noise(rng)
    assert one.p_values(white)[0] == pytest.approx(by_hand(one, white), rel=1e-9)


def test_noise_has_structure_as_seldom_as_is_stated_whatever_its_level() -> None:
    """Twelve thousand cells, of noise that is three times as loud as it is taken for."""
    rng = np.random.default_rng(2)
    one = grid(rng)
    p = np.concatenate([one.p_values([3.0 * each for each in noise(rng)])[0] for _ in range(375)])
    for level in (0.05, 0.005):
        assert np.mean(p <= level) == pytest.approx(level, abs=4.0 * np.sqrt(level / len(p)))


def test_what_both_sets_of_trials_have_is_found_and_what_one_has_is_not() -> None:
    rng = np.random.default_rng(3)
    one, white = grid(rng), noise(rng)
    for i, own in enumerate(white):
        own[one.which[i] == 5] += 0.8
        own[one.which[i] == 9] += 0.8 if i < FITTED else -0.8
        own[one.which[i] == 20] += 0.8 if i < FITTED else 0.0
    q = benjamini_yekutieli(one.p_values(white)[0])
    assert list(np.flatnonzero(q <= 0.05)) == [5]


def test_q_values_are_those_of_the_step_up_rule_by_hand() -> None:
    """Rejected at level a are the k smallest where p_(k) <= a k / (m Σ 1/i), for the largest such k."""
    p = np.array([0.5, 0.0002, 0.03, 0.001, 0.2, 0.0004])
    q, m = benjamini_yekutieli(p), len(p)
    harmonic = sum(1.0 / i for i in range(1, m + 1))
    for level in (0.001, 0.003, 0.005, 0.01, 0.2, 0.9):
        able = [k for k in range(1, m + 1) if np.sort(p)[k - 1] <= level * k / (m * harmonic)]
        limit = np.sort(p)[max(able) - 1] if able else -1.0
        assert np.array_equal(q <= level, p <= limit), level
    assert benjamini_yekutieli(np.array([0.9, 1.0])).max() == 1.0


def test_a_channel_follows_the_input_that_it_is_a_function_of() -> None:
    rng = np.random.default_rng(5)
    bins = {name: [rng.integers(0, 8, N) for _ in range(2)] for name in ("idle", "driving")}
    assert followed([np.sin(1.0 * each) for each in bins["driving"]], bins) == "driving"
    assert followed([np.ones(N)], {}) == ""


def test_cells_that_touch_are_one_region() -> None:
    """Neighbours in phase, state and direction; corners do not touch."""
    cells = np.zeros(SHAPE, bool)
    cells[0, 0, 0] = cells[1, 0, 0] = cells[1, 0, 1] = True
    cells[2, 1, 1] = True
    first, second = sorted(touching(cells.ravel()), key=lambda each: -each.sum())
    assert first.sum() == 3
    assert second.sum() == 1
    assert not list(touching(np.zeros(CELLS, bool)))
