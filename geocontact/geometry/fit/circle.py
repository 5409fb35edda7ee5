"""The circle that fits points best in a plane, and the cylinder of given direction whose section it is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from geocontact.geometry.fit.cylinder import circle_through
from geocontact.geometry.fit.found import Quality, ShapeFit, arc_covered, fitted, local
from geocontact.geometry.fit.solver import across

LEAST = 5  # points


@dataclass(frozen=True, eq=False)
class CircleFit:
    """Centre and radius [m] in the plane whose axes were given, and how well they are known."""

    centre: Float[np.ndarray, " 2"]
    radius: float
    quality: Quality


def fit_circle(points: Float[np.ndarray, "n 2"], robust: bool = True) -> CircleFit:
    """Geometric least squares with a Cauchy loss, then the biweight (or plain squares) from the algebraic circle."""
    if len(points) < LEAST:
        raise ValueError(f"a circle needs at least {LEAST} points, not {len(points)}")
    here, middle, size = local(np.column_stack([points, np.zeros(len(points))]))
    solution, quality = fitted(here, size, [CircleModel(np.array(circle_through(here[:, :2])))], robust)
    x = solution.model.x
    return CircleFit(middle[:2] + size * x[:2], float(x[2]) * size, quality)


def fit_cylinder_along(
    points: Float[np.ndarray, "n 3"], along: Float[np.ndarray, " 3"], robust: bool = True
) -> ShapeFit:
    """Cylinder whose axis is parallel to `along`.

    The points of one condyle are curved across as much as along, and the cylinder that fits them best may lie the other
    way, with the coronal radius. Holding the direction asks for the sagittal one.
    """
    frame = across(along)
    circle = fit_circle(np.ascontiguousarray(points @ frame[:2].T), robust)
    height = float((points @ frame[2]).mean())
    off = points[circle.quality.inlier] @ frame[:2].T - circle.centre
    arc = arc_covered(np.arctan2(off[:, 1], off[:, 0]))
    point = np.array([*circle.centre, height]) @ frame
    return ShapeFit("cylinder", point, frame[2], circle.radius, arc, circle.quality)


@dataclass(frozen=True)
class CircleModel:
    """x = p, q, R in the plane z = 0; the residual is hypot(x - p, y - q) - R."""

    x: Float[np.ndarray, " 3"]

    names: ClassVar[tuple[str, ...]] = ("shift_u [m]", "shift_v [m]", "radius [m]")
    lengths: ClassVar[tuple[bool, ...]] = (True, True, True)

    def residual(self, x: Float[np.ndarray, " 3"], points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """Distance from the circle, positive outside."""
        return np.asarray(np.hypot(points[:, 0] - x[0], points[:, 1] - x[1]) - x[2])

    def jacobian(self, x: Float[np.ndarray, " 3"], points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
        """Derivative of `residual`."""
        offset = points[:, :2] - x[:2]
        out = offset / np.maximum(np.linalg.norm(offset, axis=1, keepdims=True), 1e-300)
        return np.column_stack([-out, -np.ones(len(points))])

    def moved(self, x: Float[np.ndarray, " 3"]) -> CircleModel:
        """The same circle."""
        return CircleModel(np.array([x[0], x[1], abs(float(x[2]))]))
