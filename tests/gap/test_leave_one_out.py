"""Every trial predicted from the others: equal to a fit without it, and better with the effect that is there."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from geocontact.gap.reduction.leave_one_out import left_out
from tests.elsewhere import Elsewhere
from tests.gap.cases import Late, gains


def test_it_is_the_density_given_a_fit_to_the_other_trials() -> None:
    rng = np.random.default_rng(0)
    designs = [rng.standard_normal((12, 2)) for _ in range(4)]
    residuals = [d @ np.array([0.5, -1.0]) + rng.standard_normal(12) for d in designs]
    found = left_out(residuals, designs)
    for i, own in enumerate(designs):
        others = [j for j in range(4) if j != i]
        d, r = np.concatenate([designs[j] for j in others]), np.concatenate([residuals[j] for j in others])
        covariance = np.linalg.inv(d.T @ d + np.eye(2))
        exact = multivariate_normal(own @ covariance @ d.T @ r, np.eye(12) + own @ covariance @ own.T)
        assert found[i] == pytest.approx(exact.logpdf(residuals[i]) + 6.0 * np.log(2.0 * np.pi), rel=1e-9)


@pytest.mark.slow
def test_a_delay_helps_in_every_trial(elsewhere: Elsewhere) -> None:
    found = elsewhere(gains, Late(0.12))
    assert len(found) == 5
    assert [held for held, _ in found] == [False, False, False, True, True]
    assert all(nats > 3.0 for _, nats in found)


@pytest.mark.slow
def test_there_is_nothing_to_hold_where_nothing_is_named(elsewhere: Elsewhere) -> None:
    assert elsewhere(gains, None) == []
