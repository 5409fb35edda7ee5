"""Two smooth bodies that touch at a point, curved differently in different directions: an elliptical patch.

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
