"""Hertz by other ways: what a half-space gives way under a pressure, the ellipse by elliptic integrals and a root."""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk


def semi_ellipse(distance: float, half: float, peak: float) -> float:
    """Hertz's pressure at a distance from the middle of a patch, peak sqrt(1 - r^2/a^2); within the patch."""
    return float(peak * np.sqrt(1.0 - (distance / half) ** 2))


def displacement(x: float, y: float, a: float, b: float, peak: float, modulus: float) -> float:
    """What a half-space gives way at (x, y) in the ellipse a, b under peak sqrt(1 - x^2/a^2 - y^2/b^2).

    Boussinesq: integral of p / (pi E* r). In polar coordinates about the point the pressure along a chord is the root
    of a quadratic, whose integral is known; what is left is periodic in the angle, and the mean converges at once.
    """
    t = np.pi * (np.arange(4000) + 0.5) / 4000
    square = np.cos(t) ** 2 / a**2 + np.sin(t) ** 2 / b**2
    mixed = x * np.cos(t) / a**2 + y * np.sin(t) / b**2
    chord = 0.5 * np.pi * (1.0 - x**2 / a**2 - y**2 / b**2 + mixed**2 / square) / np.sqrt(square)
    return float(peak * chord.mean() / modulus)


def by_root(ratio: float) -> tuple[float, float, float]:
    """Axis ratio, K and S from SciPy's elliptic integrals and a bracketed root of Johnson's eq. 4.26."""

    def parameter(q: float) -> float:
        return 1.0 - q * q

    def off(q: float) -> float:
        m = parameter(q)
        return float((ellipe(m) / q**2 - ellipk(m)) / (ellipk(m) - ellipe(m)) - ratio)

    q = brentq(off, 1e-4, 0.999, xtol=1e-15, rtol=1e-14)
    return q, float(ellipk(parameter(q))), float((1.0 - ellipe(parameter(q)) / ellipk(parameter(q))) / parameter(q))
