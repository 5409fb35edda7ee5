"""Elastic foundation: a layer on a rigid base, or two of them face to face, as springs that do not know each other.

Each place carries the pressure of its own depth, so the contact need be neither small nor smooth (conforming implants);
what a patch does to the surface beside it is left out. Blankevoort et al., J Biomech 24 (1991) 1019; Bei & Fregly, Med
Eng Phys 26 (2004) 777; Johnson, Contact Mechanics (1985), sec. 4.3. M is the confined modulus, `layer_modulus`.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""

FULL = 0.95
"""Strain from which the logarithmic laws go on along their tangent instead of to infinity."""


def linear_pressure(depth: X, thickness: X, modulus: X) -> X:
    """M d / h, small strain; 0 unless d > 0 [Pa].

    Parameters
    ----------
    depth
        Overlap of the undeformed surfaces along the normal [m].
    thickness
        Of the layer there, h [m], > 0.
    modulus
        Confined modulus M [Pa].
    """
    pressure: X = modulus * np.maximum(depth, 0.0) / thickness
    return pressure


def logarithmic_pressure(depth: X, thickness: X, modulus: X) -> X:
    """-M ln(1 - d/h), finite strain; 0 unless d > 0 [Pa]. Its slope at 0 is that of `linear_pressure`.

    Beyond d = 0.95 h it goes on along its tangent, so that an absurd depth stays an absurd but finite pressure.
    """
    strain = np.maximum(depth, 0.0) / thickness
    held = np.minimum(strain, FULL)
    pressure: X = modulus * ((strain - held) / (1.0 - held) - np.log(1.0 - held))
    return pressure


def linear_stiffness(depth: X, thickness: X, modulus: X) -> X:
    """Slope of `linear_pressure` over depth, M / h; 0 unless d > 0 [Pa/m]."""
    slope: X = (depth > 0.0) * (modulus / thickness)
    return slope


def linear_energy(depth: X, thickness: X, modulus: X) -> X:
    """Energy per area of `linear_pressure`, M d^2 / 2h [J/m^2]."""
    sunk = np.maximum(depth, 0.0)
    energy: X = 0.5 * modulus * sunk * sunk / thickness
    return energy


def logarithmic_stiffness(depth: X, thickness: X, modulus: X) -> X:
    """Slope of `logarithmic_pressure` over depth, M / (h - d); 0 unless d > 0 [Pa/m]."""
    held = np.minimum(np.maximum(depth, 0.0) / thickness, FULL)
    slope: X = (depth > 0.0) * (modulus / (thickness * (1.0 - held)))
    return slope


def logarithmic_energy(depth: X, thickness: X, modulus: X) -> X:
    """Energy per area of `logarithmic_pressure`, M h ((1 - s) ln(1 - s) + s) with s = d/h [J/m^2]."""
    strain = np.maximum(depth, 0.0) / thickness
    held = np.minimum(strain, FULL)
    left, beyond = 1.0 - held, strain - held
    bend = np.log(left)
    energy: X = modulus * thickness * (left * bend + held + beyond * (0.5 * beyond / left - bend))
    return energy


def linear_pair_pressure(depth: X, thickness: X, modulus: X, other_thickness: X, other_modulus: X) -> X:
    """Two layers under one pressure share the depth: d / (h1/M1 + h2/M2); 0 unless d > 0 [Pa]."""
    pressure: X = np.maximum(depth, 0.0) / (thickness / modulus + other_thickness / other_modulus)
    return pressure


def logarithmic_pair_pressure(depth: X, thickness: X, modulus: X, other_thickness: X, other_modulus: X) -> X:
    """Pressure p at which two layers together give way by d; 0 unless d > 0 [Pa].

    d = h1 (1 - exp(-p/M1)) + h2 (1 - exp(-p/M2)), solved by Newton steps in a number that suffices (1e-12 of p for
    moduli up to 1000 times apart). From the linear answer they never overshoot, as d is concave in p. Beyond 0.95 of
    both thicknesses it goes on along its tangent.
    """
    sunk = np.maximum(depth, 0.0)
    held = np.minimum(sunk, FULL * (thickness + other_thickness))
    pressure: X = held / (thickness / modulus + other_thickness / other_modulus)
    slope = thickness / modulus + other_thickness / other_modulus
    for _ in range(24):
        left, right = np.exp(-pressure / modulus), np.exp(-pressure / other_modulus)
        slope = thickness / modulus * left + other_thickness / other_modulus * right
        pressure = pressure + (held - thickness * (1.0 - left) - other_thickness * (1.0 - right)) / slope
    beyond: X = pressure + (sunk - held) / slope
    return beyond
