"""Spheres of a body on a plane ground, in symbols: the laws of `contact.sphere_foot` unchanged."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.contact.sphere_foot import friction_coefficient, normal_force
from geocontact.dynamics.symbols import constant
from geocontact.dynamics.tree import Moving
from geocontact.geometry.shapes import HalfSpace

if TYPE_CHECKING:
    from casadi import SX

STILL = 1e-6
"""m/s; the direction of sliding is v / sqrt(v^2 + STILL^2), which has a derivative where nothing slides."""


@dataclass(frozen=True)
class SphereLaw:
    """Numbers of the laws, each a number or a symbol; see `contact.sphere_foot`.

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


def sphere_wrench(
    body: Moving, centre: Float[np.ndarray, " 3"], radius: float, law: SphereLaw, ground: HalfSpace
) -> tuple[SX, SX]:
    """Force of the ground on the body [N] and its moment about the ground's origin [N m].

    The force acts at the point of the ground below the sphere's centre; friction against the velocity along the ground
    of that material point of the body which is the sphere's lowest, as in `loads.sphere_loads`.
    """
    from casadi import cross, dot, mtimes, sqrt, sumsqr

    upwards = np.asarray(ground.normal, float)
    normal, point = constant(upwards / np.linalg.norm(upwards)), constant(np.asarray(ground.point, float))
    arm = mtimes(body.rotation, constant(centre))
    height = dot(body.place + arm - point, normal)
    closing = -dot(body.speed + cross(body.spin, arm), normal)
    pressing = normal_force(radius - height, closing, law.k, law.n, law.b, law.delta_full)
    velocity = body.speed + cross(body.spin, arm - radius * normal)
    sliding = velocity - dot(velocity, normal) * normal
    speed = sqrt(sumsqr(sliding) + STILL**2)
    friction = friction_coefficient(speed, law.v_th, law.mu_s, law.mu_k) * sliding / speed
    force = pressing * (normal - friction)
    return force, cross(body.place + arm - height * normal, force)
