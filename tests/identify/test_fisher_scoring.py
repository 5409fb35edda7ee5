"""Many problems of greatest likelihood at once: exponential powers of a level and a slope over frequency."""

from __future__ import annotations

import numpy as np
import pytest
from jaxtyping import Float, Int
from scipy.optimize import minimize

from geocontact.identify.optimise.fisher_scoring import Batch, Scored, ScoringResult, least

AT = np.linspace(-1.0, 1.0, 60)
TRUE = np.array([[0.3, -1.0], [-2.0, 0.5], [5.0, 2.0]])
LOW, HIGH = np.full(2, -20.0), np.full(2, 20.0)


@pytest.fixture(scope="module")
def power() -> Float[np.ndarray, "3 60"]:
    """Drawn around exp(level + slope AT)."""
    rng = np.random.default_rng(4)
    return np.asarray(np.exp(TRUE[:, :1] + TRUE[:, 1:] * AT) * rng.exponential(size=(3, 60)))


def found(power: Float[np.ndarray, "3 60"], start: Batch, low: Batch = LOW, high: Batch = HIGH) -> ScoringResult:
    """Least of Whittle's -log likelihood."""

    def scored(x: Batch, which: Int[np.ndarray, " k"]) -> Scored:
        slope = np.broadcast_to(np.stack([np.ones(60), AT]), (len(x), 2, 60))
        expected = x[:, :1] + x[:, 1:] * AT
        met = power[which] / np.exp(expected)
        value = (expected + met).sum(axis=1)
        return value, (slope * (1.0 - met)[:, None]).sum(axis=2), slope @ slope.transpose(0, 2, 1)

    return least(scored, start, low, high)


def by_itself(power: Float[np.ndarray, " 60"]) -> tuple[Float[np.ndarray, " 2"], float]:
    """Nelder and Mead's answer."""
    best = minimize(
        lambda x: (x[0] + x[1] * AT + power / np.exp(x[0] + x[1] * AT)).sum(),
        [np.log(power.mean()), 0.0],
        method="Nelder-Mead",
        options={"xatol": 1e-9, "fatol": 1e-11, "maxiter": 4000},
    )
    return best.x, float(best.fun)


def test_every_problem_ends_at_its_own_least_value(power: Float[np.ndarray, "3 60"]) -> None:
    got = found(power, np.array([[0.0, 0.0], [10.0, -3.0], [-5.0, 5.0]]))
    for k in range(3):
        at, value = by_itself(power[k])
        assert got.at[k] == pytest.approx(at, abs=1e-3)
        assert got.value[k] == pytest.approx(value, abs=1e-6)


def test_a_bound_is_kept_and_the_others_are_still_found(power: Float[np.ndarray, "3 60"]) -> None:
    got = found(power, np.zeros((3, 2)), high=np.array([20.0, 0.2]))
    assert got.at[1, 1] == got.at[2, 1] == 0.2
    level = np.log((power[2] / np.exp(0.2 * AT)).mean())
    assert got.at[2, 0] == pytest.approx(level, abs=1e-3)
    assert got.at[0] == pytest.approx(by_itself(power[0])[0], abs=1e-3)


def test_a_start_beyond_the_bounds_is_brought_back(power: Float[np.ndarray, "3 60"]) -> None:
    got = found(power, np.full((3, 2), 50.0))
    assert (got.at <= HIGH).all()
    assert got.at[0] == pytest.approx(by_itself(power[0])[0], abs=1e-3)


def test_a_problem_without_a_value_is_named(power: Float[np.ndarray, "3 60"]) -> None:
    with pytest.raises(ValueError, match="problem 1 has no finite value where it starts"):
        found(power, np.array([[0.0, 0.0], [np.nan, 0.0], [0.0, 0.0]]))
