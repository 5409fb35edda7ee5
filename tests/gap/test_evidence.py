"""What a parameter on a bound costs: the mean of the likelihood over its range, against numerical integration."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from geocontact.gap.case.refit import Refit
from geocontact.gap.selection.evidence import held_back, log_evidence, log_mean
from geocontact.systems.catalogue import system_of
from tests.gap.cases import PARAMETERS, elbow_case


@pytest.mark.parametrize("fall", [0.0, 0.3, 5.0, 300.0])
@pytest.mark.parametrize("bend", [0.0, 0.01, 2.0, 400.0])
def test_the_mean_over_a_range(fall: float, bend: float) -> None:
    mean = quad(lambda t: np.exp(-fall * t - 0.5 * bend * t * t), 0.0, 1.0, epsabs=1e-13, limit=200)[0]
    assert log_mean(fall, bend) == pytest.approx(np.log(mean), abs=1e-4)


def model(k: float, pull: float) -> Refit:
    """An elbow whose k is held at a value; its likelihood falls by `pull` nats per N/m as k grows."""
    column = np.full(50, 1e-5)
    others = np.random.default_rng(0).standard_normal((50, 2))
    others -= others.mean(axis=0)
    residual = np.full(50, -pull / (50 * 1e-5))
    return Refit(
        system_of(elbow_case(duration=2.0)),
        {"k": k, "x": 0.03, "y": 0.04},
        [],
        [],
        residual,
        np.column_stack([column, others]),
    )


def test_a_parameter_on_a_bound_costs_what_the_data_rule_out() -> None:
    width = PARAMETERS[0].upper - PARAMETERS[0].lower
    assert held_back(model(PARAMETERS[0].lower, 0.1)) == pytest.approx(-np.log(0.1 * width), abs=0.01)
    assert held_back(model(PARAMETERS[0].upper, -0.1)) == pytest.approx(-np.log(0.1 * width), abs=0.01)


def test_a_parameter_inside_its_bounds_costs_nothing_here() -> None:
    assert held_back(model(300.0, 0.1)) == 0.0


def test_rounding_never_makes_a_model_better_than_it_is() -> None:
    """Derivatives out of all proportion, as beside a point without solution, once beat a perfect fit."""
    for seed in range(20):
        rng = np.random.default_rng(seed)
        design = 1e7 * rng.standard_normal((200, 1)) @ rng.standard_normal((1, 4)) + rng.standard_normal((200, 4))
        residual = rng.standard_normal(200)
        together, wanted = np.concatenate([design, np.eye(4)]), np.concatenate([residual, np.zeros(4)])
        left = wanted - together @ np.linalg.lstsq(together, wanted, rcond=0.0)[0]
        half = 0.5 * float(np.linalg.slogdet(np.eye(4) + design.T @ design)[1])
        assert log_evidence(residual, design, np.ones(4)) <= -0.5 * float(left @ left) * (1.0 - 1e-6) - half
