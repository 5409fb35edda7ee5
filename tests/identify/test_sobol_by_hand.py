"""Sobol' indices and regression on ranks beside loops over plain numbers, and beside integrals over a grid."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest

from geocontact.identify.intervals.sampling import REPEATS, rank_regression, variance_shares

STUDENT_15 = 2.1314495455597742
"""Of 15 degrees of freedom at 97.5 %: tables."""


def crooked(x: np.ndarray) -> np.ndarray:
    """A polynomial with products: x₀² + 2 x₀ x₁ + x₂³, and a fourth number that does nothing."""
    return np.asarray(x[:, 0] ** 2 + 2.0 * x[:, 0] * x[:, 1] + x[:, 2] ** 3 + 0.0 * x[:, 3])


def test_the_estimators_by_hand() -> None:
    """Saltelli's first-order and Jansen's total estimator in loops, over the very points that were asked for."""
    asked: list[np.ndarray] = []

    def watched(x: np.ndarray) -> np.ndarray:
        asked.append(x.copy())
        return crooked(x)

    found = variance_shares(watched, 4, 11)
    assert found is not None and len(asked) == 3 * REPEATS
    first, total = np.empty((REPEATS, 4)), np.empty((REPEATS, 4))
    for run in range(REPEATS):
        one, other = asked[3 * run], asked[3 * run + 1]
        a, b = crooked(one), crooked(other)
        both = [*a, *b]
        mean = sum(both) / len(both)
        variance = sum((each - mean) ** 2 for each in both) / len(both)
        for factor in range(4):
            mixed = one.copy()
            mixed[:, factor] = other[:, factor]
            m = crooked(mixed)
            # of deviations from the mean, which leaves what is expected as it is
            first[run, factor] = sum((b - mean) * (m - a)) / len(a) / variance
            total[run, factor] = sum((a - m) ** 2) / (2.0 * len(a)) / variance
    for each, value, interval in (
        (first, found.first, found.first_interval),
        (total, found.total, found.total_interval),
    ):
        middle = each.sum(axis=0) / REPEATS
        error = np.sqrt(((each - middle) ** 2).sum(axis=0) / (REPEATS - 1)) / sqrt(REPEATS)
        np.testing.assert_allclose(value, middle, atol=1e-9)
        np.testing.assert_allclose(interval[:, 0], middle - STUDENT_15 * error, atol=1e-9)
        np.testing.assert_allclose(interval[:, 1], middle + STUDENT_15 * error, atol=1e-9)


def test_the_indices_are_the_integrals() -> None:
    """Variances of means over a grid of Gauss' points, exact for a polynomial."""
    place, weight = np.polynomial.legendre.leggauss(6)
    place, weight = 0.5 * (place + 1.0), 0.5 * weight
    grid = np.meshgrid(*[place] * 4, indexing="ij")
    value = crooked(np.column_stack([each.ravel() for each in grid])).reshape(6, 6, 6, 6)

    def over(values: np.ndarray, axes: tuple[int, ...]) -> np.ndarray:
        for axis in sorted(axes, reverse=True):
            values = np.tensordot(values, weight, axes=(axis, 0))
        return values

    mean = float(over(value, (0, 1, 2, 3)))
    variance = float(over(value**2, (0, 1, 2, 3))) - mean**2
    found = variance_shares(crooked, 4, 2)
    assert found is not None
    for k in range(4):
        others = tuple(axis for axis in range(4) if axis != k)
        alone = over(value, others)
        rest = over(value, (k,))
        knowing = float(over(alone**2, (0,))) - mean**2
        without = float(over(rest**2, (0, 1, 2))) - mean**2
        assert found.first[k] == pytest.approx(knowing / variance, abs=2e-3)
        assert found.total[k] == pytest.approx(1.0 - without / variance, abs=2e-3)


def ranks_of(values: list[float]) -> list[float]:
    """Ranks from 1; equal values share theirs."""
    return [
        sum(other < value for other in values) + 0.5 * (sum(other == value for other in values) + 1) for value in values
    ]


def standard(values: list[float]) -> list[float]:
    """Less their mean, over their standard deviation."""
    mean = sum(values) / len(values)
    sd = sqrt(sum((each - mean) ** 2 for each in values) / len(values))
    return [(each - mean) / sd for each in values]


def test_regression_on_ranks_by_hand() -> None:
    rng = np.random.default_rng(4)
    quantities = np.round(rng.normal(size=(60, 2)), 1)
    result = quantities[:, 0] + quantities[:, 1] ** 2 + 0.3 * rng.normal(size=60)
    result[[3, 17]] = np.inf
    columns = [standard(ranks_of(quantities[:, k].tolist())) for k in range(2)]
    for k in range(2):
        ordered = sorted(quantities[:, k].tolist())
        middle = 0.5 * (ordered[29] + ordered[30])
        columns.append(standard(ranks_of([abs(each - middle) for each in quantities[:, k].tolist()])))
    answer = standard(ranks_of(result.tolist()))
    normal = np.array([[sum(p * q for p, q in zip(a, b, strict=True)) for b in columns] for a in columns])
    side = np.array([sum(p * q for p, q in zip(a, answer, strict=True)) for a in columns])
    wanted = np.linalg.inv(normal) @ side
    left = [y - sum(w * c[i] for w, c in zip(wanted, columns, strict=True)) for i, y in enumerate(answer)]
    found = rank_regression(quantities, result)
    np.testing.assert_allclose([*found.coefficients, *found.of_distance], wanted, rtol=1e-9)
    assert found.explained == pytest.approx(1.0 - sum(each**2 for each in left) / 60.0, rel=1e-9)
