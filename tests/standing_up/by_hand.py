"""Two planar chains, their contacts and straps in complex numbers: x forwards is real, y up is imaginary.

Nothing of the package but the numbers of persons and exoskeleton that its documentation states.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

HEIGHT = 1.75
SHANK, THIGH, HIGHER = 0.2529 * HEIGHT, 0.2425 * HEIGHT, 0.01
"""Lengths of the person's segments, and how far the exoskeleton's knee is above the person's [m]."""
FLAT = 1e-5
"""OpenSim's constant_contact_force [m^2, m^2/s^2]."""


class Foot(NamedTuple):
    """Modulus [Pa], places of heel and toe, lowest point and radius [m], dissipation [s/m], factor of the friction."""

    stiffness: float
    heel: float
    toe: float
    bottom: float
    radius: float
    dissipation: float
    friction: float


class Springs(NamedTuple):
    """Of one strap: across, along [N/m] and in turning [N m/rad], and its distance from the person's hinge [m]."""

    normal: float
    tangential: float
    turning: float
    place: float


class Worn(NamedTuple):
    """Of one strap: force across and along the person's segment [N], energy of its springs, by what a mat sees [J]."""

    normal: float
    shear: float
    unseen: float
    seen: float


def sphere(q: np.ndarray, u: np.ndarray, ahead: float, foot: Foot) -> tuple[float, float, float]:
    """Force forwards and up [N] and moment about the origin [N m] of one of OpenSim's spheres on y = 0.

    Halfway between the lowest point of the sphere and the ground (SmoothSphereHalfSpaceForce of OpenSim 4.6).
    """
    ankle, turn = complex(q[0], q[1]), np.exp(1j * q[2])
    centre = ankle + turn * complex(ahead, foot.radius - foot.bottom)
    depth = foot.radius - centre.imag
    point = complex(centre.real, -0.5 * depth)
    velocity = complex(u[0], u[1]) + 1j * u[2] * (point - ankle)
    rate, c = -velocity.imag, foot.dissipation
    k = 0.5 * foot.stiffness ** (2.0 / 3.0)
    hertz = 4.0 / 3.0 * k * np.sqrt(foot.radius * k) * (depth**2 + FLAT) ** 0.75
    up = hertz * (0.5 + 0.5 * np.tanh(300.0 * depth)) * (1.0 + 1.5 * c * rate)
    up *= 0.5 + 0.5 * np.tanh(50.0 * (rate + 2.0 / (3.0 * c)))
    static, dynamic, viscous, transition = 0.9 * foot.friction, 0.7 * foot.friction, 0.4, 0.2
    speed = np.sqrt(velocity.real**2 + FLAT)
    part = speed / transition
    mu = min(part, 1.0) * (dynamic + 2.0 * (static - dynamic) / (1.0 + part**2)) + viscous * speed
    along = -mu * up * velocity.real / speed
    return along, up, point.real * up - point.imag * along


def ground(q: np.ndarray, u: np.ndarray, foot: Foot) -> tuple[np.ndarray, float]:
    """Force of heel and toe [N] and their centre of pressure on the ground [m]."""
    along, up, moment = np.sum([sphere(q, u, ahead, foot) for ahead in (foot.heel, foot.toe)], axis=0)
    return np.array([along, up]), moment / up


def displaced(q: np.ndarray, place: float, site: str) -> np.ndarray:
    """Of a strap across and along the person's segment [m], and how far the exoskeleton's is turned against it."""
    person, device = (q[2] + np.cumsum(turns) for turns in (q[3:6], q[6:9]))
    hinges = ("shank", "thigh", "pelvis").index(site)

    def at(turns: np.ndarray, lengths: tuple[float, float], above: float) -> complex:
        below = sum(1j * length * np.exp(1j * turn) for length, turn in zip(lengths[:hinges], turns, strict=False))
        return complex(below + 1j * above * np.exp(1j * turns[hinges]))

    own = at(person, (SHANK, THIGH), place)
    other = at(device, (SHANK + HIGHER, THIGH - HIGHER), place - (HIGHER if site == "thigh" else 0.0))
    off = np.exp(-1j * person[hinges]) * (other - own)
    return np.array([off.real, off.imag, device[hinges] - person[hinges]])


def strap(q: np.ndarray, u: np.ndarray, springs: Springs, site: str) -> Worn:
    """With dashpots of 10 N s/m."""
    h = 1e-6
    off = displaced(q, springs.place, site)
    rate = (displaced(q + h * u, springs.place, site) - displaced(q - h * u, springs.place, site)) / (2.0 * h)
    normal, shear = springs.normal * off[0] + 10.0 * rate[0], springs.tangential * off[1] + 10.0 * rate[1]
    unseen = 0.5 * (springs.tangential * off[1] ** 2 + springs.turning * off[2] ** 2)
    return Worn(normal, shear, unseen, 0.5 * springs.normal * off[0] ** 2)
