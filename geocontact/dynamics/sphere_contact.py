"""Spheres of a body on a plane ground, in symbols, with any law.

The laws of `contact.sphere_foot` run unchanged, each number of them a number or a symbol, sphere by sphere or zone by
zone. They are written in the ground's frame, where the normal of level ground has one entry and half of each product
is left out: 24 spheres of one body take 2 200 operations on level ground, 3 100 on a slope.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, cast, runtime_checkable

import numpy as np

from geocontact.contact.sphere_foot import friction_coefficient, normal_force
from geocontact.dynamics.symbolic_ground import SymbolicGround
from geocontact.dynamics.symbols import constant
from geocontact.dynamics.tree import Moving
from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.sphere_set import SoleLaw, SphereSet

if TYPE_CHECKING:
    from casadi import SX

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
    """The law of each sphere as `loads.sphere_loads` takes it."""
    return [
        SphereLaw(float(k), law.exponent, float(b), law.full_depth, law.threshold_speed, float(static), float(kinetic))
        for k, b, static, kinetic in zip(law.stiffness, law.damping, law.static, law.kinetic, strict=True)
    ]


def sole_wrench(
    body: Moving, spheres: SphereSet, laws: Sequence[ContactLaw], ground: HalfSpace | SymbolicGround
) -> tuple[SX, SX]:
    """Force of the ground on the body [N] and its moment about the origin of the ground's frame [N m].

    Each force acts at the point of the ground nearest to the sphere's centre; friction against the velocity along the
    ground of that material point of the body which is the sphere's lowest, as in `loads.sphere_loads`.

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
