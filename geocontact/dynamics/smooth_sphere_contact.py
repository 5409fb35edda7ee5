"""The smoothed spheres of `contact` on a plane ground, in symbols; centre and radius may be symbols too.

`sphere_contact.sole_wrench` takes many spheres whose places are numbers. Here places are what a calibration seeks.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from geocontact.contact.smooth_half_space import (
    CONSTANT,
    HERTZ_SMOOTHING,
    HUNT_CROSSLEY_SMOOTHING,
    half_space_coefficient,
    half_space_force,
)
from geocontact.contact.smooth_hunt_crossley import smoothed_sphere_force, stribeck_coefficient
from geocontact.dynamics.sphere_contact import STILL
from geocontact.dynamics.symbols import column, constant
from geocontact.dynamics.tree import Moving
from geocontact.geometry.shapes import HalfSpace

if TYPE_CHECKING:
    from casadi import SX


@dataclass(frozen=True)
class StribeckFriction:
    """Transition velocity [m/s], static, dynamic and viscous [s/m] coefficient."""

    v_t: SX | float
    mu_s: SX | float
    mu_d: SX | float
    mu_v: SX | float

    @property
    def numbers(self) -> tuple[SX | float, SX | float, SX | float, SX | float]:
        """In the order that the laws take."""
        return self.v_t, self.mu_s, self.mu_d, self.mu_v


@dataclass(frozen=True)
class SmoothedSphereLaw:
    """The law of `contact.smooth_hunt_crossley`.

    Parameters
    ----------
    modulus, c, radius
        Plane-strain modulus [Pa], dissipation [s/m] and radius [m], numbers or symbols.
    stribeck
        Stribeck's.
    rounding, b_d, b_v, b_n
        See the law.
    """

    modulus: SX | float
    c: SX | float
    radius: SX | float
    stribeck: StribeckFriction
    rounding: float = 1e-3
    b_d: float = HERTZ_SMOOTHING
    b_v: float = HUNT_CROSSLEY_SMOOTHING
    b_n: float = 0.5
    still = STILL

    def pressing(self, depth: SX, closing: SX) -> SX:
        """As the paper's appendix has it, corrected [N]."""
        force = smoothed_sphere_force(
            depth, closing, self.modulus, self.radius, self.c, self.rounding, self.b_d, self.b_v, self.b_n
        )
        return cast("SX", force)

    def friction(self, speed: SX) -> SX:
        """Stribeck's curve."""
        return cast("SX", stribeck_coefficient(speed, *self.stribeck.numbers))


@dataclass(frozen=True)
class OpenSimSphereLaw:
    """The law of `contact.smooth_half_space` with OpenSim's constants; parameters as of `SmoothedSphereLaw`.

    Parameters
    ----------
    constant
        `constant_contact_force`, as an area and as the square of a speed.
    """

    modulus: SX | float
    c: SX | float
    radius: SX | float
    stribeck: StribeckFriction
    b_d: float = HERTZ_SMOOTHING
    b_v: float = HUNT_CROSSLEY_SMOOTHING
    constant: float = CONSTANT

    @property
    def still(self) -> float:
        """Speed that is added to that of sliding, as squares [m/s]."""
        return float(self.constant**0.5)

    def pressing(self, depth: SX, closing: SX) -> SX:
        """As `SmoothSphereHalfSpaceForce` has it [N]."""
        force = half_space_force(depth, closing, self.modulus, self.radius, self.c, self.b_d, self.b_v, self.constant)
        return cast("SX", force)

    def friction(self, speed: SX) -> SX:
        """OpenSim's curve."""
        return cast("SX", half_space_coefficient(speed, *self.stribeck.numbers))


def smooth_sphere_wrench(
    body: Moving, centre: SX, law: SmoothedSphereLaw | OpenSimSphereLaw, ground: HalfSpace
) -> tuple[SX, SX]:
    """Force of the ground on the body [N] and its moment about the ground's origin [N m].

    The force acts, and friction is against the velocity along the ground of the body, at the point halfway between the
    sphere's lowest and the ground below it, as in OpenSim's `SmoothSphereHalfSpaceForce` (4.6). `loads.sphere_loads`
    has the lowest point slide and the force on the ground: at a depth of 6 mm that is 3 mm of lever to friction.
    """
    from casadi import cross, dot, mtimes, sqrt, sumsqr

    upwards = np.asarray(ground.normal, float)
    normal, point = constant(upwards / np.linalg.norm(upwards)), constant(np.asarray(ground.point, float))
    arm = mtimes(body.rotation, centre)
    depth = law.radius - dot(body.place + arm - point, normal)
    lever = arm - (law.radius - 0.5 * depth) * normal
    velocity = body.speed + cross(body.spin, lever)
    rising = dot(velocity, normal)
    pressing = law.pressing(depth, -rising)
    sliding = velocity - rising * normal
    speed = sqrt(sumsqr(sliding) + law.still**2)
    friction = law.friction(speed) * sliding / speed
    force = column(pressing * (normal - friction), 3)
    return force, cross(body.place + lever, force)
