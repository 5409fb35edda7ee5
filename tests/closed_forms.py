"""Areas within a threshold of another body, in closed form, for pairs of simple smooth bodies.

Lengths in one unit, areas in its square. `gap` is the smallest signed distance of the two surfaces, negative when the
bodies overlap, except where a docstring says otherwise; a point counts when its signed distance to the *other* body is
at most `threshold`, so that overlapping parts count. Bodies are solid and large enough that nothing comes through on
the far side; where that limits a formula, its docstring says so. Angles in rad.

`quad` stands for Gauss-Legendre quadrature with 200 nodes on an integrand made smooth by a sine substitution; its error
is below 1e-12 of the result.
"""

from __future__ import annotations

from collections.abc import Callable
from math import acos, cos, pi, sin, sqrt

import numpy as np

NODES, WEIGHTS = np.polynomial.legendre.leggauss(200)


def quad(f: Callable[[np.ndarray], np.ndarray], a: float, b: float) -> float:
    """Integral of f from a to b for an integrand that may behave like a square root near b.

    With x = a + (b - a) sin t, t in 0..pi/2, a square root at b becomes the smooth cos t.
    """
    t = (NODES + 1) * pi / 4
    return float(np.sum(WEIGHTS * f(a + (b - a) * np.sin(t)) * np.cos(t)) * (b - a) * pi / 4)


def clipped_acos(c: float) -> float:
    """acos, 0 above 1 and pi below -1: an opening angle that has not begun or is complete."""
    return acos(min(1.0, max(-1.0, c)))


# --- sphere and plane -----------------------------------------------------------------------------------------------


def sphere_plane_on_sphere(radius: float, gap: float, threshold: float) -> float:
    """Area of the sphere within `threshold` of a half-space: a cap, 2 pi R h.

    The signed distance of a point is its height; heights run from gap to gap + 2R, so the cap is h = T - gap high
    (Archimedes: a cap's area is that of the cylinder band of the same height).
    """
    return 2 * pi * radius * min(max(threshold - gap, 0.0), 2 * radius)


def sphere_plane_on_plane(radius: float, gap: float, threshold: float) -> float:
    """Area of the plane within `threshold` of the sphere: a disc, pi ((R + T)^2 - (R + gap)^2).

    The centre is R + gap above the plane; a point at lateral distance q is sqrt(q^2 + (R + gap)^2) - R away.
    """
    return pi * max((radius + threshold) ** 2 - (radius + gap) ** 2, 0.0) if threshold > gap else 0.0


# --- cylinder and plane ---------------------------------------------------------------------------------------------


def cylinder_plane_on_cylinder_per_length(radius: float, gap: float, threshold: float) -> float:
    """Area per length of a cylinder that lies along a half-space: an arc, 2 R acos(1 - (T - gap)/R).

    Height of the point at angle phi from the lowest generator: gap + R (1 - cos phi).
    """
    return 2 * radius * clipped_acos(1 - (threshold - gap) / radius)


def cylinder_plane_on_plane_per_length(radius: float, gap: float, threshold: float) -> float:
    """Area per length of the plane under the cylinder: a strip, 2 sqrt((R + T)^2 - (R + gap)^2)."""
    return 2 * sqrt(max((radius + threshold) ** 2 - (radius + gap) ** 2, 0.0)) if threshold > gap else 0.0


def cylinder_plane_on_cylinder(radius: float, length: float, gap: float, threshold: float) -> float:
    """Area of a flat-ended cylinder of finite length, ends included: strip of the mantle and two circular segments.

    Segment with half angle phi: R^2 (phi - sin phi cos phi).
    """
    phi = clipped_acos(1 - (threshold - gap) / radius)
    return 2 * radius * phi * length + 2 * radius**2 * (phi - sin(phi) * cos(phi))


def cylinder_plane_on_plane(radius: float, length: float, gap: float, threshold: float) -> float:
    """Area of the plane under a flat-ended cylinder of finite length: strip and a rounded piece beyond each end.

    At x from the axis the plane is d(x) = sqrt(x^2 + (R + gap)^2) - R from the mantle. Beyond an end by t the nearest
    point lies on the end disc: distance sqrt(t^2 + max(d, 0)^2), so the piece is the integral of
    sqrt(T^2 - max(d, 0)^2) over |x| <= w, where d(w) = T. Inside the strip the signed distance is d where d >= 0 and
    at most 0 where d < 0, so it is below T there (T >= 0 asked for).
    """
    if threshold < 0:
        raise ValueError("threshold must not be negative: within the strip depth may come from the ends")
    if threshold <= gap:
        return 0.0
    centre = radius + gap
    half = sqrt((radius + threshold) ** 2 - centre**2)
    sunk = sqrt(max(radius**2 - centre**2, 0.0))
    beyond = quad(lambda x: np.sqrt(np.maximum(threshold**2 - (np.hypot(x, centre) - radius) ** 2, 0)), sunk, half)
    return 2 * half * length + 4 * (sunk * threshold + beyond)


# --- two spheres ----------------------------------------------------------------------------------------------------


def sphere_sphere_on_first(first: float, second: float, gap: float, threshold: float) -> float:
    """Area of the sphere of radius `first` within `threshold` of the one of radius `second`: a cap.

    Centres are D = R1 + R2 + gap apart. A point at angle phi from the line of centres is
    sqrt(R1^2 + D^2 - 2 R1 D cos phi) - R2 away, so cos phi0 = (R1^2 + D^2 - (R2 + T)^2) / (2 R1 D).
    """
    apart = first + second + gap
    phi = clipped_acos((first**2 + apart**2 - (second + threshold) ** 2) / (2 * first * apart))
    return 2 * pi * first**2 * (1 - cos(phi))


# --- sphere in a cup ------------------------------------------------------------------------------------------------


def sphere_cup_on_sphere(sphere: float, cup: float, offset: float, threshold: float) -> float:
    """Area of a sphere of radius R1 within `threshold` of a spherical cavity of radius R2: a cap.

    The sphere's centre is `offset` e below the cavity's, so gap = R2 - R1 - e. A point at angle phi from the downward
    axis lies at |p| = sqrt(e^2 + R1^2 + 2 e R1 cos phi) from the cavity's centre and is R2 - |p| away (negative in
    the wall). Holds while the cap stays inside the cup: its widest point must be nearer to the cavity than to the rim.
    """
    if offset == 0:
        return 4 * pi * sphere**2 if cup - sphere <= threshold else 0.0
    phi = clipped_acos(((cup - threshold) ** 2 - offset**2 - sphere**2) / (2 * offset * sphere))
    return 2 * pi * sphere**2 * (1 - cos(phi))


def sphere_cup_on_cup(sphere: float, cup: float, offset: float, threshold: float) -> float:
    """Area of the cavity within `threshold` of the sphere: a cap, while it is smaller than the cup itself.

    A point at angle phi is sqrt(R2^2 + e^2 - 2 R2 e cos phi) - R1 from the sphere.
    """
    if offset == 0:
        return 4 * pi * cup**2 if cup - sphere <= threshold else 0.0
    phi = clipped_acos((cup**2 + offset**2 - (sphere + threshold) ** 2) / (2 * cup * offset))
    return 2 * pi * cup**2 * (1 - cos(phi))


# --- torus and plane ------------------------------------------------------------------------------------------------


def flat_torus_plane_on_torus(ring: float, tube: float, gap: float, threshold: float) -> float:
    """Area of a torus that lies flat on a half-space: a band, 4 pi R r phi0 with cos phi0 = 1 - (T - gap)/r.

    phi is the angle around the tube from its lowest circle, height gap + r (1 - cos phi), area element
    r (R + r sin phi) dphi dtheta; the sine cancels over -phi0..phi0.
    """
    return 4 * pi * ring * tube * clipped_acos(1 - (threshold - gap) / tube)


def flat_torus_plane_on_plane(ring: float, tube: float, gap: float, threshold: float) -> float:
    """Area of the plane under the flat torus: a circular ring of half width w = sqrt((r + T)^2 - (r + gap)^2).

    4 pi R w while w <= R; the hole is closed beyond that and the ring becomes the disc pi (R + w)^2.
    """
    width = sqrt(max((tube + threshold) ** 2 - (tube + gap) ** 2, 0.0)) if threshold > gap else 0.0
    return 4 * pi * ring * width if width <= ring else pi * (ring + width) ** 2


def upright_torus_plane_on_torus(ring: float, tube: float, gap: float, threshold: float) -> float:
    """Area of a torus that stands on its outer equator, like a wheel: one quadrature.

    phi around the tube (0 outwards), theta around the ring (0 downwards): height
    gap + (R + r) - (R + r cos phi) cos theta. For each phi the part with height <= T is |theta| <= theta0 =
    acos(H / (R + r cos phi)), H = R + r - (T - gap), and the area is the integral of 2 theta0 r (R + r cos phi) dphi.
    Asked for T - gap <= 2r, so that H >= R - r and the phi range closes at cos phi1 = (H - R)/r.
    """
    depth = threshold - gap
    if depth <= 0:
        return 0.0
    if depth > 2 * tube:
        raise ValueError(f"threshold - gap = {depth} exceeds the tube's diameter {2 * tube}")
    height = ring + tube - depth

    def band(phi: np.ndarray) -> np.ndarray:
        out = ring + tube * np.cos(phi)
        return 4 * np.arccos(np.minimum(height / out, 1)) * tube * out

    return quad(band, 0.0, clipped_acos((height - ring) / tube))


def upright_torus_plane_on_plane(ring: float, tube: float, gap: float, threshold: float) -> float:
    """Area of the plane under the standing torus: one quadrature.

    The core circle's centre is Y = R + r + gap above the plane. A point (x along the wheel, z across) is
    sqrt((sqrt(x^2 + Y^2) - R)^2 + z^2) - r away: for each x a chord of half length
    sqrt((r + T)^2 - (sqrt(x^2 + Y^2) - R)^2), which vanishes at x = sqrt((R + r + T)^2 - Y^2).
    """
    if threshold <= gap:
        return 0.0
    above = ring + tube + gap
    reach = sqrt((ring + tube + threshold) ** 2 - above**2)

    def chord(x: np.ndarray) -> np.ndarray:
        return 4 * np.sqrt(np.maximum((tube + threshold) ** 2 - (np.hypot(x, above) - ring) ** 2, 0))

    return quad(chord, 0.0, reach)


# --- smallest distances ---------------------------------------------------------------------------------------------


def sphere_cup_gap(sphere: float, cup: float, offset: float) -> float:
    """Smallest signed distance of a sphere in a cavity, `offset` between the centres: R2 - R1 - e."""
    return cup - sphere - offset


def sphere_sphere_gap(first: float, second: float, apart: float) -> float:
    """Smallest signed distance of two spheres with centres `apart`: D - R1 - R2."""
    return apart - first - second
