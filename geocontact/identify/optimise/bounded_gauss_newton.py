"""Least squares within bounds by damped Gauss-Newton steps, given up where it promises too little.

Levenberg's and Marquardt's damping (Marquardt 1963, J. SIAM 11:431), each unknown measured by the curvature along it,
lowered and raised by how a step keeps what the linear model promised. Unknowns on a bound that the gradient pushes them
against are held, and each step is the best one of the damped quadratic model within the bounds (an active-set method:
Nocedal & Wright, Numerical Optimization, 2006, sec. 16.5). Near a minimum steps are Gauss-Newton's, so that few
derivatives are asked for.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

LIMIT = 200  # steps of a search that ends by itself
CLOSE = 1e-6  # nats, or a share, that is not searched for any further
ROUNDING = float(np.sqrt(np.finfo(float).eps))  # share that half the digits of a number do not show
STEP = float(np.cbrt(np.finfo(float).eps))  # of a magnitude; best for central differences (Numerical Recipes 5.7)

DAMPED = 1e-3  # damping that a search sets out with, as a share of the curvature along each unknown
TENFOLD = 10.0  # factor of the damping after a step that kept its promise and one that did not (Marquardt 1963)
KEPT, BROKEN = 0.75, 0.25  # shares of its promise beyond which damping is lowered, below which it is raised (Moré 1978)


TRUSTED = 3.0
"""Times what the linear model promises that a search is trusted to come down yet: kinks hide some of it."""

Residual = Callable[[Float[np.ndarray, " p"]], Float[np.ndarray, " n"]]
Slope = Callable[[Float[np.ndarray, " p"]], Float[np.ndarray, "n p"]]


@dataclass(frozen=True)
class GaussNewtonResult:
    """Where a search ended, half the sum of squares there, and whether it was finished rather than given up."""

    x: Float[np.ndarray, " p"]
    cost: float
    finished: bool


@dataclass(frozen=True)
class QuadraticModel:
    """A cost to second order: gradient and curvature, and which unknowns may move."""

    gradient: Float[np.ndarray, " p"]
    curvature: Float[np.ndarray, "p p"]
    free: Bool[np.ndarray, " p"]

    @classmethod
    def within(
        cls,
        gradient: Float[np.ndarray, " p"],
        curvature: Float[np.ndarray, "p p"],
        low: Float[np.ndarray, " p"],
        high: Float[np.ndarray, " p"],
    ) -> QuadraticModel:
        """With unknowns held that the gradient pushes against where there is no room: `low` ≤ 0 ≤ `high` is left."""
        return cls(gradient, curvature, ~(((low >= 0.0) & (gradient > 0.0)) | ((high <= 0.0) & (gradient < 0.0))))

    def step(
        self, damping: float, low: Float[np.ndarray, " p"], high: Float[np.ndarray, " p"]
    ) -> Float[np.ndarray, " p"]:
        """The step between `low` and `high` that the damped model gains most by: an active-set search from no step."""
        out, free = np.zeros(len(low)), self.free.copy()
        own, damped = self.curvature.diagonal(), self.curvature.copy()
        damped.ravel()[:: len(low) + 1] += damping * own + ROUNDING * max(float(own.max()), 1e-300)
        pull = self.gradient
        for _ in range(LIMIT):
            if free.all():
                move = -np.linalg.solve(damped, pull)
            else:
                move = np.zeros(len(low))
                move[free] = -np.linalg.solve(damped[np.ix_(free, free)], pull[free])
            ends = np.where(move > 0.0, high, low)
            room = np.divide(ends - out, move, out=np.full(len(low), np.inf), where=move != 0.0)
            first = int(np.argmin(room))
            if room[first] < 1.0:
                out = out + room[first] * move
                out[first], free[first] = ends[first], False
                pull = self.gradient + damped @ out
                continue
            out = out + move
            pull = self.gradient + damped @ out
            inward = ~free & (((out <= low) & (pull < 0.0)) | ((out >= high) & (pull > 0.0)))
            if not inward.any():
                break
            free[int(np.argmax(np.abs(pull) * inward))] = True
        return out

    def promise(self, step: Float[np.ndarray, " p"]) -> float:
        """By how much the cost falls along a step, to second order."""
        return -float(self.gradient @ step + 0.5 * step @ self.curvature @ step)


def least(
    residual: Residual,
    slope: Slope,
    start: Float[np.ndarray, " p"],
    lower: Float[np.ndarray, " p"],
    upper: Float[np.ndarray, " p"],
    rounds: int,
    enough: float,
    useful: float = np.inf,
) -> GaussNewtonResult:
    """Unknowns within bounds that make half the sum of squared residuals least, near a start.

    Parameters
    ----------
    residual, slope
        Of the unknowns; the slope is asked for only where the residual was asked for last.
    start
        Within the bounds.
    rounds
        Evaluations of the residual.
    enough
        Cost that is not worth another step.
    useful
        Cost that must be undercut: where `TRUSTED` what the linear model promises would not do, the search is given up.
    """
    x, r = start, residual(start)
    cost, damping = 0.5 * float(r @ r), DAMPED
    bend, spent = _bend(x, r, slope(x), lower, upper), 1
    while spent < rounds:
        promise = bend.promise(bend.step(0.0, lower - x, upper - x))
        if promise < enough:
            return GaussNewtonResult(x, cost, True)
        if cost - TRUSTED * promise > useful:
            return GaussNewtonResult(x, cost, False)
        step = bend.step(damping, lower - x, upper - x)
        there = np.clip(x + step, lower, upper)
        tried = residual(there)
        spent += 1
        fall, hoped = cost - 0.5 * float(tried @ tried), bend.promise(step)
        kept = fall / hoped if hoped > 0.0 else 0.0
        if kept > KEPT:
            damping = max(damping / TENFOLD, ROUNDING)
        elif not kept > BROKEN:
            damping *= TENFOLD
        if fall > 0.0:
            x, cost = there, cost - fall
            if fall < enough and kept > BROKEN:
                return GaussNewtonResult(x, cost, True)
            bend = _bend(x, tried, slope(x), lower, upper)
        elif damping > 1.0 / ROUNDING:
            break
    return GaussNewtonResult(x, cost, spent < rounds)


def _bend(
    x: Float[np.ndarray, " p"],
    residual: Float[np.ndarray, " n"],
    slope: Float[np.ndarray, "n p"],
    lower: Float[np.ndarray, " p"],
    upper: Float[np.ndarray, " p"],
) -> QuadraticModel:
    return QuadraticModel.within(slope.T @ residual, slope.T @ slope, lower - x, upper - x)
