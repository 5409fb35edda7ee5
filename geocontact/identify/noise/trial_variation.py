"""Trial-to-trial variation of parameters: Gaussian jitter, integrated out.

Each trial i has its own values theta + b_i of some parameters (donning, placement), b_i ~ N(0, Q) with Q diagonal. To
first order its whitened residual is r_i = w_i + B_i b_i with unit noise w_i, hence r_i ~ N(0, I + B_i Q B_i^T). Of a
trial only the products r^T r, B^T r and B^T B are needed:

    log|I + B Q B^T| = log|I + Q B^T B|,   r^T (I + B Q B^T)^-1 r = r^T r - (B^T r)^T (Q^-1 + B^T B)^-1 (B^T r)

(matrix determinant lemma and Woodbury identity). Q by expectation and maximisation, shrunk towards a prior: Laird &
Ware, Random-effects models for longitudinal data, Biometrics 38 (1982).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.identify.optimise.bounded_gauss_newton import CLOSE, LIMIT


@dataclass(frozen=True)
class Products:
    """What one trial contributes, whitened: r^T r, B^T r, B^T B."""

    square: float
    mixed: Float[np.ndarray, " q"]
    gram: Float[np.ndarray, "q q"]

    @classmethod
    def of(cls, residual: Float[np.ndarray, " n"], design: Float[np.ndarray, "n q"]) -> Products:
        """Products of a whitened residual and the whitened derivatives with respect to what varies."""
        return cls(float(residual @ residual), design.T @ residual, design.T @ design)


def variation(
    trials: Sequence[Products],
    prior_sd: Float[np.ndarray, " q"],
    weight: float | Float[np.ndarray, " q"],
    spent: float | Float[np.ndarray, " q"] = 0.0,
    rounds: int = LIMIT,
) -> Float[np.ndarray, " q"]:
    """Most likely standard deviation of each varying parameter.

    The prior is worth `weight` trials of `prior_sd`. `spent` is 1 where deviations are taken from their mean over the
    trials, which uses up one of them as far as the trials tell of the deviations at all: what all trials have alike is
    no variation.
    """
    sd = prior_sd.copy()
    grams, mixed = np.array([trial.gram for trial in trials]), np.array([trial.mixed for trial in trials])
    for _ in range(rounds):
        means, covariances = _conditional(grams, mixed, sd)
        unsure = np.einsum("tqq->q", covariances)
        squares = unsure + ((means - spent * means.mean(axis=0)) ** 2).sum(axis=0)
        identified = 1.0 - unsure / np.maximum(len(trials) * sd**2, 1e-300)
        new = np.sqrt((weight * prior_sd**2 + squares) / (weight + len(trials) - spent * identified))
        done = bool(np.allclose(new, sd, rtol=CLOSE))
        sd = new
        if done:
            break
    return sd


def deviations(trial: Products, sd: Float[np.ndarray, " q"]) -> Float[np.ndarray, " q"]:
    """Most likely deviation of one trial."""
    return np.asarray(_conditional(trial.gram[None], trial.mixed[None], sd)[0][0])


def _conditional(
    grams: Float[np.ndarray, "n q q"], mixed: Float[np.ndarray, "n q"], sd: Float[np.ndarray, " q"]
) -> tuple[Float[np.ndarray, "n q"], Float[np.ndarray, "n q q"]]:
    """Mean and covariance of each trial's deviation given its residual."""
    told, along = np.linalg.eigh(sd[:, None] * grams * sd)
    shrunk = along / (1.0 + np.maximum(told, 0.0))[:, None, :]  # of I + sd gram sd, whatever its condition
    covariances = sd[:, None] * (shrunk @ along.transpose(0, 2, 1)) * sd
    return (covariances @ mixed[..., None])[..., 0], covariances
