"""Bounded least squares: the linear problem, Rosenbrock's valley, bounds that bind, searches that are given up."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import lsq_linear

from geocontact.identify.optimise.bounded_gauss_newton import least

WIDE = np.full(2, 1e3)


def valley(x: np.ndarray) -> np.ndarray:
    return np.array([10.0 * (x[1] - x[0] ** 2), 1.0 - x[0]])


def valley_slope(x: np.ndarray) -> np.ndarray:
    return np.array([[-20.0 * x[0], 10.0], [-1.0, 0.0]])


def test_the_end_of_a_bent_valley_is_found() -> None:
    found = least(valley, valley_slope, np.array([-1.2, 1.0]), -WIDE, WIDE, 100, 1e-12)
    assert found.finished
    np.testing.assert_allclose(found.x, 1.0, atol=1e-5)


@given(st.integers(0, 10_000))
def test_a_linear_problem_ends_where_the_exact_method_does(seed: int) -> None:
    rng = np.random.default_rng(seed)
    matrix = rng.standard_normal((12, 4)) @ rng.standard_normal((4, 4))  # unknowns that stand in for each other
    right, lower = matrix @ (3.0 * rng.standard_normal(4)) + rng.standard_normal(12), np.full(4, -1.0)
    found = least(lambda x: matrix @ x - right, lambda _: matrix, np.zeros(4), lower, -lower, 60, 1e-9)
    assert (np.abs(found.x) <= 1.0).all()
    assert found.cost == pytest.approx(lsq_linear(matrix, right, (-1.0, 1.0), tol=1e-12).cost, rel=1e-4, abs=1e-4)


def test_few_derivatives_are_asked_for() -> None:
    asked = []

    def slope(x: np.ndarray) -> np.ndarray:
        asked.append(x)
        return np.diag(np.exp(x))

    least(lambda x: np.exp(x) - 2.0, slope, np.zeros(2), -WIDE, WIDE, 40, 1e-6)
    assert len(asked) <= 5


def test_an_unknown_that_does_nothing_stays_where_it_is() -> None:
    found = least(
        lambda x: np.array([x[0] - 3.0, 1.0]),
        lambda _: np.array([[1.0, 0.0], [0.0, 0.0]]),
        np.zeros(2),
        -WIDE,
        WIDE,
        20,
        1e-9,
    )
    np.testing.assert_allclose(found.x, [3.0, 0.0], atol=1e-4)


def test_a_search_that_promises_too_little_is_given_up() -> None:
    tried = []

    def residual(x: np.ndarray) -> np.ndarray:
        tried.append(x)
        return np.array([x[0] - 1.0, 2.0])

    def slope(_: np.ndarray) -> np.ndarray:
        return np.array([[1.0], [0.0]])

    one = np.full(1, 1e3)
    assert not least(residual, slope, np.zeros(1), -one, one, 20, 1e-9, useful=0.4).finished
    assert len(tried) == 1  # 2.5, of which 0.5 is promised: not even three times that reaches 0.4
    assert least(residual, slope, np.zeros(1), -one, one, 20, 1e-9, useful=2.1).finished
