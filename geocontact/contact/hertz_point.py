"""Two smooth bodies that touch at a point, both round alike in all directions: a circular patch.

Hertz (1882) in the form of Johnson, Contact Mechanics (1985), sec. 4.2: 1/R = 1/R1 + 1/R2, a flat body has none;
E* from `elasticity`. Patches are small against R, bodies thick against the patch, friction does not matter.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""


def point_force(depth: X, radius: X, modulus: X) -> X:
    """Force 4/3 E* sqrt(R) d^1.5; 0 unless d > 0 [N].

    All derivatives are finite everywhere, because depths below 1e-12 m count as 1e-12 m in the power.

    Parameters
    ----------
    depth
        Approach of points far from the patch [m].
    radius
        Relative radius R [m], > 0.
    modulus
        Contact modulus E* [Pa].
    """
    sunk = np.maximum(depth, 1e-12)
    force: X = (depth > 0.0) * (4.0 / 3.0 * modulus * np.sqrt(radius * sunk) * sunk)
    return force


def point_radius(force: X, radius: X, modulus: X) -> X:
    """Radius of the patch, a = (3 F R / (4 E*))^(1/3) [m]; forces that pull count as none. Its depth is a^2 / R."""
    a: X = (0.75 * np.maximum(force, 0.0) * radius / modulus) ** (1.0 / 3.0)
    return a


def point_peak_pressure(force: X, radius: X, modulus: X) -> X:
    """Pressure in the middle, p0 = (6 F E*^2 / (pi^3 R^2))^(1/3) [Pa], 3/2 of the mean."""
    p0: X = (6.0 * np.maximum(force, 0.0) * modulus * modulus / (np.pi**3 * radius * radius)) ** (1.0 / 3.0)
    return p0
