"""Tails of distributions in nats, and quantiles that are called as functions, against `scipy.stats`."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from scipy import stats

from geocontact.axis_misalignment.tracking import _ranks
from geocontact.gap.inputs.spectrum import nuttall
from geocontact.identify.intervals.tails import chi_square_nats, f_nats, gamma_nats, poisson_nats

RATIOS = np.concatenate([[0.0], np.geomspace(1e-12, 1e4, 200)])
"""From where nothing of the tail is missing to where nothing is left."""


@pytest.mark.parametrize(("above", "below"), [(1, 1), (2, 24), (7, 300), (64, 12)])
def test_f(above: int, below: int) -> None:
    assert np.array_equal(f_nats(RATIOS, above, below), -stats.f.logsf(RATIOS, above, below))
    several = np.full(RATIOS.shape, float(below))
    assert np.array_equal(f_nats(RATIOS, above, several), -stats.f.logsf(RATIOS, above, several))


@pytest.mark.parametrize("freedom", [1, 2, 5, 40])
def test_chi_square_and_gamma(freedom: int) -> None:
    for value in RATIOS[RATIOS < 700.0]:
        assert chi_square_nats(float(value), freedom) == -stats.chi2.logsf(value, freedom)
        assert gamma_nats(float(value), freedom) == -stats.gamma.logsf(value, freedom)


def test_one_exponential_has_its_own_value_and_what_is_beyond_is_infinite() -> None:
    """Derived by hand: P(X >= x) = exp(-x) of a sum of one, exp(-x / 2) of a χ² of two."""
    assert gamma_nats(300.0, 1) == pytest.approx(300.0, rel=1e-12)
    assert chi_square_nats(300.0, 2) == pytest.approx(150.0, rel=1e-12)
    assert gamma_nats(1e-20, 1) == pytest.approx(1e-20, rel=1e-12)
    assert gamma_nats(1e5, 1) == np.inf


def test_poisson() -> None:
    for count, mean in ((1, 0.3), (4, 2.0), (30, 2.5)):
        assert poisson_nats(count, mean) == -stats.poisson.logsf(count - 1, mean)
    assert poisson_nats(1, 0.3) == pytest.approx(-np.log(1.0 - np.exp(-0.3)))


def test_what_is_impossible_is_infinite_without_a_word() -> None:
    """A thousand samples at one level, where two are usual: no warning of a logarithm reaches anybody."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert poisson_nats(1000, 2.0) == f_nats(np.array([1e300]), 2, 24)[0] == np.inf


def test_equal_values_share_a_rank() -> None:
    values = np.random.default_rng(0).integers(0, 9, 60).astype(float)
    assert np.array_equal(_ranks(values), stats.rankdata(values))
    assert _ranks(np.array([3.0, 1.0, 3.0])).tolist() == [2.5, 1.0, 2.5]


@pytest.mark.parametrize("count", [2, 3, 64, 501])
def test_nuttall(count: int) -> None:
    from scipy.signal.windows import nuttall as expected

    assert np.array_equal(nuttall(count), expected(count))
