"""Spheres of a foot on the ground: a Kelvin-Voigt element with a power spring and gated damping, friction by a table.

F = k d^n + b max(d', 0) s(d / d_full). This is the law of the Simscape Multibody Contact Forces Library (S. Miller);
the study of the variable-stiffness foot that uses it calls it a modified Kelvin-Voigt law (its eq. 1). Spring and
damper act in parallel. The smooth step s lets the damping set in with the depth, so that a sphere that touches down
fast starts at zero force.

It is not the law of Hunt & Crossley (1975), Coefficient of restitution interpreted as damping in vibroimpact, J Appl
Mech 42, 440-445: F = k d^n + c d^n d'. There the damping is the elastic force times (c/k) d', so it grows with the
depth without limit and acts while the bodies part as well. Here it is b d' at any depth beyond d_full and 0 while they
part.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""

STATIC, SLIDING = 1.0, 1.5
"""Speed over threshold speed at which static friction is reached, and from which kinetic friction acts."""


def normal_force(depth: X, rate: X, k: X, n: X, b: X, delta_full: X) -> X:
    """Force that presses sphere and ground apart, k d^n + b max(d', 0) s(d / delta_full); 0 unless d > 0 [N].

    s(u) = u^2 (3 - 2u), held at 1 from u = 1 on. Never negative, continuous in depth and rate. Once continuously
    differentiable at d = 0 when n > 1; all derivatives are finite everywhere, because depths below 1e-12 m count as
    1e-12 m in the power (the force there is k 1e-12^n, below 1e-12 N for n = 1.5 up to 1e6 N/m^1.5).

    Parameters
    ----------
    depth
        Radius - distance of the centre from the ground [m].
    rate
        Time derivative of the depth [m/s].
    k, n
        Stiffness [N/m^n] and exponent > 0.
    b
        Damping of loading at full depth [N s/m].
    delta_full
        Depth from which damping acts fully [m], > 0.
    """
    u = np.minimum(np.maximum(depth / delta_full, 0.0), 1.0)
    damping = b * np.maximum(rate, 0.0) * (u * u * (3.0 - 2.0 * u))
    force: X = (depth > 0.0) * (k * np.maximum(depth, 1e-12) ** n + damping)
    return force


def friction_coefficient(speed: X, v_th: X, mu_s: X, mu_k: X) -> X:
    """Tangential over normal force m(v), with the sign of `speed`: friction is -m(v) times the normal force.

    Linear between the nodes v/v_th = -3, -1.5, -1, 1, 1.5, 3 with the values -mu_k, -mu_k, -mu_s, mu_s, mu_k, mu_k and
    constant outside: viscous below the threshold speed, so a foot under load creeps instead of sticking.

    Parameters
    ----------
    speed
        Speed of the material point at the contact along the ground [m/s]; a magnitude or, in a plane, with its sign.
    v_th
        Threshold speed [m/s], > 0.
    mu_s, mu_k
        Static and kinetic coefficient [-].
    """
    u = speed / v_th
    static = np.minimum(np.maximum(u, -STATIC), STATIC)
    beyond = u - static
    sliding = np.minimum(np.maximum(beyond / (SLIDING - STATIC), -1.0), 1.0)
    coefficient: X = mu_s * static + (mu_k - mu_s) * sliding
    return coefficient
