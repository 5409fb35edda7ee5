"""The stand-in for anything unknown takes bumps that are worth their price, and none from noise."""

from __future__ import annotations

import numpy as np
import pytest
from tests.gap.cases import elbow_case

from geocontact.gap.contest import base_contender
from geocontact.gap.problem import problem_of
from geocontact.gap.surrogate import chosen, surrogate
from geocontact.systems.catalogue import system_of


def test_a_bump_is_found_among_many_columns() -> None:
    rng = np.random.default_rng(0)
    columns, known = rng.standard_normal((300, 40)), rng.standard_normal((300, 3))
    residual = rng.standard_normal(300) + 0.8 * columns[:, 7] + 5.0 * known[:, 0]
    found = chosen(residual, columns, known, 200, 1.0)
    assert found.columns == [7]
    assert found.weights[0] == pytest.approx(0.8, abs=0.2)
    assert 0.0 < found.calibration < found.nats


def test_nothing_is_found_in_noise() -> None:
    rng = np.random.default_rng(1)
    hits = [chosen(rng.standard_normal(300), rng.standard_normal((300, 40)), np.zeros((300, 1)), 200, 1.0).columns for _ in range(40)]
    assert sum(map(bool, hits)) <= 2


def test_what_fitted_parameters_explain_is_not_paid_for() -> None:
    rng = np.random.default_rng(2)
    known = rng.standard_normal((300, 2))
    assert chosen(30.0 * known[:, 0], known[:, :1], known, 200, 1.0).columns == []


@pytest.mark.parametrize("push", [0.0, 1.5])
def test_a_push_in_the_middle_of_every_trial(push: float) -> None:
    def pushed(_: str, time: np.ndarray, force: np.ndarray) -> np.ndarray:
        return force + push * np.exp(-0.5 * ((time - 8.0) / 0.8) ** 2)

    case = elbow_case(seed=5, change=pushed)
    problem = problem_of(case, system_of(case))
    found = surrogate(problem, base_contender(problem).judged)
    if push:
        assert found.nats > 20.0
        middle = found.predicted[0][200, 0]
        assert middle == pytest.approx(push, rel=0.5)
    else:
        assert found.nats < 3.0
