"""A smoothed sphere on a half-space, for gradient-based solvers: Hunt & Crossley's normal force, Stribeck's friction.

Source: the sit-to-stand study of a leg exoskeleton, appendix, eqs 1-7. F = (4/3) k^1.5 sqrt(R) x^1.5 (1 + 1.5 c x'),
each factor gated by a hyperbolic tangent, so that the force has all derivatives. It hardly pulls: around the speed
-2/(3c) at which it turns, at most 0.1393 (3c/2)/b_v of the elastic force (0.6 % for c = 1.5 s/m and b_v = 50 s/m), the
least value of y/(1 + exp(-2y)).

Deviations from the print, each because the print cannot be meant:

- eq 3 asks for an effective stiffness k. With the plane-strain modulus K of sphere and ground it is K^(2/3) / 2, which
  makes the force (4/3) 2^(-1.5) K sqrt(R) x^1.5.
- eq 4 is not a number for x < 0 (x^1.5 stands before its gate), and max(x, 0)^1.5 has an infinite second derivative at
  0. The power takes the smooth positive part (x + sqrt(x^2 + e^2)) / 2 instead.
- eq 5 and eq 6 gate with the rate x'. Eq 6 prints x there; 2 / (3 c) is a velocity.
- eq 7, third case: 0 <= v < 1. A viscous part, named in the text and missing in the equation, is added.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""


def smoothed_sphere_force(depth: X, rate: X, modulus: X, radius: X, c: X, rounding: X, b_d: X, b_v: X, b_n: X) -> X:
    """Normal force of a sphere and a half-space [N], infinitely often differentiable everywhere.

    Out of contact it is small, not 0: from the rounding, and from the slope term of eq 6, b_n exp((x - 0.01 m) / 0.1 m)
    times both gates, whose purpose is a derivative there.

    Parameters
    ----------
    depth, rate
        Indentation x [m] and its derivative [m/s], positive while it grows.
    modulus
        Plane-strain modulus K of the pair [Pa].
    radius
        Of the sphere [m].
    c
        Dissipation [s/m], > 0.
    rounding
        e of the smooth positive part [m], > 0; at x = 0 the power is (e / 2)^1.5.
    b_d, b_v
        Steepness of the gates of the depth [1/m] and of the rate [s/m].
    b_n
        Size of the slope term [N].
    """
    positive = 0.5 * (depth + np.sqrt(depth * depth + rounding * rounding))
    hertz = (4.0 / 3.0) * 2.0**-1.5 * modulus * np.sqrt(radius) * positive * np.sqrt(positive)
    into = 0.5 + 0.5 * np.tanh(b_d * depth)
    together = 0.5 + 0.5 * np.tanh(b_v * (rate + 2.0 / (3.0 * c)))
    slope = b_n * np.exp((depth - 0.01) / 0.1)
    force: X = into * together * (hertz * (1.0 + 1.5 * c * rate) + slope)
    return force


def stribeck_coefficient(speed: X, v_t: X, mu_s: X, mu_d: X, mu_v: X) -> X:
    """Tangential over normal force with the sign of `speed`, eq 7: twice continuously differentiable.

    Rises to `mu_s` at v_t, falls to `mu_d` at 3 v_t, both by 10 s^3 - 15 s^4 + 6 s^5, and grows by `mu_v` v.

    Parameters
    ----------
    speed
        Of sliding [m/s].
    v_t
        Transition velocity [m/s], > 0.
    mu_s, mu_d
        Static and dynamic coefficient [-].
    mu_v
        Viscous coefficient [s/m].
    """
    v = speed / v_t
    rising = np.minimum(np.maximum(v, -1.0), 1.0)
    falling = np.minimum(np.maximum(0.5 * (v - rising), -1.0), 1.0)
    up = rising * rising * rising * (10.0 - 15.0 * np.maximum(rising, -rising) + 6.0 * rising * rising)
    down = falling * falling * falling * (10.0 - 15.0 * np.maximum(falling, -falling) + 6.0 * falling * falling)
    coefficient: X = mu_s * up - (mu_s - mu_d) * down + mu_v * speed
    return coefficient
