"""Levenberg-Marquardt within bounds, for small problems that are solved thousands of times.

Marquardt (1963), SIAM J. Appl. Math. 11, 431, with the scaling of Moré (1978), Lecture Notes in Mathematics 630, 105.
Bounds as Kanzow, Yamashita and Fukushima (2004), J. Comput. Appl. Math. 172, 375: steps are cut at the bounds, and a
parameter that its gradient pushes against its bound is left out of the step. `least_squares.fit` is the general way,
for any prediction over trials; this one is for a model that brings its derivatives.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.identify.optimise.bounded_gauss_newton import DAMPED, LIMIT, ROUNDING

Vector = Float[np.ndarray, " p"]
Residual = Callable[[Vector], Float[np.ndarray, " n"]]
Jacobian = Callable[[Vector], Float[np.ndarray, "n p"]]


@dataclass(frozen=True, eq=False)
class LevenbergMarquardtResult:
    """Where a search ended: the parameters, half the sum of squares, and whether it ended by itself."""

    values: Float[np.ndarray, " p"]
    cost: float
    converged: bool
    steps: int


def levenberg_marquardt(
    residual: Residual,
    jacobian: Jacobian,
    start: Float[np.ndarray, " p"],
    lower: Float[np.ndarray, " p"],
    upper: Float[np.ndarray, " p"],
    scale: Float[np.ndarray, " p"],
) -> LevenbergMarquardtResult:
    """Least squares from one start; `scale` is the magnitude of each parameter."""
    z = np.clip(start, lower, upper)
    off = residual(z)
    cost, damping = 0.5 * float(off @ off), DAMPED
    slopes = jacobian(z) * scale
    widest = np.zeros(len(z))
    for count in range(1, LIMIT + 1):
        gradient, hessian = slopes.T @ off, slopes.T @ slopes
        widest = np.maximum(widest, np.diag(hessian))
        free = ~(((z <= lower) & (gradient > 0.0)) | ((z >= upper) & (gradient < 0.0)))
        if not free.any() or not np.abs(gradient[free]).max() > 0.0:
            return LevenbergMarquardtResult(z, cost, True, count)
        while True:
            tried = _stepped(z, hessian, gradient, free, damping * widest, lower, upper, scale)
            moved = float(np.abs((tried - z) / scale).max())
            there = residual(tried)
            lower_cost = 0.5 * float(there @ there)
            if lower_cost < cost or moved <= ROUNDING or damping > 1.0 / ROUNDING:
                break
            damping *= 4.0
        if not lower_cost < cost:
            return LevenbergMarquardtResult(z, cost, True, count)
        gain = cost - lower_cost
        z, off, cost, damping = tried, there, lower_cost, max(damping / 9.0, 1e-15)
        if gain <= ROUNDING**2 * (cost + gain) or moved <= ROUNDING:
            return LevenbergMarquardtResult(z, cost, True, count)
        slopes = jacobian(z) * scale
    return LevenbergMarquardtResult(z, cost, False, LIMIT)


def _stepped(
    z: Float[np.ndarray, " p"],
    hessian: Float[np.ndarray, "p p"],
    gradient: Float[np.ndarray, " p"],
    free: np.ndarray,
    damping: Float[np.ndarray, " p"],
    lower: Float[np.ndarray, " p"],
    upper: Float[np.ndarray, " p"],
    scale: Float[np.ndarray, " p"],
) -> Float[np.ndarray, " p"]:
    """The parameters after one damped step within the bounds."""
    damped = hessian + np.diag(np.maximum(damping, np.finfo(float).tiny))
    damped[~free] = 0.0
    damped[:, ~free] = 0.0
    damped[~free, ~free] = 1.0
    step = np.linalg.solve(damped, np.where(free, -gradient, 0.0))
    return np.asarray(np.clip(z + scale * step, lower, upper))
