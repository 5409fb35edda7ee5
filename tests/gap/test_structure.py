"""Cells of phase, state and rate: structure that both sets of trials have is found, by hand and at its rate."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.signal import lfilter
from scipy.stats import t, ttest_1samp

from geocontact.gap.localise.regions import touching
from geocontact.gap.localise.structure import SHAPE, StateCells, benjamini_yekutieli, followed

CELLS, FITTED, TRIALS, N = int(np.prod(SHAPE)), 3, 5, 640


def grid(rng: np.random.Generator) -> StateCells:
    """One channel, all cells equally often."""
    which = tuple(rng.permutation(np.arange(N) % CELLS)[:, None] for _ in range(TRIALS))
    return StateCells(which, ("angle",), FITTED)


def noise(rng: np.random.Generator) -> list[np.ndarray]:
    return [rng.standard_normal((N, 1)) for _ in range(TRIALS)]


def by_hand(one: StateCells, residuals: list[np.ndarray]) -> np.ndarray:
    """The same p-values, cell by cell: a t-test of trials' means by scipy."""
    found = []
    for k in range(CELLS):
        means = np.array(
            [r[w[:, 0] == k, 0].mean() for r, w in zip(residuals, one.which, strict=True) if (w == k).any()]
        )
        sets = [
            np.mean([r[w[:, 0] == k, 0].mean() for r, w in some if (w == k).any()])
            for some in (
                [*zip(residuals, one.which, strict=True)][: one.fitted],
                [*zip(residuals, one.which, strict=True)][one.fitted :],
            )
        ]
        alike = all(own / means.mean() >= 0.5 for own in sets)
        found.append(ttest_1samp(means, 0.0).pvalue if alike else 1.0)
    return np.array(found)


def test_p_values_are_those_by_hand() -> None:
    """Trial 1 does not reach cell 3, so that one degree of freedom fewer is left there."""
    rng = np.random.default_rng(1)
    one, residuals = grid(rng), noise(rng)
    one.which[1][one.which[1] == 3] = -1
    found, expected = one.p_values(residuals)[0], by_hand(one, residuals)
    assert found == pytest.approx(expected, rel=1e-9)
    assert 5 <= (expected < 1.0).sum() <= CELLS - 5


def test_noise_has_structure_no_more_often_than_is_stated_whatever_its_level() -> None:
    """Twelve thousand cells, of noise that is three times as loud as it is taken for.

    Where the whole is far from zero both sets mostly have half of it: the rate at small p is the stated one.
    """
    rng = np.random.default_rng(2)
    one = grid(rng)
    p = np.concatenate([one.p_values([3.0 * each for each in noise(rng)])[0] for _ in range(375)])
    for level in (0.05, 0.005):
        assert 0.5 * level < np.mean(p <= level) <= level + 4.0 * np.sqrt(level / len(p))


def slow(memory: float) -> Callable[[np.random.Generator], np.ndarray]:
    """Noise of the first order that remembers a part of the trial."""
    alike = np.exp(-1.0 / (memory * N))

    def of(rng: np.random.Generator) -> np.ndarray:
        own = rng.standard_normal(N) * np.sqrt(1.0 - alike**2)
        own[0] = rng.standard_normal()
        return lfilter([1.0], [1.0, -alike], own)

    return of


PHASE = np.arange(N) / N
VARIATIONS: dict[str, Callable[[np.random.Generator], np.ndarray]] = {
    "memory of a tenth": slow(0.1),
    "memory of a quarter": slow(0.25),
    "small offset": lambda rng: rng.standard_normal(N) + 0.2 * rng.standard_normal(),
    "offset": lambda rng: rng.standard_normal(N) + rng.standard_normal(),
    "gain": lambda rng: rng.standard_normal(N) + rng.standard_normal() * np.sin(12.0 * np.pi * PHASE),
}


@pytest.mark.parametrize("kind", VARIATIONS)
@pytest.mark.parametrize(("trials", "fitted"), [(6, 3), (4, 2)])
def test_slow_noise_and_what_trials_differ_by_make_no_region(kind: str, trials: int, fitted: int) -> None:
    """A case has a found cell in at most 8 of 100 draws, where one in twenty is stated."""
    rng, draws, cases = np.random.default_rng(list(VARIATIONS).index(kind)), 200, 0
    angles = [np.sin(12.0 * np.pi * PHASE + 0.3 * i) for i in range(trials)]
    quarters = np.quantile(angles[0], [0.25, 0.5, 0.75])
    which = tuple(
        ((PHASE * 4).astype(int) * 8 + 2 * np.searchsorted(quarters, own) + (np.gradient(own) > 0))[:, None]
        for own in angles
    )
    one = StateCells(which, ("angle",), fitted)
    for _ in range(draws):
        p = one.p_values([VARIATIONS[kind](rng)[:, None] for _ in range(trials)])
        cases += bool((benjamini_yekutieli(p[one.tested]) <= 0.05).any())
    assert cases <= 0.08 * draws


@pytest.mark.parametrize(("trials", "fitted"), [(6, 3), (8, 2), (8, 6)])
def test_parameters_that_calibration_trials_centre_do_not_make_structure(trials: int, fitted: int) -> None:
    """A gain that varies, fitted to the calibration trials: what it leaves of the others is alike in all of these."""
    rng, cases, draws = np.random.default_rng(7), 0, 200
    angle = np.sin(12.0 * np.pi * PHASE)[:, None]
    which = (((PHASE * 4).astype(int)[:, None] * 8 + np.minimum((angle + 1.0) * 4.0, 7.0).astype(int)),) * trials
    one = StateCells(which, ("angle",), fitted)
    for _ in range(draws):
        gains = rng.standard_normal(trials)
        gains -= gains[:fitted].mean()
        p = one.p_values([k * angle + 0.1 * rng.standard_normal((N, 1)) for k in gains])
        cases += bool((benjamini_yekutieli(p[one.tested]) <= 0.05).any())
    assert cases <= 0.08 * draws


def test_a_load_in_one_part_of_the_trial_is_found_in_no_other() -> None:
    """Residuals are not whitened by what trials vary by, which mixes all samples of a trial."""
    rng, hits, vain = np.random.default_rng(8), 0, 0
    part = np.arange(CELLS) // 8 == 2
    for _ in range(20):
        one, gain = grid(rng), 0.1 * rng.standard_normal(TRIALS)
        residuals = [
            own + part[w] + k * np.sin(12.0 * np.pi * PHASE)[:, None]
            for own, w, k in zip(noise(rng), one.which, gain, strict=True)
        ]
        found = benjamini_yekutieli(one.p_values([0.2 * r for r in residuals])[0]) <= 0.05
        hits, vain = hits + found[part].sum(), vain + found[~part].sum()
    assert vain <= 0.05 * hits


def test_the_deviation_that_few_trials_need_is_the_stated_one() -> None:
    """|m| / s of one cell of 32, as the module says: little is found of three trials."""
    rank = 0.05 / (CELLS * sum(1.0 / i for i in range(1, CELLS + 1)))
    least = [float(t.isf(0.5 * rank, n - 1)) / np.sqrt(n) for n in (3, 4, 6)]
    assert np.round(least) == pytest.approx([29.0, 9.0, 3.0])


def test_what_both_sets_of_trials_have_is_found_and_what_one_has_is_not() -> None:
    rng = np.random.default_rng(3)
    one, white = grid(rng), noise(rng)
    for i, own in enumerate(white):
        own[one.which[i] == 5] += 8.0
        own[one.which[i] == 9] += 8.0 if i < FITTED else -8.0
        own[one.which[i] == 20] += 8.0 if i < FITTED else 0.0
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
