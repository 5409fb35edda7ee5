"""The plane that fits points best: trays, plates, cut faces."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np
from jaxtyping import Float

from geocontact.geometry.fit.found import ShapeFit, fitted, local
from geocontact.geometry.fit.solver import FEW, across, half_sphere

STARTS = 16  # normals over the half-sphere, beside that of the smallest extent
LEAST = 4  # points


def fit_plane(points: Float[np.ndarray, "n 3"], robust: bool = True) -> ShapeFit:
    """Orthogonal least squares with a Cauchy loss, then the biweight (or plain squares)."""
    if len(points) < LEAST:
        raise ValueError(f"a plane needs at least {LEAST} points, not {len(points)}")
    here, middle, size = local(points)
    few = here[np.random.default_rng(0).permutation(len(here))[:FEW]]
    flat = np.linalg.svd(few - few.mean(axis=0), full_matrices=False)[2][-1]
    solution, quality = fitted(here, size, [PlaneModel.along(few, n) for n in (flat, *half_sphere(STARTS))], robust)
    model = solution.model
    normal = model.frame[2]
    return ShapeFit("plane", middle + size * float(model.x[2]) * normal, normal, None, 0.0, quality)


@dataclass(frozen=True)
class PlaneModel:
    """All q with t . q = h |t|, t = (a, b, 1) in the frame whose axes are the rows of `frame`; x = a, b, h.

    The residual n . q - h, n = t / |t|, changes with a by (q1 - n1 (n . q)) / |t|, with b likewise, with h by -1.
    """

    frame: Float[np.ndarray, "3 3"]
    x: Float[np.ndarray, " 3"]

    names: ClassVar[tuple[str, ...]] = ("tilt_u [rad]", "tilt_v [rad]", "height [m]")
    lengths: ClassVar[tuple[bool, ...]] = (False, False, True)

    @classmethod
    def along(cls, points: Float[np.ndarray, "n 3"], normal: Float[np.ndarray, " 3"]) -> PlaneModel:
        """Start with that normal, at the median height."""
        frame = across(normal)
        return cls(frame, np.array([0.0, 0.0, float(np.median(points @ frame[2]))]))

    def residual(self, x: Float[np.ndarray, " 3"], points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
        """Height above the plane, on the side to which its normal points."""
        return np.asarray(points @ self._normal(x) - x[2])

    def jacobian(self, x: Float[np.ndarray, " 3"], points: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, "n 3"]:
        """Derivative of `residual`."""
        normal, length = self._normal(x), float(np.sqrt(1.0 + x[0] ** 2 + x[1] ** 2))
        height = points @ normal
        sideways = (points @ self.frame[:2].T - height[:, None] * (self.frame[:2] @ normal)) / length
        return np.column_stack([sideways, -np.ones(len(points))])

    def moved(self, x: Float[np.ndarray, " 3"]) -> PlaneModel:
        """The same plane in a frame along its own normal."""
        normal = self._normal(x)
        frame = across(normal)
        return PlaneModel(frame, np.array([0.0, 0.0, float(x[2]) * float(np.sign(frame[2] @ normal))]))

    def _normal(self, x: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " 3"]:
        tilt = np.array([x[0], x[1], 1.0]) @ self.frame
        return np.asarray(tilt / np.linalg.norm(tilt))
