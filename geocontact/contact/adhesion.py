"""Two smooth bodies that touch at a point and stick: DMT and JKR, beside Hertz's law of `hertz_point`.

w is the work of adhesion [J/m^2]: surface energies of both bodies less that of the interface. Derjaguin, Muller and
Toporov, J Colloid Interface Sci 53 (1975) 314, keep Hertz's shape and add attraction around the patch (small stiff
bodies); Johnson, Kendall and Roberts, Proc R Soc A 324 (1971) 301, have it within the patch alone (large soft ones).
Tabor's number says which: J Colloid Interface Sci 58 (1977) 2, below about 0.1 the first, above about 5 the second;
between them neither (Maugis, J Colloid Interface Sci 150 (1992) 243). Without w both are Hertz's law.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from typing import Any, TypeVar

import numpy as np

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""


def dmt_force(patch: X, radius: X, modulus: X, work: X) -> X:
    """4/3 E* a^3 / R - 2 pi w R; 0 unless a > 0 [N].

    Parameters
    ----------
    patch
        Radius of the patch a [m].
    radius
        Relative radius R [m], > 0.
    modulus
        Contact modulus E* [Pa].
    work
        Work of adhesion w [J/m^2].
    """
    a = np.maximum(patch, 0.0)
    force: X = (patch > 0.0) * (4.0 / 3.0 * modulus * a * a * a / radius - 2.0 * np.pi * work * radius)
    return force


def jkr_force(patch: X, radius: X, modulus: X, work: X) -> X:
    """4/3 E* a^3 / R - sqrt(8 pi w E* a^3); 0 unless a > 0 [N]."""
    a = np.maximum(patch, 1e-12)
    cubed = a * a * a
    pull = np.sqrt(8.0 * np.pi * work * modulus * cubed)
    force: X = (patch > 0.0) * (4.0 / 3.0 * modulus * cubed / radius - pull)
    return force


def dmt_patch(force: X, radius: X, modulus: X, work: X) -> X:
    """Radius of the patch under a force, (3 R (F + 2 pi w R) / (4 E*))^(1/3) [m]; 0 at the pull-off force and below."""
    pressed = np.maximum(force + 2.0 * np.pi * work * radius, 0.0)
    a: X = (0.75 * radius * pressed / modulus) ** (1.0 / 3.0)
    return a


def jkr_patch(force: X, radius: X, modulus: X, work: X) -> X:
    """Radius of the patch under a force, of the two the stable one [m]; 0 below the pull-off force.

    a^3 = 3 R / (4 E*) (F + 3 pi w R + sqrt(6 pi w R F + (3 pi w R)^2)).
    """
    three = 3.0 * np.pi * work * radius
    holds = force >= -0.5 * three
    root = np.sqrt(np.maximum(2.0 * three * force + three * three, 0.0))
    a: X = holds * (0.75 * radius * np.maximum(force + three + root, 0.0) / modulus) ** (1.0 / 3.0)
    return a


def jkr_depth(patch: X, radius: X, modulus: X, work: X) -> X:
    """Approach of points far from the patch, a^2 / R - sqrt(2 pi w a / E*) [m]; that of DMT is Hertz's, a^2 / R."""
    a = np.maximum(patch, 0.0)
    depth: X = a * a / radius - np.sqrt(2.0 * np.pi * work * a / modulus)
    return depth


def dmt_pull_off(radius: X, work: X) -> X:
    """Force at which the bodies come apart, -2 pi w R [N]."""
    force: X = work * radius * (-2.0 * np.pi)
    return force


def jkr_pull_off(radius: X, work: X) -> X:
    """Force at which the bodies come apart, -3/2 pi w R [N]."""
    force: X = work * radius * (-1.5 * np.pi)
    return force


def tabor_number(radius: X, modulus: X, work: X, spacing: X) -> X:
    """(R w^2 / (E*^2 z^3))^(1/3) [-] with z the spacing of atoms at the surface [m], 0.2 to 0.4 nm."""
    number: X = (radius * work * work / (modulus * modulus * spacing * spacing * spacing)) ** (1.0 / 3.0)
    return number
