"""Samples of a population, their order statistics and what their spread comes from, against closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from scipy import stats

from geocontact.identify.intervals.quantile_intervals import probability, quantile
from geocontact.identify.intervals.sampling import (
    Normal,
    People,
    Sampling,
    Uniform,
    rank_regression,
    root,
    variance_shares,
)

SHARES = np.linspace(0.001, 0.999, 999)


def test_quantiles_are_those_of_scipy() -> None:
    cut = stats.truncnorm(-1.5, 0.5, 3.0, 2.0)
    np.testing.assert_allclose(Normal("x", 3.0, 2.0, 0.0, 4.0).quantile(SHARES)[:, 0], cut.ppf(SHARES), rtol=1e-10)
    np.testing.assert_allclose(Normal("x", 3.0, 2.0).quantile(SHARES)[:, 0], stats.norm(3, 2).ppf(SHARES), rtol=1e-12)
    np.testing.assert_allclose(Uniform("x", -1.0, 4.0).quantile(SHARES)[:, 0], -1.0 + 5.0 * SHARES, rtol=1e-12)


def test_people_are_drawn_whole_and_alike_often() -> None:
    rows = np.array([[1.0, 10.0], [2.0, 40.0], [3.0, 90.0]])
    drawn = People(("x", "y"), rows).quantile((np.arange(3000) + 0.5) / 3000)
    assert [np.sum((drawn == row).all(axis=1)) for row in rows] == [1000, 1000, 1000]
    assert People(("x", "y"), rows).quantile(np.ones(1)).tolist() == [[3.0, 90.0]]


def test_correlated_normals_have_their_covariance_and_keep_their_distributions() -> None:
    factors = (Normal("a", 1.0, 2.0), Normal("b", 0.0, 3.0), Uniform("c", 0.0, 1.0))
    wanted = np.array([[1.0, 0.6, 0.0], [0.6, 1.0, -0.4], [0.0, -0.4, 1.0]])
    sampling = Sampling(factors, wanted, {"d": 7.0})
    drawn = sampling.quantities(sampling.shares(200_000, 3), ("d", "a", "b", "c"))
    assert (drawn[:, 0] == 7.0).all() and not sampling.independent
    assert np.cov(drawn[:, 1:3].T) == pytest.approx(np.array([[4.0, 3.6], [3.6, 9.0]]), abs=0.08)
    scores = stats.norm.ppf(drawn[:, 3])
    assert np.corrcoef(drawn[:, 2], scores)[0, 1] == pytest.approx(-0.4, abs=0.01)
    assert stats.kstest(drawn[:20_000, 3], "uniform").pvalue > 1e-3


def test_the_same_seed_draws_the_same_people() -> None:
    sampling = Sampling((Normal("a", 0.0, 1.0),), np.eye(1), {})
    assert (sampling.shares(50, 4) == sampling.shares(50, 4)).all()
    assert (sampling.shares(50, 4) != sampling.shares(50, 5)).any()


def test_an_impossible_correlation() -> None:
    with pytest.raises(ValueError, match="not positive definite"):
        root(np.array([[1.0, 0.9, 0.9], [0.9, 1.0, -0.9], [0.9, -0.9, 1.0]]))


@pytest.mark.parametrize(("count", "of"), [(0, 40), (3, 40), (40, 40), (812, 100_000)])
def test_the_exact_interval_is_that_of_scipy(count: int, of: int) -> None:
    found, want = probability(count, of), stats.binomtest(count, of).proportion_ci(0.95, "exact")
    assert (found.lower, found.upper) == pytest.approx((want.low, want.high), rel=1e-9)
    assert found.value == count / of


def test_intervals_of_quantiles_cover() -> None:
    """Counted over repeated draws: at least 95 %, and little more."""
    rng = np.random.default_rng(8)
    for share in (0.5, 0.95):
        true = stats.expon.ppf(share)
        held = 0
        for _ in range(1500):
            one = quantile(np.sort(rng.exponential(size=400)), share)
            held += one.lower <= true < one.upper
            assert one.lower <= one.value <= one.upper
        assert 0.94 < held / 1500 < 0.985


def test_infinite_samples_stay_in_the_tail() -> None:
    ordered = np.append(np.arange(1.0, 96.0), np.full(5, np.inf))
    assert quantile(ordered, 0.5).value == 50.0 and quantile(ordered, 0.95).value == 95.0
    assert quantile(ordered, 0.99).value == np.inf
    assert quantile(np.arange(1.0, 11.0), 0.99).upper == np.inf, "ten samples tell no upper end"
    assert quantile(np.arange(1.0, 11.0), 0.01).lower == -np.inf


def test_variance_shares_of_ishigamis_function() -> None:
    """Closed form of Ishigami & Homma (1990), a = 7, b = 0.1."""

    def ishigami(shares: np.ndarray) -> np.ndarray:
        x = np.pi * (2.0 * shares.T - 1.0)
        return np.sin(x[0]) + 7.0 * np.sin(x[1]) ** 2 + 0.1 * x[2] ** 4 * np.sin(x[0])

    found = variance_shares(ishigami, 3, 1)
    assert found is not None
    np.testing.assert_allclose(found.first, [0.3139, 0.4424, 0.0], atol=0.01)
    np.testing.assert_allclose(found.total, [0.5576, 0.4424, 0.2437], atol=0.01)
    assert (found.first_interval[:, 0] <= found.first).all() and (found.total <= found.total_interval[:, 1]).all()


def test_intervals_of_variance_shares_hold_the_closed_form() -> None:
    """f = 2 u + v: shares 4/5 and 1/5, first order and total alike."""
    found = variance_shares(lambda shares: 2.0 * shares[:, 0] + shares[:, 1], 2, 3)
    assert found is not None
    for value, ends in ((found.first, found.first_interval), (found.total, found.total_interval)):
        assert value == pytest.approx([0.8, 0.2], abs=2e-3)
        assert (np.diff(ends, axis=1)[:, 0] < 4e-3).all()
        assert (np.abs(value - [0.8, 0.2]) < 2.0 * np.diff(ends, axis=1)[:, 0]).all()


def test_a_single_factor_has_all_of_the_variance() -> None:
    found = variance_shares(lambda shares: shares[:, 0] ** 3, 1, 1)
    assert found is not None
    assert found.first == pytest.approx([1.0], abs=1e-3) and found.total == pytest.approx([1.0], abs=1e-3)


def test_what_is_constant_has_nothing_to_share_out() -> None:
    assert variance_shares(lambda shares: np.ones(len(shares)), 2, 1) is None
    flat = rank_regression(np.random.default_rng(1).random((50, 2)), np.zeros(50))
    assert flat.explained == 0.0 and not flat.coefficients.any() and not flat.of_distance.any()


def test_variance_shares_need_a_value_everywhere() -> None:
    assert variance_shares(lambda shares: np.where(shares[:, 0] > 0.999, np.inf, shares[:, 0]), 2, 1) is None


def test_ranks_tell_what_rises_and_what_acts_either_way() -> None:
    rng = np.random.default_rng(2)
    quantities = rng.standard_normal((4000, 3))
    rising = rank_regression(quantities, np.exp(quantities[:, 0]))
    assert rising.coefficients == pytest.approx([1.0, 0.0, 0.0], abs=1e-9) and rising.explained == pytest.approx(1.0)
    either = rank_regression(quantities, quantities[:, 1] ** 2)
    assert either.of_distance[1] == pytest.approx(1.0, abs=0.03) and either.explained > 0.99
    assert np.abs(either.coefficients).max() < 0.03
    worst = rank_regression(quantities, np.where(quantities[:, 2] > 0.0, np.inf, quantities[:, 2]))
    assert worst.coefficients[2] > 0.9
