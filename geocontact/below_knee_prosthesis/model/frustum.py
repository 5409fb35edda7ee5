"""A circular frustum of even density: mass, mass centre and inertia, whole or cut off."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import brentq

NODES, WEIGHTS = np.polynomial.legendre.leggauss(3)
"""Exact up to the fifth power; the fourth is the highest that is needed."""


@dataclass(frozen=True)
class Frustum:
    """A frustum with its axis along -y from the proximal end.

    Parameters
    ----------
    length
        [m].
    proximal, distal
        Radii of both ends [m].

    ValueError for a length or radius that is not positive.
    """

    length: float
    proximal: float
    distal: float

    def __post_init__(self) -> None:
        if not (np.isfinite([self.length, self.proximal, self.distal]).all() and min(self.length, self.distal) > 0.0):
            raise ValueError("a frustum needs a positive length and positive radii")
        if not self.proximal > 0.0:
            raise ValueError("a frustum needs a positive length and positive radii")

    @property
    def volume(self) -> float:
        """[m³]."""
        return float(np.pi * self._sum(self._radius**2))

    def cut(self, length: float) -> Frustum:
        """The proximal part of that length [m]; ValueError where it is not within the frustum."""
        if not 0.0 < length <= self.length:
            raise ValueError(f"a frustum of {self.length:g} m cannot be cut at {length:g} m")
        return Frustum(length, self.proximal, self.proximal + (self.distal - self.proximal) * length / self.length)

    def body(self, density: float) -> tuple[float, Float[np.ndarray, " 3"], Float[np.ndarray, "3 3"]]:
        """Mass [kg], mass centre [m] and inertia about it [kg m²] of a body of that density [kg/m³]."""
        x, r = self._place, self._radius
        mass = density * self.volume
        centre = density * float(np.pi * self._sum(x * r**2)) / mass
        long = density * float(np.pi * self._sum(0.5 * r**4))
        across = density * float(np.pi * self._sum(0.25 * r**4 + (x - centre) ** 2 * r**2))
        return mass, np.array([0.0, -centre, 0.0]), np.diag([across, long, across])

    @property
    def _place(self) -> Float[np.ndarray, " 3"]:
        return np.asarray(0.5 * self.length * (1.0 + NODES))

    @property
    def _radius(self) -> Float[np.ndarray, " 3"]:
        return self.proximal + (self.distal - self.proximal) * self._place / self.length

    def _sum(self, of: Float[np.ndarray, " 3"]) -> float:
        return float(0.5 * self.length * (WEIGHTS @ of))


def taper(centre: float) -> float:
    """Distal over proximal radius of a frustum whose mass centre is at that share of its length."""

    def off(ratio: float) -> float:
        return float((1.0 + 2.0 * ratio + 3.0 * ratio**2) / (4.0 * (1.0 + ratio + ratio**2)) - centre)

    return float(brentq(off, 1e-6, 1e3))
