"""How probable the data are under a model, its unknowns integrated out to first order around the fit.

Whitened residuals r (unit noise) and a design D of derivatives with prior standard deviations S give
r ~ N(0, I + D S² Dᵀ): Laplace's approximation for fitted parameters, exact for linear ones such as the weights of a
surrogate (Rasmussen & Williams, Gaussian Processes for Machine Learning, 2006, ch. 2 and 5). On calibration trials and
held-out trials together this is the likelihood of the former times the predictive likelihood of the latter, although
no parameter was fitted to them.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.chain.system import System
from geocontact.gap.case.problem import Noise, Problem
from geocontact.gap.case.refit import Refit, free, magnitude
from geocontact.gap.case.whitening import Whitening
from geocontact.gap.levels import FLAT
from geocontact.identify.optimise.bounded_gauss_newton import ROUNDING, STEP


@dataclass(frozen=True)
class Judged:
    """A fitted model with noise levels of its own.

    Parameters
    ----------
    model
        Evaluated on all trials, whitened with its own noise.
    noise
        Its own.
    nats
        Logarithm of the evidence of all trials; only differences between models of one problem mean anything.
    calibration
        The same for the calibration trials alone.
    fitted_rows
        How many of the whitened rows, the first, are of calibration trials.
    discrepancy_basis
        What the effects may do otherwise than their candidates, per trial, and the same whitened.
    """

    model: Refit
    noise: Noise
    nats: float
    calibration: float
    fitted_rows: int
    discrepancy_basis: list[Float[np.ndarray, "_ c m"]]
    whitened_basis: Float[np.ndarray, "n m"]

    @property
    def loose(self) -> Float[np.ndarray, "n k"]:
        """Everything that is free to move, in units of its prior spread: parameters, then the discrepancy basis."""
        spread = prior_spread(self.model.system, self.model.values)
        return np.concatenate([self.model.whitened_jacobian * spread, self.whitened_basis], axis=1)


def judged(problem: Problem, model: Refit, noise: Noise, discrepancy_basis: list[Float[np.ndarray, "_ c m"]]) -> Judged:
    """A model evaluated on all trials, under a noise."""
    whitenings = problem.whitenings(noise, model)
    model = model.weighed(whitenings)
    spread = prior_spread(model.system, model.values)
    rows = sum(len(w.directions) for w in whitenings[: len(problem.calibration.trials)])
    scales = np.array([w.log_scale for w in whitenings])
    whitened_basis = np.concatenate([w(b) for w, b in zip(whitenings, discrepancy_basis, strict=True)])
    design = np.concatenate([model.whitened_jacobian, whitened_basis], axis=1)
    spread = np.concatenate([spread, np.ones(whitened_basis.shape[1])])
    fitted = scales[: len(problem.calibration.trials)].sum() + noise.surprise
    smoothed = by_smoothing(problem, model, whitenings)
    return Judged(
        model,
        noise,
        log_evidence(model.whitened, design, spread)
        + held_back(model)
        - float(smoothed.sum())
        - float(scales.sum())
        - noise.surprise,
        log_evidence(model.whitened[:rows], design[:rows], spread)
        + held_back(model, rows)
        - float(smoothed[: len(problem.calibration.trials)].sum())
        - float(fitted),
        rows,
        discrepancy_basis,
        whitened_basis,
    )


def by_smoothing(problem: Problem, model: Refit, whitenings: Sequence[Whitening]) -> Float[np.ndarray, " k"]:
    """What each trial's squared residual owes to passing less noise of the inputs on than the base model does [nats].

    A low-pass or a damper has smaller residuals for it without being any better. The half square of what more noise
    makes of the prediction says by how much (corrected likelihood: Nakamura 1990, Biometrika 77:127; by noise added in
    simulation: Cook & Stefanski 1994, J. Am. Stat. Assoc. 89:1314). Whoever passes more of it on gains nothing by it.
    """
    owed = np.zeros(len(whitenings))
    for i, (whiten, own, base) in enumerate(zip(whitenings, model.passed_on, problem.passed_on, strict=False)):
        if np.isfinite(own).all() and np.isfinite(base).all():
            owed[i] = 0.5 * float((whiten(base[..., None]) ** 2).sum() - (whiten(own[..., None]) ** 2).sum())
    total, positive = float(owed.sum()), np.maximum(owed, 0.0)
    return np.asarray(positive * (total / positive.sum())) if total > 0.0 else np.zeros(len(whitenings))


def settled(problem: Problem, one: Judged, noises: Sequence[Noise]) -> Judged:
    """The same model under whichever of several noises makes the data most probable.

    Noise levels are found by a search of its own, on blocks and on calibration trials; models that differ by a few nats
    are compared under each other's as well.
    """
    others = [judged(problem, one.model, noise, one.discrepancy_basis) for noise in noises if noise is not one.noise]
    return max([one, *others], key=lambda each: each.nats)


def log_evidence(
    residual: Float[np.ndarray, " n"], design: Float[np.ndarray, "n p"], spread: Float[np.ndarray, " p"]
) -> float:
    """Logarithm of N(r; 0, I + D S² Dᵀ), without the constant.

    rᵀ (I + D S² Dᵀ)⁻¹ r is the least of |r - D S x|² + |x|²: summed so, whatever rounding
    does to x, it is no less than that.
    """
    scaled = design * spread
    inner = np.eye(len(spread)) + scaled.T @ scaled
    weights = np.linalg.solve(inner, scaled.T @ residual)
    left = residual - scaled @ weights
    quadratic = float(left @ left) + float(weights @ weights)
    return -0.5 * quadratic - 0.5 * float(np.linalg.slogdet(inner)[1])


def held_back(model: Refit, rows: int | None = None) -> float:
    """What parameters on a bound cost: the share of their range that the data leave them [nats, at most 0]."""
    spread = prior_spread(model.system, model.values)
    residual, design = model.whitened[:rows], model.whitened_jacobian[:rows]
    others = design[:, spread > 0.0] * spread[spread > 0.0]
    inner = np.linalg.cholesky(np.eye(others.shape[1]) + others.T @ others)
    total = 0.0
    for k in np.flatnonzero(spread == 0.0):
        p = free(model.system)[k]
        width = p.upper - p.lower
        if not 0.0 < width < np.inf:
            continue
        inward = width if model.values[p.name] - p.lower < p.upper - model.values[p.name] else -width
        move = design[:, k] * inward
        along = np.linalg.solve(inner, others.T @ np.column_stack([residual, move]))  # what the others make up for
        fall = float(along[:, 0] @ along[:, 1]) - float(move @ residual)
        bend = float(move @ move) - float(along[:, 1] @ along[:, 1])
        total += min(log_mean(max(fall, 0.0), max(bend, 0.0)), 0.0)
    return total


def log_mean(fall: float, bend: float) -> float:
    """Logarithm of the mean of exp(-fall t - bend t²/2) over 0 <= t <= 1, both at least 0.

    With a = fall/sqrt(2 bend) and c = sqrt(bend/2) it is sqrt(π)/(2 c) (erfcx(a) - exp(-fall - bend/2) erfcx(a + c)).
    """
    from scipy.special import erfcx

    c = np.sqrt(0.5 * max(bend, ROUNDING))
    a = 0.5 * fall / c
    mean = 0.5 * np.sqrt(np.pi) / c * (erfcx(a) - np.exp(-2.0 * a * c - c**2) * erfcx(a + c))
    return float(np.log(max(mean, 1e-300)))


def prior_spread(system: System, values: dict[str, float]) -> Float[np.ndarray, " p"]:
    """Prior standard deviation of each free parameter: that of a flat prior over its bounds, 0 where it sits on one."""
    spread = []
    for p in free(system):
        width = p.upper - p.lower
        held = min(values[p.name] - p.lower, p.upper - values[p.name]) < 10.0 * STEP * magnitude(p)
        spread.append(0.0 if held else width / FLAT if np.isfinite(width) else 100.0 * magnitude(p))
    return np.array(spread)


def without_discrepancy(one: Judged) -> list[Float[np.ndarray, "_ c"]]:
    """Residuals without what the effects most probably do otherwise than their candidates."""
    loose = one.loose
    weights = np.linalg.solve(np.eye(loose.shape[1]) + loose.T @ loose, loose.T @ one.model.whitened)
    own = weights[loose.shape[1] - one.whitened_basis.shape[1] :]
    return [r - b @ own for r, b in zip(one.model.residuals, one.discrepancy_basis, strict=True)]
