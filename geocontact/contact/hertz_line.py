"""Two cylinders with parallel axes: a strip; all per length of the strip.

Johnson, Contact Mechanics (1985), sec. 4.2(c): 1/R = 1/R1 + 1/R2, E* from `elasticity`, load P per length [N/m]. There
is no law of load over approach: in plane strain the approach of distant points grows with the logarithm of their
distance, so it depends on the bodies' size and support, not on the contact alone.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""


def line_load(half_width: X, radius: X, modulus: X) -> X:
    """Load per length pi E* b^2 / (4 R) that makes a strip 2 b wide [N/m]; 0 unless b > 0."""
    b = np.maximum(half_width, 0.0)
    load: X = 0.25 * np.pi * modulus * b * b / radius
    return load


def line_half_width(load: X, radius: X, modulus: X) -> X:
    """Half the width of the strip, b = sqrt(4 P R / (pi E*)) [m]; loads that pull count as none."""
    b: X = np.sqrt(4.0 * np.maximum(load, 0.0) * radius / (np.pi * modulus))
    return b


def line_peak_pressure(load: X, radius: X, modulus: X) -> X:
    """Pressure in the middle, p0 = sqrt(P E* / (pi R)) [Pa]: 4/pi of the mean, falling off as sqrt(1 - x^2/b^2)."""
    p0: X = np.sqrt(np.maximum(load, 0.0) * modulus / (np.pi * radius))
    return p0
