"""Moduli that force laws take, from Young's modulus and Poisson's ratio.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from typing import Any, TypeVar

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""


def plane_modulus(young: X, poisson: X) -> X:
    """E / (1 - nu^2) [Pa]: the contact modulus E* of an elastic half-space that touches a rigid body.

    Contact forces tell this one number, never E and nu apart: E = E* (1 - nu^2) once nu is stated.
    """
    modulus: X = young / (1.0 - poisson * poisson)
    return modulus


def layer_modulus(young: X, poisson: X) -> X:
    """(1 - nu) E / ((1 + nu)(1 - 2 nu)) [Pa]: pressure per strain of a thin layer that cannot spread sideways.

    Johnson, Contact Mechanics (1985), eq. 4.59. It grows without bound as nu approaches 1/2.
    """
    modulus: X = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson))
    return modulus
