"""A rigid sphere in an elastic foundation on the half-space z <= 0, in closed form.

The depth of a place of the plane at q from the axis is its own to the sphere, R - s with s = sqrt(q^2 + c^2) and
c = R - d, so q dq = s ds and the force is the integral of 2 pi s p(R - s) over s = c … R.
"""

from __future__ import annotations

import numpy as np


def linear_force(radius: float, depth: float, thickness: float, modulus: float) -> float:
    """p = M x / h: 2 pi M/h (R (R^2 - c^2)/2 - (R^3 - c^3)/3)."""
    c = radius - depth
    whole = radius * (radius**2 - c**2) / 2.0 - (radius**3 - c**3) / 3.0
    return 2.0 * np.pi * modulus / thickness * whole


def logarithmic_force(radius: float, depth: float, thickness: float, modulus: float) -> float:
    """p = -M ln(1 - x/h): with u = 1 - (R - s)/h, -2 pi M h times the integral of (R - h + h u) ln u du, u0 = 1 - d/h.

    Antiderivatives: u ln u - u and u^2 (2 ln u - 1)/4.
    """
    u = 1.0 - depth / thickness
    plain = -1.0 - (u * np.log(u) - u)
    weighted = -0.25 - u**2 * (2.0 * np.log(u) - 1.0) / 4.0
    return -2.0 * np.pi * modulus * thickness * ((radius - thickness) * plain + thickness * weighted)
