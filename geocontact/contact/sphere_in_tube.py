"""A sphere inside a tube of the same radius: the arm in the cuff of an exoskeleton.

The law of the Simscape Multibody Contact Forces Library (S. Miller) as Yao et al. (2024), Robotics 13:27, sec. 2.3, use
it: F = k pen + b max(pen', 0) s(pen / d_full) towards the axis, friction by a table of the sliding speed. With equal
radii the penetration is the distance |r| of the sphere's centre from the axis, whatever the radius is. The spring -k r
needs no direction there; damping vanishes with r; friction μ k |r| has a kink on the axis, which is rounded:
|r| becomes sqrt(r² + e²) - e in it, less by at most e, so that friction is less by at most μ k e (0.05 N for
k = 1000 N/m and e = 0.05 mm).

A strap that pulls the arm into the wall by a depth s all around, or a play -s between both, is a ring of springs
k (2/π) per radian around the tube, each pressed by |r| cos θ + s where that is positive, over the angles |θ| < t with
cos t = -s/|r| at most π:

    F = (2 k / π) (|r| (t + sin t cos t) + 2 s sin t)        pressing = k (|r| sin t + s t)

towards the axis: k |r| and k |r| where s = 0, twice that while the strap holds all around, nothing within the play.
The springs' sum is taken π/4 times, so that friction is the library's without a strap.

The sphere does not turn in the tube (the paper's Cartesian joint), so what slides is the sphere's centre against the
tube, and the moment of friction about the centre goes back through that joint: on both bodies the force acts at the
sphere's centre.

Components in, components out: the same source runs on arrays and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np

from geocontact.contact.sphere_foot import friction_coefficient, normal_force
from geocontact.geometry.sagittal import off_axis

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""
Vector = tuple[X, X, X]
WHOLE = 1.0 - 1e-12
"""Cosine at which a ring of springs counts as pressed nowhere or everywhere; at 1 its slope has no number."""
STILL = 1e-9
"""m/s below which sliding has no direction; friction is proportional to the speed there."""


@dataclass(frozen=True)
class TubeLaw:
    """Numbers of the law, each a number or a symbol.

    Parameters
    ----------
    k, b, delta_full
        Stiffness [N/m], damping [N s/m], depth from which damping acts fully [m].
    v_th, mu_s, mu_k
        Threshold speed of the friction table [m/s], static and kinetic coefficient.
    rounding
        e, over which friction's kink on the axis is rounded [m], > 0.
    strap
        s, depth by which a strap pulls the sphere into the wall all around [m]; negative: play.
    """

    k: Any
    b: Any
    delta_full: Any
    v_th: Any
    mu_s: Any
    mu_k: Any
    rounding: Any
    strap: Any = 0.0


@dataclass(frozen=True)
class TubeContact:
    """Forces of the tube on the sphere, in the tube's axes.

    Parameters
    ----------
    along
        Place of the centre along the axis [m].
    radial
        From the axis to the centre [m].
    pressing
        Normal force [N], >= 0.
    normal, friction
        Both parts of the force [N].
    spring, stored
        What the springs have of the normal part [N], and their energy [J].
    sliding
        Velocity of the centre along the wall [m/s].
    """

    along: Any
    radial: Vector[Any]
    pressing: Any
    normal: Vector[Any]
    friction: Vector[Any]
    sliding: Vector[Any]
    spring: Vector[Any]
    stored: Any


def tube_contact(offset: Vector[X], velocity: Vector[X], axis: Vector[X], law: TubeLaw) -> TubeContact:
    """Forces at an offset of the sphere's centre from the tube's [m], and its velocity in the tube [m/s]."""
    along, radial = off_axis(offset, axis)
    rounded = np.sqrt(_dot(radial, radial) + law.rounding * law.rounding)
    outwards = _times(radial, 1.0 / rounded)
    closing = _dot(outwards, velocity)
    ratio = law.strap / rounded
    t = np.arccos(np.maximum(np.minimum(-ratio, WHOLE), -WHOLE))
    sin, cos = np.sin(t), np.cos(t)
    depth = np.maximum(rounded - law.rounding + np.minimum(law.strap, 0.0), 0.0)
    damping = normal_force(depth, closing, 0.0, 1.0, law.b, law.delta_full)
    pressing = law.k * np.maximum((rounded - law.rounding) * sin + law.strap * t, 0.0) + damping
    share = np.maximum(t + sin * cos + 2.0 * ratio * sin, 0.0) / (0.5 * np.pi)
    spring = _times(radial, -law.k * share)
    normal = _plus(spring, _times(outwards, -damping))
    sliding = _plus(velocity, _times(outwards, -closing))
    speed = np.sqrt(_dot(sliding, sliding) + STILL * STILL)
    friction = _times(sliding, -friction_coefficient(speed, law.v_th, law.mu_s, law.mu_k) * pressing / speed)
    square = _dot(radial, radial)
    stored = law.k / np.pi * (square * (t + sin * cos) + 4.0 * rounded * law.strap * sin + 2.0 * law.strap**2 * t)
    return TubeContact(along, radial, pressing, normal, friction, sliding, spring, stored)


def _dot(a: Vector[X], b: Vector[X]) -> X:
    product: X = a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    return product


def _times(a: Vector[X], by: X) -> Vector[X]:
    return a[0] * by, a[1] * by, a[2] * by


def _plus(a: Vector[X], b: Vector[X]) -> Vector[X]:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]
