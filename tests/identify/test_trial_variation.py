"""Parameters that vary from trial to trial: the most likely variation, against the dense covariance."""

import numpy as np
import pytest
from scipy.stats import multivariate_normal

from geocontact.identify.noise.trial_variation import Products, deviations, variation


def trials(sd, count, rng, samples=40):
    """Whitened residuals of trials whose q parameters vary with `sd`."""
    designs = [rng.normal(size=(samples, len(sd))) for _ in range(count)]
    deviations = rng.normal(size=(count, len(sd))) * sd
    residuals = [b @ d + rng.normal(size=samples) for b, d in zip(designs, deviations, strict=True)]
    return residuals, designs, deviations


def misfit(residuals, designs, sd):
    """Twice the negative log likelihood under the dense covariance."""
    covariances = (np.eye(len(r)) + b @ np.diag(sd**2) @ b.T for r, b in zip(residuals, designs, strict=True))
    return sum(-2.0 * multivariate_normal(cov=c).logpdf(r) for r, c in zip(residuals, covariances, strict=True))


@pytest.mark.slow
def test_variation_is_recovered_from_many_trials():
    sd = np.array([0.5, 2.0, 0.0])
    residuals, designs, true = trials(sd, 300, np.random.default_rng(1))
    known = [Products.of(r, b) for r, b in zip(residuals, designs, strict=True)]
    found = variation(known, np.array([1.0, 1.0, 1.0]), weight=1e-6, rounds=300)
    assert found[:2] == pytest.approx(sd[:2], rel=0.12)
    assert found[2] < 0.1
    assert np.corrcoef([deviations(one, found)[1] for one in known], true[:, 1])[0, 1] > 0.99


def test_few_trials_are_shrunk_towards_the_prior():
    prior = np.array([0.3])
    still = [Products.of(np.zeros(50), np.ones((50, 1))) for _ in range(3)]
    strong, weak = (variation(still, prior, weight)[0] for weight in (400.0, 0.01))
    assert strong == pytest.approx(0.3, rel=0.02) and weak < 0.1


def test_the_estimate_is_where_the_likelihood_is_largest():
    residuals, designs, _ = trials(np.array([1.0]), 40, np.random.default_rng(2))
    known = [Products.of(r, b) for r, b in zip(residuals, designs, strict=True)]
    sd = variation(known, np.array([1.0]), weight=1e-9, rounds=5000)
    best = misfit(residuals, designs, sd)
    assert all(misfit(residuals, designs, sd * factor) > best for factor in (0.9, 0.97, 1.03, 1.1))


def test_a_mean_that_was_fitted_to_the_same_trials_is_made_up_for():
    rng = np.random.default_rng(3)
    design = 40.0 * rng.normal(size=(30, 1))
    deviations = rng.normal(size=3)
    known = [Products.of(design[:, 0] * d, design) for d in deviations - deviations.mean()]
    sd = [variation(known, np.ones(1), weight=1e-6, spent=spent, rounds=500)[0] for spent in (0.0, 1.0)]
    assert sd == pytest.approx([np.std(deviations), np.std(deviations, ddof=1)], rel=0.01)


def test_what_trials_do_not_tell_keeps_its_prior():
    silent = [Products.of(np.zeros(20), np.zeros((20, 1))) for _ in range(4)]
    assert variation(silent, np.array([0.3]), weight=1.0, spent=1.0)[0] == pytest.approx(0.3, rel=1e-6)


def test_what_all_trials_have_alike_is_no_variation():
    """A gap is the same in all trials; deviations are taken from their mean."""
    design = 40.0 * np.random.default_rng(4).normal(size=(30, 1))
    alike = [Products.of(5.0 * design[:, 0], design) for _ in range(4)]
    around_zero, around_mean = (variation(alike, np.ones(1), weight=1.0, spent=spent)[0] for spent in (0.0, 1.0))
    assert around_zero == pytest.approx(np.sqrt((1.0 + 4.0 * 25.0) / 5.0), rel=0.01)
    assert around_mean == pytest.approx(np.sqrt(1.0 / 4.0), rel=0.01)
