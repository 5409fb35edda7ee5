"""The spheres that stand for the sole of a foot, and the law they press with."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float


@dataclass(frozen=True)
class SphereSet:
    """Spheres fixed in a foot, grouped in zones (heel, midfoot, toes …).

    Parameters
    ----------
    centre
        Centres in the foot's frame [m].
    radius
        [m].
    zone
        Zone of each sphere.
    """

    centre: Float[np.ndarray, "n 3"]
    radius: Float[np.ndarray, " n"]
    zone: tuple[str, ...]

    def __post_init__(self) -> None:
        if len(self.zone) != len(self.radius) or not len(self.radius):
            raise ValueError(f"{len(self.radius)} spheres with {len(self.zone)} zones; every sphere has one")
        if not (np.isfinite(self.centre).all() and (self.radius > 0.0).all() and np.isfinite(self.radius).all()):
            raise ValueError("spheres need finite centres and positive radii")

    def __len__(self) -> int:
        return len(self.radius)

    @property
    def zones(self) -> dict[str, Bool[np.ndarray, " n"]]:
        """Which spheres belong to each zone, zones in the order in which they first occur."""
        names = np.array(self.zone)
        return {name: names == name for name in dict.fromkeys(self.zone)}


@dataclass(frozen=True)
class SoleLaw:
    """Numbers of the force law `geocontact.contact.sphere_foot`; stiffness, damping and friction sphere by sphere.

    Parameters
    ----------
    stiffness, exponent
        k [N/m^n] of each sphere, and n.
    damping, full_depth
        b [N s/m] of each sphere, and the depth [m] from which it acts fully.
    static, kinetic
        Coefficients of friction of each sphere [-].
    threshold_speed
        Speed [m/s] at which static friction is reached.
    """

    stiffness: Float[np.ndarray, " n"]
    damping: Float[np.ndarray, " n"]
    exponent: float
    full_depth: float
    static: Float[np.ndarray, " n"]
    kinetic: Float[np.ndarray, " n"]
    threshold_speed: float

    def __post_init__(self) -> None:
        positive = (self.exponent, self.full_depth, self.threshold_speed, *self.stiffness)
        not_negative = (*self.static, *self.kinetic, *self.damping)
        if not (np.isfinite([*positive, *not_negative]).all() and min(positive) > 0.0 and min(not_negative) >= 0.0):
            raise ValueError(
                "stiffness, exponent, depth and threshold speed must be positive, damping and friction not negative"
            )

    @property
    def needs_velocity(self) -> bool:
        """Whether any force depends on how the foot moves, not only on where it is."""
        return bool(self.damping.any() or self.static.any() or self.kinetic.any())
