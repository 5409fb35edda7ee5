"""Pressure that moves over a body segment in closed form, and its resultant by quadrature over the smooth skin.

A footprint presses around the skin point c with

    p(x) = p0 (1 - Q)^m,  Q = (e.(x - c)/a)^2 + (|x - c|^2 - (e.(x - c))^2)/b^2,  p = 0 where Q > 1,

where e is the skin's unit tangent along y in c, a the half-length along the segment and b that across it. m = 1/2 is
Hertz' distribution (Johnson, Contact Mechanics, 1985, eq. 3.57); a soft pad lets go more gently, m = 3/2 or 2. Nothing
rubs, so that the force on the body per area is -p n, n the outward normal.

For the integrals c is the pole of polar coordinates in the parameters, theta = theta_c + s cos(phi)/|S_theta| and
y = y_c + s sin(phi)/|S_y|; the edge s = E(phi) where Q = 1 is found by Newton's method, and s = E sin(psi) takes the
root out of the integrand: the trapezoidal rule in phi and Gauss' rule in psi then converge exponentially.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.segments import Segment

AROUND, OUTWARDS = 64, 24
"""Nodes in phi and in psi; the resultants then stand to 1e-12 of their size (tests/meshes)."""


@dataclass(frozen=True)
class Footprint:
    """Over frames (t,): peak p0 [kPa] and (theta, y) of c (t, 2); half-lengths a along y and b across [mm]; power m."""

    peak: np.ndarray
    middle: np.ndarray
    along: float
    across: float
    power: float = 0.5

    def frame_of(self, segment: Segment) -> tuple[np.ndarray, np.ndarray]:
        """c (t, 3) [mm] and e (t, 3)."""
        e = segment.tangents(self.middle)[:, 1]
        return segment.points(self.middle), e / np.linalg.norm(e, axis=1, keepdims=True)

    def reach(self, segment: Segment, points: np.ndarray) -> np.ndarray:
        """Q (t, ...) of points (t, ..., 3) [mm], frame by frame."""
        c, e = (a.reshape(len(a), *(1,) * (points.ndim - 2), 3) for a in self.frame_of(segment))
        away = points - c
        lengthwise = np.sum(away * e, axis=-1) ** 2
        return lengthwise / self.along**2 + (np.sum(away**2, axis=-1) - lengthwise) / self.across**2

    def pressure(self, segment: Segment, points: np.ndarray) -> np.ndarray:
        """p (t, ...) [kPa] at points (t, ..., 3) or (1, ..., 3) [mm]."""
        shape = (len(self.peak), *(1,) * (points.ndim - 2))
        return self.peak.reshape(shape) * np.maximum(0.0, 1 - self.reach(segment, points)) ** self.power


@dataclass(frozen=True)
class Resultant:
    """On the body, per frame: force (t, 3), moment (t, 3) about `point` [mm], normal = integral of p, all in N and N m.

    `first_moment` (t, 3) is the integral of p x [N mm], `area` that of the pressed skin [mm^2], `peak` in Pa.
    """

    point: np.ndarray
    force: np.ndarray
    moment: np.ndarray
    normal: np.ndarray
    first_moment: np.ndarray
    area: np.ndarray
    peak: np.ndarray

    @property
    def centre(self) -> np.ndarray:
        """Pressure-weighted mean point of the skin (t, 3) [mm], NaN where nothing presses."""
        with np.errstate(invalid="ignore"):
            return self.first_moment / self.normal[:, None]

    def plus(self, other: Resultant) -> Resultant:
        """Of two footprints that do not overlap, about the same point."""
        sums = (getattr(self, n) + getattr(other, n) for n in ("force", "moment", "normal", "first_moment", "area"))
        return Resultant(self.point, *sums, np.maximum(self.peak, other.peak))


def footprint_edge(segment: Segment, print_: Footprint, ray: np.ndarray) -> np.ndarray:
    """E (t, f) [mm] along the rays (t, f, 2) in the parameters, where Q = 1."""
    s = np.full(ray.shape[:-1], min(print_.along, print_.across))
    h = 1e-4
    for _ in range(12):
        at = [print_.middle[:, None] + (s + d)[..., None] * ray for d in (-h, 0.0, h)]
        below, here, above = (np.sqrt(print_.reach(segment, segment.points(a))) for a in at)
        s = s - (here - 1) * 2 * h / (above - below)
    return s


def resultant(
    segment: Segment, print_: Footprint, point: np.ndarray, around: int = AROUND, outwards: int = OUTWARDS
) -> Resultant:
    """Integrals of one footprint over the smooth skin; the moment about `point` (3,) [mm]."""
    x, w = np.polynomial.legendre.leggauss(outwards)
    psi, w = (x + 1) * np.pi / 4, w * np.pi / 4
    phi = 2 * np.pi * np.arange(around) / around
    lengths = np.linalg.norm(segment.tangents(print_.middle), axis=-1)
    ray = np.stack([np.cos(phi), np.sin(phi)], axis=-1) / lengths[:, None]
    edge = footprint_edge(segment, print_, ray)[..., None]
    at = print_.middle[:, None, None] + (edge * np.sin(psi))[..., None] * ray[:, :, None]
    # dtheta dy = s ds dphi / (|S_theta| |S_y|), ds = E cos(psi) dpsi
    cell = edge**2 * np.sin(psi) * np.cos(psi) * w * (2 * np.pi / around) / lengths.prod(axis=1)[:, None, None]
    skin = segment.area_vector(at)
    points = segment.points(at)
    area = np.linalg.norm(skin, axis=-1) * cell
    p = print_.pressure(segment, points) * 1e-3  # kPa = 1e-3 N/mm^2
    push = -(p * cell)[..., None] * skin
    pressing = print_.peak > 0
    return Resultant(
        point,
        push.sum(axis=(1, 2)),
        np.cross(points - point, push).sum(axis=(1, 2)) * 1e-3,
        (p * area).sum(axis=(1, 2)),
        ((p * area)[..., None] * points).sum(axis=(1, 2)),
        np.where(pressing, area.sum(axis=(1, 2)), 0.0),
        print_.peak * 1e3,
    )
