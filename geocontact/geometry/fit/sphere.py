"""The sphere that fits points best: femoral heads, cups, spherical indenters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from geocontact.geometry.fit.found import ShapeFit, fitted, local
from geocontact.geometry.fit.solver import FEW

STARTS = 12  # spheres through points drawn at random
DRAWN = 8  # points each
LEAST = 5


def fit_sphere(points: Float[np.ndarray, "n 3"], robust: bool = True) -> ShapeFit:
    """Geometric least squares with a Cauchy loss, then the biweight (or plain squares).

    Starts are the algebraic sphere through all points and those through a few drawn ones, some of which are free of
    outliers (two of three without any where a twentieth of the points are outliers, one of six where a fifth are).
    """
    if len(points) < LEAST:
        raise ValueError(f"a sphere needs at least {LEAST} points, not {len(points)}")
    here, middle, size = local(points)
    random = np.random.default_rng(0)
    few = here[random.permutation(len(here))[:FEW]]
    drawn = [few[random.permutation(len(few))[:DRAWN]] for _ in range(STARTS)]
    solution, quality = fitted(here, size, [SphereModel.through(some) for some in (few, *drawn)], robust)
    x = solution.model.x
    out = here[quality.inlier] - x[:3]
    out /= np.maximum(np.linalg.norm(out, axis=1, keepdims=True), 1e-300)
    pole = out.mean(axis=0)
    cosine = out @ (pole / max(float(np.linalg.norm(pole)), 1e-300))
    arc = 2.0 * float(np.arccos(np.clip(cosine.min(), -1.0, 1.0)))
    return ShapeFit("sphere", middle + size * x[:3], None, float(x[3]) * size, arc, quality)


@dataclass(frozen=True)
class SphereModel:
    """x = centre and radius; the residual |p - c| - R changes by minus the unit vector from the centre, and by -1."""

    x: Float[np.ndarray, " 4"]

    names: ClassVar[tuple[str, ...]] = ("centre_x [m]", "centre_y [m]", "centre_z [m]", "radius [m]")
    lengths: ClassVar[tuple[bool, ...]] = (True, True, True, True)

    @classmethod
    def through(cls, points: Float[np.ndarray, "n 3"]) -> SphereModel:
        """The algebraic sphere (Coope 1993): linear least squares, the smallest of many where points lie in a plane."""
        rows = np.column_stack([2.0 * points, np.ones(len(points))])
        c = np.linalg.lstsq(rows, (points**2).sum(axis=1), rcond=None)[0]
        return cls(np.array([*c[:3], np.sqrt(max(c[3] + c[:3] @ c[:3], 1e-6))]))

    def residual(self, x: Float[np.ndarray, " 4"], points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """Distance from the sphere, positive outside."""
        return np.asarray(np.linalg.norm(points - x[:3], axis=1) - x[3])

    def jacobian(self, x: Float[np.ndarray, " 4"], points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 4"]:
        """Derivative of `residual`."""
        offset = points - x[:3]
        out = offset / np.maximum(np.linalg.norm(offset, axis=1, keepdims=True), 1e-300)
        return np.column_stack([-out, -np.ones(len(points))])

    def moved(self, x: Float[np.ndarray, " 4"]) -> SphereModel:
        """The same sphere; its coordinates are those of space."""
        return SphereModel(np.array([*x[:3], abs(float(x[3]))]))
