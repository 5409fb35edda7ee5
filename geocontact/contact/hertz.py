"""Hertz's smooth bodies: contact in a point, alike in all directions or elliptic, and along a line.

Hertz (1882) in the form of Johnson, Contact Mechanics (1985), sec. 4.2: 1/R = 1/R1 + 1/R2, a flat body has none;
E* from `elasticity`. Patches are small against R, bodies thick against the patch, friction does not matter.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).

Johnson, Contact Mechanics (1985), sec. 4.2(c): 1/R = 1/R1 + 1/R2, E* from `elasticity`, load P per length [N/m]. There
is no law of load over approach: in plane strain the approach of distant points grows with the logarithm of their
distance, so it depends on the bodies' size and support, not on the contact alone.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).

Johnson, Contact Mechanics (1985), sec. 4.2(b). Undeformed the gap is A x^2 + B y^2, A <= B. With semi-axes a >= b,
axis ratio q = b/a and the complete elliptic integrals K, E of modulus e^2 = 1 - q^2, his eq. 4.26 reads

    B/A = (E/q^2 - K) / (K - E) = (1 - S) / (q^2 S),   a^2 = S d / A,   d = p0 b K / E*,   S = (1 - E/K) / e^2

S lies between 1/2 (circle) and 1 (strip). K and S come from the arithmetic-geometric mean (Abramowitz & Stegun 17.6),
whose terms here lose no digits near the circle, where E/q^2 - K and K - E both vanish.

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


def ellipse_shape(ratio: X) -> tuple[X, X, X]:
    """Axis ratio q = b/a, K and S of the patch for B/A = `ratio` >= 1; right to 1e-13 up to B/A = 1e8.

    q^2 = (1 - S(q)) / (S(q) B/A) is iterated; each step leaves at most a quarter of the logarithmic error.
    """
    q = ratio ** (-2.0 / 3.0)
    k, s = q, q
    for _ in range(28):
        mean, root = 1.0 + 0.0 * q, q
        term = (1.0 - q) / (4.0 * (1.0 + q))  # c_n^2 / e^2, c_n as in Abramowitz & Stegun
        squared = 0.25 * (1.0 - q) * (1.0 - q)  # c_n^2
        s = 0.5 + term
        weight = 1.0
        for _ in range(7):
            mean, root = 0.5 * (mean + root), np.sqrt(mean * root)
            term = term * squared / (16.0 * (0.5 * (mean + root)) * (0.5 * (mean + root)))
            squared = 0.25 * (mean - root) * (mean - root)
            weight = 2.0 * weight
            s = s + weight * term
        k = 0.5 * np.pi / mean
        q = np.sqrt((1.0 - s) / (s * ratio))
    return q, k, s


def ellipse_force(depth: X, flatter: X, modulus: X, k: X, s: X) -> X:
    """Force (2 pi/3) (E*/K) sqrt(S/A) d^1.5; 0 unless d > 0 [N].

    Parameters
    ----------
    depth
        Approach of points far from the patch [m].
    flatter
        A, the smaller of the relative curvatures [1/m], > 0.
    modulus
        Contact modulus E* [Pa].
    k, s
        K and S from `ellipse_shape`.
    """
    sunk = np.maximum(depth, 1e-12)
    force: X = (depth > 0.0) * (2.0 / 3.0 * np.pi * modulus / k * np.sqrt(s * sunk / flatter) * sunk)
    return force


def ellipse_half_axis(depth: X, flatter: X, s: X) -> X:
    """Longer half axis of the patch, a = sqrt(S d / A) [m]; the shorter one is q a."""
    a: X = np.sqrt(s * np.maximum(depth, 0.0) / flatter)
    return a


def ellipse_peak_pressure(depth: X, half_axis: X, q: X, k: X, modulus: X) -> X:
    """Pressure in the middle, p0 = E* d / (b K) [Pa], 3/2 of the mean; b = q a."""
    p0: X = modulus * depth / (q * half_axis * k)
    return p0
