"""How long the residual of a fit remembers, and what a noise that remembers leaves in the means of bins.

The residual is taken for an Ornstein-Uhlenbeck process (`noise.Noise`): correlation exp(-h/tau) at a distance h.
Over one gait cycle tau is poorly known, and intervals that take its best value for the truth are too short. So each
tau of a grid keeps a weight, its restricted likelihood (Patterson and Thompson 1971, Biometrika 58, 545) times a
reference prior, and intervals are taken over all of them. The prior is the root of Fisher's information on log tau, as
of Berger, De Oliveira and Sanso (2001), JASA 96, 1361, without the regressors. One that is flat in log tau favours
times so long that no recording tells them, and intervals come out too wide (`benchmarks.knee.modulus`). Plain least
squares gives the estimates; their variance under such noise is the sandwich s^2 (J'J)^-1 J'KJ (J'J)^-1.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import exp

import numpy as np
from jaxtyping import Float, Int
from scipy.optimize import brentq
from scipy.special import stdtr, stdtrit

from geocontact.geometry.kernels.compile import kernel
from geocontact.identify.noise.autoregressive import AutoregressiveNoise
from geocontact.identify.optimise.bounded_gauss_newton import ROUNDING

GRID = 30  # correlation times
SHORTEST = 0.2  # of a step: no memory at all
LONGEST = 1.0 / 3.0  # of the duration: more cannot be distinguished from a wrong model
PAUSE = 20.0  # usual steps: a longer one is a pause and does not count as duration


@dataclass(frozen=True, eq=False)
class Autocorrelation:
    """Correlation times, their weights, and the residual's variance with each.

    Parameters
    ----------
    tau
        [s].
    weight
        Sums to 1.
    variance
        Of the noise with each tau, in the square of its unit.
    freedom
        Samples less parameters.
    """

    tau: Float[np.ndarray, " g"]
    weight: Float[np.ndarray, " g"]
    variance: Float[np.ndarray, " g"]
    freedom: int

    @property
    def typical(self) -> float:
        """Weighted geometric mean of the correlation times [s]."""
        return float(np.exp(self.weight @ np.log(self.tau)))

    def half_width(self, spread: Float[np.ndarray, " g"], level: float) -> float:
        """Half the interval of probability `level`, for Student's t of standard errors `spread`, one per tau."""
        largest = float(spread.max())
        if largest <= 0.0:
            return 0.0
        far = float(stdtrit(self.freedom, 0.5 + 0.5 * level)) * largest

        def missing(half: float) -> float:
            inside = 2.0 * stdtr(self.freedom, half / np.maximum(spread, 1e-300)) - 1.0
            return float(self.weight @ inside) - level

        return float(brentq(missing, 0.0, 2.0 * far, rtol=1e-10))


def autocorrelation_of(
    time: Float[np.ndarray, " n"], residual: Float[np.ndarray, " n"], jacobian: Float[np.ndarray, "n p"]
) -> Autocorrelation:
    """Weights of the correlation times by the restricted likelihood of the residuals of the fit."""
    n, p = jacobian.shape
    steps = np.diff(time)
    usual = float(np.median(steps))
    duration = float(steps[steps < PAUSE * usual].sum())
    tau = np.geomspace(SHORTEST * usual, LONGEST * duration, GRID)
    logs, variance = np.empty(GRID), np.empty(GRID)
    both = np.column_stack([residual, jacobian / np.linalg.norm(jacobian, axis=0)])[:, None, :]
    for k, each in enumerate(tau):
        noise = AutoregressiveNoise(np.ones(1), np.array([each]))
        white = noise.whitened(time, both)
        off, design = white[:, 0], white[:, 1:]
        rest = off - design @ np.linalg.lstsq(design, off, rcond=None)[0]
        square = max(float(rest @ rest), np.finfo(float).tiny)
        variance[k] = square / (n - p)
        sizes = np.linalg.svd(design, compute_uv=False)
        information = 2.0 * float(np.log(np.maximum(sizes, ROUNDING * sizes[0])).sum())
        likelihood = -0.5 * (n - p) * np.log(square) - noise.log_scale(time, residual[:, None])
        logs[k] = likelihood - 0.5 * information + _log_prior(time, each)
    weight = np.exp(logs - logs.max())
    return Autocorrelation(tau, weight / weight.sum(), variance, n - p)


def sandwich(
    memory: Autocorrelation, time: Float[np.ndarray, " n"], jacobian: Float[np.ndarray, "n p"]
) -> Float[np.ndarray, "g p p"]:
    """Covariance of the least-squares estimates for each correlation time."""
    decay = np.exp(-np.diff(time)[:, None] / memory.tau)
    middle = _correlated_products(decay, np.ascontiguousarray(jacobian, float))
    bread = spread(jacobian)
    return np.asarray(memory.variance[:, None, None] * (bread @ middle @ bread))


def spread(jacobian: Float[np.ndarray, "n p"]) -> Float[np.ndarray, "p p"]:
    """(J'J)^-1, whatever the units of the parameters; its pseudo-inverse where some of them act as one."""
    size = np.linalg.norm(jacobian, axis=0)
    columns = jacobian / size
    return np.asarray(np.linalg.pinv(columns.T @ columns, rcond=ROUNDING, hermitian=True) / np.outer(size, size))


def _log_prior(time: Float[np.ndarray, " n"], tau: float) -> float:
    """Logarithm of the reference prior per log tau: half that of sum (rho h/tau)^2 / (1 - rho^2), rho = exp(-h/tau)."""
    h = np.diff(time) / tau
    return 0.5 * float(np.logaddexp.reduce(2.0 * (np.log(h) - h) - np.log(-np.expm1(-2.0 * h))))


@kernel
def _correlated_products(
    decay: Float[np.ndarray, "n-1 g"], jacobian: Float[np.ndarray, "n p"]
) -> Float[np.ndarray, "g p p"]:
    """J'KJ of an Ornstein-Uhlenbeck noise of variance 1; `decay` is the correlation from each sample to the next."""
    times, (n, p) = decay.shape[1], jacobian.shape
    past, middle = np.zeros((times, p)), np.zeros((times, p, p))
    for k in range(n):
        for g in range(times):
            for a in range(p):
                if k > 0:
                    past[g, a] *= decay[k - 1, g]
            for a in range(p):
                for b in range(p):
                    crossed = past[g, a] * jacobian[k, b] + past[g, b] * jacobian[k, a]
                    middle[g, a, b] += crossed + jacobian[k, a] * jacobian[k, b]
            for a in range(p):
                past[g, a] += jacobian[k, a]
    return middle


@kernel
def mean_covariance(
    time: Float[np.ndarray, " t"], place: Int[np.ndarray, " t"], bins: int, tau: float
) -> Float[np.ndarray, "b b"]:
    """Covariance of the bins' means of an Ornstein-Uhlenbeck noise of variance 1 and correlation time `tau` [s].

    Parameters
    ----------
    time, place
        Of each sample of one trial, in the order of time [s]; the bin that it falls into.

    Returns
    -------
    array
        Mean of exp(-lag/tau) over the pairs of samples of two bins; 0 for a bin without samples.
    """
    out, count, kept = np.zeros((bins, bins)), np.zeros(bins), np.zeros(bins)
    for i in range(time.size):
        if i > 0:
            kept *= exp(-(time[i] - time[i - 1]) / tau)
        here = place[i]
        for b in range(bins):
            out[here, b] += kept[b]
            out[b, here] += kept[b]
        out[here, here] += 1.0
        kept[here] += 1.0
        count[here] += 1.0
    for a in range(bins):
        for b in range(bins):
            out[a, b] /= max(count[a] * count[b], 1.0)
    return out
