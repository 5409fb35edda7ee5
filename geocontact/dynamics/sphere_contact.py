"""Spheres of a body on a plane ground, in symbols, with any law, smoothed ones among them.

The laws of `contact.sphere_foot` run unchanged, each number of them a number or a symbol, sphere by sphere or zone by
zone. They are written in the ground's frame, where the normal of level ground has one entry and half of each product
is left out: 24 spheres of one body take 2 200 operations on level ground, 3 100 on a slope.

`sphere_contact.sole_wrench` takes many spheres whose places are numbers. Here places are what a calibration seeks.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, cast, runtime_checkable

import numpy as np

from geocontact.contact.smooth_half_space import (
    CONSTANT,
    HERTZ_SMOOTHING,
    HUNT_CROSSLEY_SMOOTHING,
    half_space_coefficient,
    half_space_force,
)
from geocontact.contact.smooth_hunt_crossley import smoothed_sphere_force, stribeck_coefficient
from geocontact.contact.sphere_foot import friction_coefficient, normal_force
from geocontact.data.multibody.model import GROUND
from geocontact.dynamics.inverse_dynamics import Wrenches
from geocontact.dynamics.symbolic_ground import SymbolicGround
from geocontact.dynamics.symbols import column, constant
from geocontact.dynamics.tree import Moving
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.sphere_set import SoleLaw, SphereSet

if TYPE_CHECKING:
    from casadi import SX


def action_and_reaction(on: str, by: str, force: SX, place: SX) -> dict[str, tuple[SX, SX]]:
    """Loads on both bodies: force [N] at a place [m] on one, the opposite on the other, in the ground's frame.

    Either may be the ground, which is left out.
    """
    from casadi import cross

    moment = cross(place, force)
    both = {on: (force, moment), by: (-force, -moment)}
    return {body: wrench for body, wrench in both.items() if body != GROUND}


def together(*loads: Wrenches) -> dict[str, tuple[SX, SX]]:
    """Loads of several causes, added body by body."""
    found: dict[str, tuple[SX, SX]] = {}
    for each in loads:
        for body, (force, moment) in each.items():
            had = found.get(body)
            found[body] = (force, moment) if had is None else (had[0] + force, had[1] + moment)
    return found


STILL = 1e-6
"""m/s; the direction of sliding is v / sqrt(v^2 + STILL^2), which has a derivative where nothing slides.

Friction is mu(w) v / w with w = sqrt(v^2 + STILL^2) in place of mu(v). Where mu is proportional to the speed, as that
of `contact.sphere_foot` is below its threshold, the two are the same: nothing is smoothed. Above the threshold v_th
they differ by less than (STILL / v_th)^2 of the pressing force, 2e-11 for 0.25 m/s. A law that is not 0 at rest
(Coulomb's) is smoothed: to 71 % of its friction at v = STILL, to within 5e-7 of it from 1e-3 m/s on.
"""


@runtime_checkable
class ContactLaw(Protocol):
    """What a sphere presses and rubs with."""

    def pressing(self, depth: SX, closing: SX) -> SX:
        """Normal force [N] of depth [m] and its rate [m/s]; 0 unless the depth is positive."""

    def friction(self, speed: SX) -> SX:
        """Tangential over normal force of a speed >= 0 along the ground [m/s]."""


@dataclass(frozen=True)
class SphereLaw:
    """The law of `contact.sphere_foot`, each number a number or a symbol.

    Parameters
    ----------
    k, n, b, delta_full
        Stiffness [N/m^n], exponent, damping [N s/m], depth of full damping [m].
    v_th, mu_s, mu_k
        Threshold speed [m/s], static and kinetic coefficient.
    """

    k: SX | float
    n: SX | float
    b: SX | float
    delta_full: SX | float
    v_th: SX | float
    mu_s: SX | float
    mu_k: SX | float

    def pressing(self, depth: SX, closing: SX) -> SX:
        """k d^n + b max(d', 0) s(d / delta_full) [N]."""
        return cast("SX", normal_force(depth, closing, self.k, self.n, self.b, self.delta_full))

    def friction(self, speed: SX) -> SX:
        """By the table of `contact.sphere_foot`."""
        return cast("SX", friction_coefficient(speed, self.v_th, self.mu_s, self.mu_k))


def laws_by_zone(spheres: SphereSet, laws: Mapping[str, ContactLaw]) -> list[ContactLaw]:
    """The law of each sphere from the laws of the zones. ValueError for a zone without one, or one too many."""
    missing, strange = set(spheres.zones) - set(laws), set(laws) - set(spheres.zones)
    if missing or strange:
        raise ValueError(f"zones are {', '.join(spheres.zones)}; laws are given for {', '.join(laws)}")
    return [laws[zone] for zone in spheres.zone]


def laws_of(law: SoleLaw) -> list[SphereLaw]:
    """The law of each sphere as `loads.sphere_set` takes it."""
    return [
        SphereLaw(float(k), law.exponent, float(b), law.full_depth, law.threshold_speed, float(static), float(kinetic))
        for k, b, static, kinetic in zip(law.stiffness, law.damping, law.static, law.kinetic, strict=True)
    ]


def sole_wrench(
    body: Moving, spheres: SphereSet, laws: Sequence[ContactLaw], ground: HalfSpace | SymbolicGround
) -> tuple[SX, SX]:
    """Force of the ground on the body [N] and its moment about the origin of the ground's frame [N m].

    Each force acts at the point of the ground nearest to the sphere's centre; friction against the velocity along the
    ground of that material point of the body which is the sphere's lowest, as in `loads.sphere_set`.

    Parameters
    ----------
    spheres, laws
        Centres in the body's frame, and a law for each sphere.
    """
    from casadi import SX, cross, dot, mtimes, sqrt, sumsqr

    force, moment, turning, before = SX(3, 1), SX(3, 1), SX(3, 1), None
    near = ground.near if isinstance(ground, SymbolicGround) else _Level(ground).near
    for centre, radius, law in zip(spheres.centre, spheres.radius, laws, strict=True):
        arm = mtimes(body.rotation, constant(centre))
        place, carried = body.place + arm, body.speed + cross(body.spin, arm)
        distance, up = near(place)
        turning = turning if up is before else cross(body.spin, up)
        before, rising = up, dot(carried, up)
        pressing = law.pressing(radius - distance, -rising)
        sliding = carried - rising * up - radius * turning
        fast = sqrt(sumsqr(sliding) + STILL**2)
        acting = pressing * (up - law.friction(fast) / fast * sliding)
        force += acting
        moment += cross(place - distance * up, acting)  # of level ground the upward part falls out
    return force, moment


class _Level:
    """A plane whose numbers are known: what is 0 in its normal is left out."""

    def __init__(self, ground: HalfSpace) -> None:
        upwards = np.asarray(ground.normal, float)
        upwards = upwards / np.linalg.norm(upwards)
        self.up, self.level = constant(upwards), float(upwards @ np.asarray(ground.point, float))

    def near(self, place: SX) -> tuple[SX, SX]:
        """Height and normal."""
        from casadi import dot

        return dot(place, self.up) - self.level, self.up


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
        """Normal force as the paper's appendix has it, corrected [N]."""
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
        """Normal force as `SmoothSphereHalfSpaceForce` has it [N]."""
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
    sphere's lowest and the ground below it, as in OpenSim's `SmoothSphereHalfSpaceForce` (4.6). `loads.sphere_set`
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
