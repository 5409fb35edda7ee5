"""Support of a pneumatic cylinder: force from bore and pressure, lever from the triangle that the joint makes with it.

The joint is one corner; the rod is hinged a from it on the arm, the cylinder b from it on the frame; the angle between
both is φ = φ0 + elevation. The cylinder is c = sqrt(a² + b² - 2ab cos φ) long, its lever dc/dφ = a b sin φ / c is
at most min(a, b), where it is across the shorter side.

Scalar in, scalar out: numbers, arrays and CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from math import pi
from typing import Any, TypeVar

import numpy as np

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""


def piston_area(bore: X) -> X:
    """Of the full bore [m²]: the cylinder pushes."""
    area: X = bore * bore * (0.25 * pi)
    return area


def lever(elevation: X, a: X, b: X, phase: X) -> X:
    """Torque on the arm per force of the cylinder [m]; positive where pushing raises the arm."""
    angle = phase + elevation
    length: X = a * b * np.sin(angle) / cylinder_length(elevation, a, b, phase)
    return length


def cylinder_length(elevation: X, a: X, b: X, phase: X) -> X:
    """Between its hinges [m]; the stroke is its change."""
    length: X = np.sqrt(a * a + b * b - 2.0 * a * b * np.cos(phase + elevation))
    return length
