"""The cylinder that fits points best."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from geocontact.geometry.fit.found import ShapeFit, arc_covered, fitted, local
from geocontact.geometry.fit.solver import FEW, across, half_sphere

STARTS = 24  # directions over the half-sphere
LEAST = 6  # points


def fit_cylinder(points: Float[np.ndarray, "n 3"], robust: bool = True) -> ShapeFit:
    """Geometric least squares, Cauchy loss, then biweight (or plain squares), from directions over the half-sphere.

    Partial arcs down to about 60 degrees are determined, flatter ones hardly: `ShapeFit.arc` tells. A surface that is
    no cylinder gets the one that is closest to most of it; which faces count is the caller's choice, and decides.
    """
    if len(points) < LEAST:
        raise ValueError(f"a cylinder needs at least {LEAST} points, not {len(points)}")
    here, middle, size = local(points)
    few = here[np.random.default_rng(0).permutation(len(here))[:FEW]]
    solution, quality = fitted(here, size, [CylinderModel.through(few, d) for d in half_sphere(STARTS)], robust)
    model = solution.model
    point, axis = model.line(model.x)
    inside = here[quality.inlier] - point
    angle = np.arctan2(*(inside @ model.frame[:2].T).T)
    return ShapeFit("cylinder", middle + size * point, axis, float(model.x[4]) * size, arc_covered(angle), quality)


@dataclass(frozen=True)
class CylinderModel:
    """Axis through (p, q, 0) along (a, b, 1) in the frame whose axes are the rows of `frame`; x = a, b, p, q, R.

    With u the unit vector from the axis to a point and h the point's height along the axis, the residual rho - R
    changes with a, b, p, q, R by -h u1 / |t|, -h u2 / |t|, -u1, -u2, -1, where u1, u2 are components of u across the
    frame and t = (a, b, 1): u is perpendicular to the axis, so that the length of t does not matter to first order.
    """

    frame: Float[np.ndarray, "3 3"]
    x: Float[np.ndarray, " 5"]

    names: ClassVar[tuple[str, ...]] = ("tilt_u [rad]", "tilt_v [rad]", "shift_u [m]", "shift_v [m]", "radius [m]")
    lengths: ClassVar[tuple[bool, ...]] = (False, False, True, True, True)

    @classmethod
    def through(cls, points: Float[np.ndarray, "n 3"], axis: Float[np.ndarray, " 3"]) -> CylinderModel:
        """Start along `axis`: the algebraic circle through the projected points."""
        frame = across(axis)
        p, q, radius = circle_through(points @ frame[:2].T)
        return cls(frame, np.array([0.0, 0.0, p, q, radius]))

    def residual(self, x: Float[np.ndarray, " 5"], points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """Distance from the wall, positive outside."""
        return np.asarray(self._parts(x, points)[3] - x[4])

    def jacobian(self, x: Float[np.ndarray, " 5"], points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 5"]:
        """Derivative of `residual`."""
        length, height, out, _ = self._parts(x, points)
        sideways = -(out @ self.frame[:2].T)
        return np.column_stack([height[:, None] / length * sideways, sideways, -np.ones(len(points))])

    def moved(self, x: Float[np.ndarray, " 5"]) -> CylinderModel:
        """The same cylinder in a frame along its own axis."""
        point, axis = self.line(x)
        frame = across(axis)
        return CylinderModel(frame, np.array([0.0, 0.0, *(frame[:2] @ point), abs(float(x[4]))]))

    def line(self, x: Float[np.ndarray, " 5"]) -> tuple[Float[np.ndarray, " 3"], Float[np.ndarray, " 3"]]:
        """Point of the axis nearest to the origin of the frame's plane, and unit vector along the axis."""
        tilt = np.array([x[0], x[1], 1.0]) @ self.frame
        return np.asarray(np.array([x[2], x[3], 0.0]) @ self.frame), np.asarray(tilt / np.linalg.norm(tilt))

    def _parts(
        self, x: Float[np.ndarray, " 5"], points: Float[np.ndarray, "n 3"]
    ) -> tuple[float, Float[np.ndarray, " n"], Float[np.ndarray, "n 3"], Float[np.ndarray, " n"]]:
        """Length of t, height along the axis, unit vector from the axis (zero on it), distance from the axis."""
        point, axis = self.line(x)
        offset = points - point
        height = offset @ axis
        radial = offset - height[:, None] * axis
        distance = np.sqrt(np.einsum("ij,ij->i", radial, radial))
        length = float(np.sqrt(1.0 + x[0] ** 2 + x[1] ** 2))
        return length, height, radial / np.maximum(distance, 1e-300)[:, None], distance


def circle_through(points: Float[np.ndarray, "n 2"]) -> tuple[float, float, float]:
    """Centre and radius of the algebraic circle (Kasa 1976): linear, but too small on noisy short arcs; a start."""
    rows = np.column_stack([2.0 * points, np.ones(len(points))])
    p, q, rest = np.linalg.lstsq(rows, (points**2).sum(axis=1), rcond=None)[0]
    return float(p), float(q), float(np.sqrt(max(rest + p * p + q * q, 1e-6)))
