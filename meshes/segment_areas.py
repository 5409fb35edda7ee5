"""Girth, area and volume of the smooth body segments by quadrature of their formulas (mm, mm^2, mm^3)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from meshes.segments import Segment

AROUND, ALONG = 512, 96
"""Nodes of the trapezoidal rule around (spectral for periodic functions) and of Gauss' rule along y."""


@dataclass(frozen=True)
class Size:
    """Area of the skin without the cut ends, area of both ends [mm^2] and volume [mm^3]."""

    skin: float
    ends: float
    volume: float


def turns(n: int = AROUND) -> np.ndarray:
    """Evenly spread angles [rad]."""
    return 2 * np.pi * np.arange(n) / n


def section_area(segment: Segment, y: float) -> float:
    """Area of the cross-section at the height y, the integral of r^2/2 [mm^2]."""
    theta = turns()
    at = np.column_stack([theta, np.full_like(theta, y)])
    return float(np.pi * np.mean(segment.radius(at)[:, 0] ** 2))


def girth(segment: Segment, y: float) -> float:
    """Length of the skin around the segment at the height y, the integral of sqrt(r^2 + r_theta^2) [mm]."""
    theta = turns()
    at = np.column_stack([theta, np.full_like(theta, y)])
    return float(2 * np.pi * np.mean(np.linalg.norm(segment.tangents(at)[:, 0], axis=1)))


def size(segment: Segment, around: int = AROUND, along: int = ALONG) -> Size:
    """The segment between y = -length/2 and length/2, cut off flat."""
    nodes, weights = np.polynomial.legendre.leggauss(along)
    at = np.stack(np.meshgrid(turns(around), segment.length / 2 * nodes, indexing="ij"), axis=-1)
    cell = 2 * np.pi / around * segment.length / 2 * weights
    skin = np.linalg.norm(segment.area_vector(at), axis=-1) @ cell
    volume = segment.radius(at)[..., 0] ** 2 / 2 @ cell
    ends = sum(section_area(segment, sign * segment.length / 2) for sign in (-1, 1))
    return Size(float(skin.sum()), ends, float(volume.sum()))
