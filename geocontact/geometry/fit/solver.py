"""Geometric least squares from several starts: a Cauchy loss whose scale follows the residuals, then the biweight.

With r the signed distances of the points to the shape and s = 1.4826 median |r|, their standard deviation if they are
normal, the search minimises first sum log(1 + (r / c)²), c = 2.385 s, under which a point far off pulls as 1 / r, then
Tukey's biweight, sum 1 - (1 - (r / c)²)³ up to c = 4.685 s, under which points beyond c do not pull at all. Both are
95 % as efficient as least squares on normal residuals (Holland and Welsch 1977, Communications in Statistics A6,
813-827); s and the parameters are found in turn. The second step takes away most of the bias that outliers on one side
leave: of a 120 degree arc with a fifth of its points on another face, -0.07 mm becomes -0.006 mm (radius 37 mm).
Points come about their middle, in units of their size, so that the numbers here need no unit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar, Generic, Literal, Protocol, TypeVar, runtime_checkable

import numpy as np
from jaxtyping import Float


def half_sphere(count: int) -> list[Float[np.ndarray, " 3"]]:
    """Nearly even directions on the half-sphere (Fibonacci lattice)."""
    z = (np.arange(count) + 0.5) / count
    turn = np.pi * (3.0 - np.sqrt(5.0)) * np.arange(count)
    ring = np.sqrt(1.0 - z * z)
    return list(np.stack([ring * np.cos(turn), ring * np.sin(turn), z], axis=1))


def across(direction: Float[np.ndarray, " 3"]) -> Float[np.ndarray, "3 3"]:
    """Rows: two unit vectors across the direction, and the direction, a unit vector whose largest part is positive."""
    largest = direction[int(np.argmax(np.abs(direction)))]
    along = direction * (np.sign(largest) / np.linalg.norm(direction))
    u = np.cross(along, np.eye(3)[int(np.argmin(np.abs(along)))])
    u /= np.linalg.norm(u)
    return np.stack([u, np.cross(along, u), along])


NORMAL = 1.4826  # standard deviation over median absolute value, normal distribution
CAUCHY, BIWEIGHT = 2.385, 4.685  # scale of the loss over standard deviation
FEW, SOME = 500, 4000  # points that the starts and the search for the scale are tried on
COARSE = 0.05  # scale of the first search, share of the size
FINEST = 1e-12  # share of the size below which residuals count as equal
FINALISTS = 3
PASSES = 40  # of scale and parameters in turn
SETTLED, ROUGH = 1e-3, 1e-2  # relative change of the scale at which they end, at last and among the finalists
TIGHT, LOOSE = 1e-10, 1e-6  # relative change of loss and parameters at which such a search ends

Same = TypeVar("Same")


@runtime_checkable
class ShapeModel(Protocol):
    """A shape in coordinates of its own, with the names of its parameters and which of them are lengths."""

    names: ClassVar[tuple[str, ...]]
    lengths: ClassVar[tuple[bool, ...]]

    @property
    def x(self) -> Float[np.ndarray, " p"]:
        """Parameters of the shape in these coordinates."""
        ...

    def residual(self, x: Float[np.ndarray, " p"], points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """Signed distance of points to the shape, positive outside."""
        ...

    def jacobian(self, x: Float[np.ndarray, " p"], points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n p"]:
        """Derivative of `residual` by the parameters."""
        ...

    def moved(self: Same, x: Float[np.ndarray, " p"]) -> Same:
        """The shape with parameters `x`, in coordinates about itself."""
        ...


M = TypeVar("M", bound=ShapeModel)
Loss = Literal["linear", "cauchy", "biweight"]


@dataclass(frozen=True)
class Solution(Generic[M]):
    """The best shape, the scale of the biweight (None: squares), and whether the search ended by itself."""

    model: M
    scale: float | None
    converged: bool


def solve(points: Float[np.ndarray, "n 3"], starts: Sequence[M], robust: bool) -> Solution[M]:
    """Best of several searches, refined on all points; plain least squares if not `robust`.

    The searches run on some of the points, always the same ones, with a wide loss; the best few are refined on more,
    and the best of these on all.
    """
    mixed = np.random.default_rng(0).permutation(len(points))
    few, some = points[mixed[:FEW]], points[mixed[:SOME]]
    if not robust:
        best = _best([_searched(few, start, "linear", 1.0, 1e-5)[0] for start in starts], few, robust)[0]
        model, converged = _searched(points, best, "linear", 1.0, 1e-10)
        return Solution(model, None, converged)
    found = _best([_searched(few, start, "cauchy", COARSE, 1e-5)[0] for start in starts], few, robust)[:FINALISTS]
    settled = _best([_settled(some, model, "cauchy", CAUCHY, ROUGH).model for model in found], some, robust)[0]
    return _settled(points, settled, "biweight", BIWEIGHT)


def _best(models: Sequence[M], points: Float[np.ndarray, "n 3"], robust: bool) -> list[M]:
    """Models in the order of their Cauchy loss, all with the finest scale that one of them reaches, or of squares."""
    residuals = [model.residual(model.x, points) for model in models]
    scale = CAUCHY * min(spread(residual) for residual in residuals)
    loss = [float((np.log1p((r / scale) ** 2) if robust else r**2).sum()) for r in residuals]
    return [models[k] for k in np.argsort(loss, kind="stable")]


def _settled(
    points: Float[np.ndarray, "n 3"], model: M, loss: Loss, tuning: float, settled: float = SETTLED
) -> Solution[M]:
    """Scale and parameters in turn until the scale changes by no more than `settled` of itself."""
    scale, converged = tuning * spread(model.residual(model.x, points)), False
    for _ in range(PASSES):
        model, converged = _searched(points, model, loss, scale, TIGHT if settled == SETTLED else LOOSE)
        before, scale = scale, tuning * spread(model.residual(model.x, points))
        if abs(scale - before) <= settled * before or scale <= tuning * FINEST:
            break
    return Solution(model, scale, converged)


def _searched(points: Float[np.ndarray, "n 3"], model: M, loss: Loss, scale: float, tolerance: float) -> tuple[M, bool]:
    """One search from the model's own parameters, and whether it ended by itself."""
    from scipy.optimize import least_squares

    def residual(x: Float[np.ndarray, " p"]) -> Float[np.ndarray, " n"]:
        return model.residual(x, points)

    def jacobian(x: Float[np.ndarray, " p"]) -> Float[np.ndarray, "n p"]:
        return model.jacobian(x, points)

    shown: Any = biweight if loss == "biweight" else loss  # the stubs know none of the losses one may write oneself
    fit = least_squares(
        residual,
        model.x,
        jacobian,
        loss=shown,
        f_scale=scale,
        ftol=tolerance,
        xtol=tolerance,
        gtol=1e-15,
        max_nfev=200,
    )
    return model.moved(fit.x), bool(fit.status > 0)


def biweight(square: Float[np.ndarray, " n"]) -> Float[np.ndarray, "3 n"]:
    """Tukey's loss of squared residuals in units of its scale, and its first two derivatives."""
    left = np.maximum(1.0 - square, 0.0)
    return np.stack([(1.0 - left**3) / 3.0, left**2, -2.0 * left])


def spread(residual: Float[np.ndarray, " n"]) -> float:
    """Standard deviation of normal residuals about zero, estimated from their median size: outliers hardly matter."""
    return max(NORMAL * float(np.median(np.abs(residual))), FINEST)
