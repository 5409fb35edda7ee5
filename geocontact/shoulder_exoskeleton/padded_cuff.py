"""A padded cuff around an upper arm: an elastic foundation on its wall instead of one point, in symbols.

Pad and soft tissue are two layers under one pressure (`contact.elastic_foundation.linear_pair_pressure`); the arm is
a circular cylinder around the line from shoulder to cuff, wider than the empty cuff by the interference that a tight
strap makes. Depth at station x and angle φ of the wall is interference + (y cos φ + z sin φ), with y, z where the arm's
line passes that station: first order in offset over radius and in the tilt. Pressures act along the gradient of the
depth through the arm's line, so that the layers give back what they store. Friction is that of the table, point by
point, against the arm's material, which does not spin about its own line: two markers do not tell how it does.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geocontact.contact.elastic_foundation import linear_pair_pressure
from geocontact.contact.sphere_foot import friction_coefficient, normal_force
from geocontact.contact.sphere_in_tube import STILL

if TYPE_CHECKING:
    from casadi import SX

    from geocontact.dynamics.tree import Moving

STATIONS, AROUND = 3, 8
"""Places along the cuff (Gauss and Legendre's) and around it; see `quadrature`."""
NOWHERE = 1e-12
"""m or Pa; an arm that is off by less is off towards no side."""


@dataclass(frozen=True)
class CuffLaw:
    """Numbers of pad, tissue and friction, each a number or a symbol.

    Parameters
    ----------
    radius, length
        Of the cuff's wall [m].
    pad_thickness, pad_modulus, tissue_thickness, tissue_modulus
        Layers [m] and their confined moduli [Pa].
    interference
        By how much the arm is wider than the empty cuff [m], >= 0.
    damping
        While a place is pressed on [Pa s/m], from the depth `delta_full` [m] on.
    v_th, mu_s, mu_k
        Threshold speed of the friction table [m/s], static and kinetic coefficient.
    """

    radius: SX
    length: SX
    pad_thickness: SX
    pad_modulus: SX
    tissue_thickness: SX
    tissue_modulus: SX
    interference: SX
    damping: SX
    delta_full: SX
    v_th: SX
    mu_s: SX
    mu_k: SX


@dataclass(frozen=True)
class CuffLoad:
    """What the cuff does to the arm, in the ground's frame unless said otherwise.

    Parameters
    ----------
    force, moment
        [N], and about the ground's origin [N m].
    normal, friction
        Parts of the force [N].
    pressing
        Sum of the pressures times their areas [N].
    along
        Centre of the pressures along the cuff from its middle [m].
    peak
        Largest pressure anywhere on the wall [Pa].
    share
        Of the wall that is pressed on [-].
    stored
        In the layers [J].
    lost
        In friction and damping [W].
    """

    force: SX
    moment: SX
    normal: SX
    friction: SX
    pressing: SX
    along: SX
    peak: SX
    share: SX
    stored: SX
    lost: SX


@dataclass(frozen=True)
class ArmLine:
    """The arm's line: a point of it and its velocity [m, m/s], direction and its rate [1, 1/s], ground's frame."""

    place: SX
    speed: SX
    direction: SX
    turning: SX


def cuff_load(arm: ArmLine, cuff: Moving, axes: SX, middle: SX, law: CuffLaw) -> CuffLoad:
    """Load of the cuff on the arm.

    Parameters
    ----------
    cuff
        Body that carries it.
    axes, middle
        Distal, medial and raising axes of the cuff in columns, and its middle, in the ground's frame.
    """
    from casadi import SX, cross, dot, fmax, vertcat

    wall = _wall(arm, cuff, axes, middle, law)
    sums = {name: SX(3, 1) for name in ("normal", "friction", "moment")}
    pressing, first, share, stored, lost = (SX(0) for _ in range(5))
    peak = _largest(wall)
    for x, weight in zip(*quadrature(STATIONS), strict=True):
        station = 0.5 * law.length * x
        area = np.pi * law.radius / AROUND * law.length * weight
        for angle in 2.0 * np.pi * np.arange(AROUND) / AROUND:
            out = axes @ vertcat(0.0, np.cos(angle), np.sin(angle))
            at = _pressed(wall, station, np.cos(angle), np.sin(angle))
            place = middle + axes[:, 0] * station + law.radius * out
            velocity = _between(arm, wall.spin, cuff, place)
            sliding = velocity - dot(velocity, out) * out
            speed = np.sqrt(dot(sliding, sliding) + STILL * STILL)
            drag = friction_coefficient(speed, law.v_th, law.mu_s, law.mu_k) * at.pressure / speed
            normal, friction = -at.pressure * area * at.facing, -drag * area * sliding
            sums["normal"] += normal
            sums["friction"] += friction
            sums["moment"] += cross(at.core, normal) + cross(place, friction)
            pressing += at.pressure * area
            first += at.pressure * area * station
            peak = fmax(peak, at.pressure)
            share += (at.depth > 0.0) * weight / (2.0 * AROUND)
            stored += 0.5 * at.elastic * np.maximum(at.depth, 0.0) * area
            lost += ((at.pressure - at.elastic) * at.closing + drag * dot(sliding, sliding)) * area
    force = sums["normal"] + sums["friction"]
    centre = first / (pressing + 1e-9)
    return CuffLoad(
        force, sums["moment"], sums["normal"], sums["friction"], pressing, centre, peak, share, stored, lost
    )


@dataclass(frozen=True)
class _Wall:
    """What every place of the wall needs: the arm's line in the cuff's axes, from its middle, and how it turns."""

    arm: ArmLine
    cuff: Moving
    axes: SX
    middle: SX
    law: CuffLaw
    offset: SX
    along: SX
    spin: SX


@dataclass(frozen=True)
class _Place:
    """A place of the wall: the arm's line beside it, direction of its pressure, depth, its rate, pressures."""

    core: SX
    facing: SX
    depth: SX
    closing: SX
    elastic: SX
    pressure: SX


def _wall(arm: ArmLine, cuff: Moving, axes: SX, middle: SX, law: CuffLaw) -> _Wall:
    from casadi import cross

    offset, along = axes.T @ (arm.place - middle), axes.T @ arm.direction
    return _Wall(arm, cuff, axes, middle, law, offset, along, cross(arm.direction, arm.turning))


def _beside(wall: _Wall, station: SX) -> tuple[SX, SX]:
    """Medial and raising place of the arm's line where it passes a station [m]."""
    way = (station - wall.offset[0]) / wall.along[0]
    return wall.offset[1] + way * wall.along[1], wall.offset[2] + way * wall.along[2]


def _pressed(wall: _Wall, station: SX, cosine: SX, sine: SX) -> _Place:
    """The law at a station and an angle of the wall."""
    from casadi import SX, dot, vertcat

    law, along = wall.law, wall.along
    y, z = _beside(wall, station)
    core = wall.middle + wall.axes @ vertcat(station, y, z)
    slope = (along[1] * cosine + along[2] * sine) / along[0]
    facing = wall.axes @ vertcat(-slope, cosine, sine)
    closing = dot(_between(wall.arm, wall.spin, wall.cuff, core), facing)
    depth = law.interference + y * cosine + z * sine
    elastic = _layers(law, depth)
    damped = normal_force(depth, closing, SX(0.0), SX(1.0), law.damping, law.delta_full)
    return _Place(core, facing, depth, closing, elastic, elastic + damped)


def _layers(law: CuffLaw, depth: SX) -> SX:
    return linear_pair_pressure(depth, law.pad_thickness, law.pad_modulus, law.tissue_thickness, law.tissue_modulus)


def _largest(wall: _Wall) -> SX:
    """Largest pressure of the whole wall [Pa], which the places of the sums miss by a sixth.

    Depth and its rate are sinusoids around the wall whose vectors change linearly along it, so their largest sum is at
    an end: where the depth is largest, or where depth and damping add up to the most while both act fully.
    """
    from casadi import SX, fmax

    law, peak = wall.law, SX(0)
    stiff = _layers(law, SX(1.0))
    for end in (-0.5, 0.5):
        station = end * law.length
        y, z = _beside(wall, station)
        medial, raising = (_pressed(wall, station, *way).closing for way in ((SX(1), SX(0)), (SX(0), SX(1))))
        for a, b in ((y, z), (stiff * y + law.damping * medial, stiff * z + law.damping * raising)):
            size = np.sqrt(a * a + b * b + NOWHERE * NOWHERE)
            peak = fmax(peak, _pressed(wall, station, (a + NOWHERE) / size, b / size).pressure)
    return peak


def _between(arm: ArmLine, spin: SX, cuff: Moving, place: SX) -> SX:
    """Velocity of the arm's material against the cuff's at a place [m/s]."""
    from casadi import cross

    return arm.speed + cross(spin, place - arm.place) - cuff.speed - cross(cuff.spin, place - cuff.place)


def quadrature(count: int) -> tuple[Sequence[float], Sequence[float]]:
    """Gauss and Legendre's places on -1 … 1 and their weights, which sum to 2."""
    places, weights = np.polynomial.legendre.leggauss(count)
    return places.tolist(), weights.tolist()
