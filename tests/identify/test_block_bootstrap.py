"""Replicates of a residual that remembers: their spread against the closed form, whole and in parts."""

from __future__ import annotations

import tracemalloc

import numpy as np
import pytest

from geocontact.identify.intervals import block_bootstrap as module
from geocontact.identify.intervals.block_bootstrap import block_bootstrap
from geocontact.identify.noise.autocorrelation import Autocorrelation

STEP, TAU, SIZE, COUNT = 0.01, 0.05, 2_000, 800


@pytest.fixture(scope="module")
def residual() -> np.ndarray:
    """Noise of standard deviation 2 that remembers for 0.05 s, written as a recursion."""
    rng, keep = np.random.default_rng(3), np.exp(-STEP / TAU)
    found = np.empty(SIZE)
    found[0] = rng.standard_normal()
    for k in range(1, SIZE):
        found[k] = keep * found[k - 1] + np.sqrt(1.0 - keep**2) * rng.standard_normal()
    return 2.0 * found


def means_of(residual: np.ndarray) -> module.Replicates:
    time = STEP * np.arange(SIZE)
    memory = Autocorrelation(np.array([TAU]), np.ones(1), np.array([4.0]), SIZE - 1)
    refit = lambda rows: np.column_stack([rows.mean(axis=1), rows[:, -1]])  # noqa: E731
    return block_bootstrap(time, np.full(SIZE, 7.0), residual, memory, refit, COUNT)


@pytest.mark.parametrize("at_once", [10**9, 90_000])
def test_means_spread_as_the_sum_of_correlations_says_in_parts_too(
    monkeypatch: pytest.MonkeyPatch, residual: np.ndarray, at_once: int
) -> None:
    monkeypatch.setattr(module, "AT_ONCE", at_once)
    drawn = means_of(residual)
    keep = np.exp(-STEP / TAU)
    expected = residual.std() * np.sqrt((1.0 + keep) / (1.0 - keep) / SIZE)
    assert drawn.estimates.shape == (COUNT, 2)
    assert drawn.estimates[:, 0].std() == pytest.approx(expected, rel=0.12)
    assert drawn.estimates[:, 0].mean() == pytest.approx(7.0, abs=5.0 * expected / np.sqrt(COUNT))
    assert drawn.estimates[:, 1].std() == pytest.approx(residual.std(), rel=0.12)
    assert len(np.unique(drawn.estimates[:, 0])) == COUNT
    assert drawn.lower[0] == pytest.approx(7.0 - 1.96 * expected, rel=0.02)


def test_the_order_is_that_in_which_correlation_times_were_drawn(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(module, "AT_ONCE", 90_000)
    short, long = 1e-3, 0.4
    memory = Autocorrelation(np.array([short, long]), np.array([0.9, 0.1]), np.full(2, 4.0), SIZE - 1)
    spread = lambda rows: rows.std(axis=1)[:, None]  # noqa: E731
    white = np.random.default_rng(4).standard_normal(SIZE)
    found = block_bootstrap(STEP * np.arange(SIZE), np.zeros(SIZE), white, memory, spread, COUNT).estimates[:, 0]
    drawn = np.random.default_rng(0).choice(2, COUNT, p=memory.weight)
    assert found[drawn == 1].min() > 2.0 * found[drawn == 0].max()


def test_a_long_recording_takes_no_more_memory_than_a_part(
    monkeypatch: pytest.MonkeyPatch, residual: np.ndarray
) -> None:
    monkeypatch.setattr(module, "AT_ONCE", 40_000)
    tracemalloc.start()
    means_of(residual)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 0.25 * COUNT * SIZE * 8


def test_memory_is_put_back_sample_by_sample() -> None:
    """x_k = ρ_k x_{k-1} + √(1 - ρ_k²) e_k, as the sum over all earlier e that it unrolls to."""
    rng = np.random.default_rng(5)
    keep, innovations = rng.uniform(0.1, 0.9, 6), rng.standard_normal((7, 3))
    found = innovations.copy()
    module._remember(found, keep, np.sqrt(1.0 - keep**2))
    for k in range(7):
        shares = [np.prod(keep[i:k]) * (np.sqrt(1.0 - keep[i - 1] ** 2) if i else 1.0) for i in range(k + 1)]
        np.testing.assert_allclose(found[k], shares @ innovations[: k + 1], rtol=1e-12)
