"""Every trial predicted from the others: equal to a fit without it. What diagnoses say of it: test_diagnose.py."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from geocontact.gap.reduction.error_reduction import left_out


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
