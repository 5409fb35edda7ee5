"""Body segments as closed formulas: thigh, shank, upper arm and torso, none of anybody (synthetic, mm).

Frame of a segment: x anterior, y superior (along the segment), z to the subject's right, origin halfway up its axis.
The skin is the surface S(theta, y) = (r cos theta, y, r sin theta), theta = 0 in front and pi/2 on the right, with

    r(theta, y) = (1 + c1 y + c2 y^2) rho(theta) + sum_k h_k exp(-((y - y_k)/w_k)^2) exp(s_k (cos(theta - t_k) - 1)),
    rho(theta) = (cos^4/a^4 + sin^4/b^4 + 2 q cos^2 sin^2/(a^2 b^2))^(-1/4):

an oval of half-axes a (x) and b (z), an ellipse for q = 1 and a super-ellipse of exponent 4 for q = 0, that tapers (c1)
and bellies (c2), with muscle bulges of height h_k. Every function is analytic, so that quadratures over the skin and
integrations along it converge as fast as their rules can.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

Jet = tuple[np.ndarray, np.ndarray, np.ndarray]
"""A function of one variable with its first and second derivative."""


@dataclass(frozen=True)
class Oval:
    """Cross-section of half-axes `front` (x) and `side` (z) [mm]; `roundness` q is 1 for an ellipse."""

    front: float
    side: float
    roundness: float = 1.0

    def jet(self, theta: np.ndarray) -> Jet:
        """rho(theta) [mm]."""
        c, s = np.cos(theta), np.sin(theta)
        a, b, m = self.front**-4, self.side**-4, self.roundness / (self.front * self.side) ** 2
        f = a * c**4 + b * s**4 + 2 * m * (c * s) ** 2
        f1 = -4 * a * c**3 * s + 4 * b * s**3 * c + m * np.sin(4 * theta)
        f2 = -4 * a * (c**4 - 3 * (c * s) ** 2) + 4 * b * (3 * (c * s) ** 2 - s**4) + 4 * m * np.cos(4 * theta)
        return f**-0.25, -f1 * f**-1.25 / 4, -f2 * f**-1.25 / 4 + 5 / 16 * f1**2 * f**-2.25


@dataclass(frozen=True)
class Bulge:
    """Muscle of `height` [mm] at the turn `at` [rad] and the height `y` [mm], 1/e after `reach` [mm] along y."""

    height: float
    at: float
    y: float
    reach: float
    sharpness: float = 2.0

    def along(self, y: np.ndarray) -> Jet:
        """h exp(-u^2) with u = (y - y_k)/w_k [mm]."""
        u = (y - self.y) / self.reach
        f = self.height * np.exp(-(u**2))
        return f, -2 * u / self.reach * f, (4 * u**2 - 2) / self.reach**2 * f

    def around(self, theta: np.ndarray) -> Jet:
        """exp(s (cos(theta - t_k) - 1)), the shape of von Mises' distribution."""
        c, s, k = np.cos(theta - self.at), np.sin(theta - self.at), self.sharpness
        f = np.exp(k * (c - 1))
        return f, -k * s * f, (k**2 * s**2 - k * c) * f


@dataclass(frozen=True)
class Segment:
    """A segment of `length` [mm] along y; parameters (theta, y) are arrays (..., 2) in rad and mm."""

    name: str
    length: float
    oval: Oval
    taper: float
    belly: float
    bulges: tuple[Bulge, ...] = ()

    def terms(self, at: np.ndarray) -> Iterator[tuple[Jet, Jet]]:
        """The products A(y) B(theta) that the radius is the sum of."""
        theta, y = at[..., 0], at[..., 1]
        widening = 1 + self.taper * y + self.belly * y**2
        yield (widening, self.taper + 2 * self.belly * y, np.full_like(y, 2 * self.belly)), self.oval.jet(theta)
        for bulge in self.bulges:
            yield bulge.along(y), bulge.around(theta)

    def radius(self, at: np.ndarray) -> np.ndarray:
        """r and its derivatives (..., 6): r, r_theta, r_y, r_theta,theta, r_theta,y, r_yy."""
        return sum(
            np.stack([a * b, a * b1, a1 * b, a * b2, a1 * b1, a2 * b], axis=-1)
            for (a, a1, a2), (b, b1, b2) in self.terms(at)
        )

    def points(self, at: np.ndarray) -> np.ndarray:
        """S (..., 3) [mm]."""
        r = self.radius(at)[..., 0]
        return np.stack([r * np.cos(at[..., 0]), at[..., 1], r * np.sin(at[..., 0])], axis=-1)

    def tangents(self, at: np.ndarray) -> np.ndarray:
        """S_theta and S_y (..., 2, 3)."""
        return self.derivatives(at)[..., :2, :]

    def derivatives(self, at: np.ndarray) -> np.ndarray:
        """S_theta, S_y, S_theta,theta, S_theta,y and S_yy (..., 5, 3)."""
        r, rt, ry, rtt, rty, ryy = np.moveaxis(self.radius(at), -1, 0)
        c, s, zero = np.cos(at[..., 0]), np.sin(at[..., 0]), np.zeros_like(r)
        columns = (
            (rt * c - r * s, zero, rt * s + r * c),
            (ry * c, zero + 1, ry * s),
            (rtt * c - 2 * rt * s - r * c, zero, rtt * s + 2 * rt * c - r * s),
            (rty * c - ry * s, zero, rty * s + ry * c),
            (ryy * c, zero, ryy * s),
        )
        return np.stack([np.stack(column, axis=-1) for column in columns], axis=-2)

    def area_vector(self, at: np.ndarray) -> np.ndarray:
        """S_y x S_theta (..., 3): along the outward normal, as long as the skin's area per rad and mm."""
        tangents = self.tangents(at)
        return np.cross(tangents[..., 1, :], tangents[..., 0, :])

    def normals(self, at: np.ndarray) -> np.ndarray:
        """Outward unit normals (..., 3)."""
        vector = self.area_vector(at)
        return vector / np.linalg.norm(vector, axis=-1, keepdims=True)

    def off_surface(self, points: np.ndarray) -> np.ndarray:
        """How far points (..., 3) [mm] lie outside S along the radius, in their own theta and y [mm]."""
        at = np.stack([np.arctan2(points[..., 2], points[..., 0]), points[..., 1]], axis=-1)
        return np.hypot(points[..., 0], points[..., 2]) - self.radius(at)[..., 0]


FRONT, BACK = 0.0, np.pi

THIGH = Segment(
    "thigh", 380.0, Oval(76.0, 72.0, 0.9), 0.0011, 0.0, (Bulge(8.0, FRONT, 20.0, 110.0), Bulge(5.0, BACK, -10.0, 100.0))
)
SHANK = Segment(
    "shank", 340.0, Oval(44.0, 42.0), 0.0014, 0.0, (Bulge(14.0, BACK, 75.0, 80.0, 1.5), Bulge(3.0, FRONT, 60.0, 90.0))
)
UPPER_ARM = Segment(
    "upper_arm", 260.0, Oval(46.0, 42.0), 0.0008, 0.0, (Bulge(6.0, FRONT, -10.0, 60.0), Bulge(4.0, BACK, 20.0, 70.0))
)
TORSO = Segment("torso", 420.0, Oval(112.0, 155.0, 0.6), 0.0004, -1.2e-6)
SEGMENTS = (THIGH, SHANK, UPPER_ARM, TORSO)
"""Girths about those of an adult: mid-thigh 0.49 m, calf 0.34 m, upper arm 0.30 m, chest 0.89 m."""
