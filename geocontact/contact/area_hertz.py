"""Force from a contact area: what the knee-implant paper's "integrated Hertz model" may mean.

The paper (sec. 2.5) gives F through a "contact radius" a, the radius R of "the contact
cylinder", E and nu, and takes the total area under a distance threshold for a; its equation is missing from the text
that is to be had. So every reading has a name here and nothing is assumed silently. All of them are proportional to E*:
whatever the reading, area and force give one number, never E and nu apart.

Scalar in, scalar out: the same source runs on arrays, in numba loops and on CasADi symbols (numpy mode 1).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from jaxtyping import Float

X = TypeVar("X", bound=Any)
"""A number, an array or a symbol."""


def disc_force(area: X, radius: X, modulus: X) -> X:
    """4/3 E* a^3 / R with a = sqrt(area / pi): the area is one Hertzian circle [N]; 0 unless area > 0."""
    a = np.sqrt(np.maximum(area, 1e-24) / np.pi)
    force: X = (area > 0.0) * (4.0 / 3.0 * modulus * a * a * a / radius)
    return force


def discs_force(area: X, radius: X, modulus: X) -> X:
    """The area is two equal Hertzian circles, one per condyle: `disc_force` over sqrt(2) [N]."""
    a = np.sqrt(np.maximum(0.5 * area, 1e-24) / np.pi)
    force: X = (area > 0.0) * (8.0 / 3.0 * modulus * a * a * a / radius)
    return force


def strip_force(area: X, radius: X, modulus: X, length: X) -> X:
    """Pi E* b^2 L / (4 R) with b = area / (2 L): the area is the strip of a cylinder of length L [N]."""
    b = 0.5 * np.maximum(area, 0.0) / length
    force: X = 0.25 * np.pi * modulus * b * b * length / radius
    return force


def cap_force(area: X, radius: X, modulus: X) -> X:
    """Hertz's force at the depth area / (2 pi R), where an undeformed sphere overlaps a plane in that area [N].

    Meshes are rigid, so the area at threshold 0 is that of the overlapping cap, 2 pi R d. Hertz's own patch is half as
    large, pi R d: this is `disc_force` over 2^1.5.
    """
    depth = np.maximum(area, 1e-24) / (2.0 * np.pi * radius)
    force: X = (area > 0.0) * (4.0 / 3.0 * modulus * np.sqrt(radius * depth) * depth)
    return force


def threshold_force(area: X, radius: X, modulus: X, threshold: X) -> X:
    """Hertz's force at the depth area / (2 pi R) - T: the area lies within the distance T of a plane [N].

    The cap of an undeformed sphere within T is 2 pi R (d + T). A sphere that only just touches has the area 2 pi R T
    and no force, which every other reading overlooks.
    """
    depth = area / (2.0 * np.pi * radius) - threshold
    sunk = np.maximum(depth, 1e-12)
    force: X = (depth > 0.0) * (4.0 / 3.0 * modulus * np.sqrt(radius * sunk) * sunk)
    return force


@dataclass(frozen=True)
class PatchGeometry:
    """What the readings take besides area and E*: radius R, length of a strip and threshold of the area, all [m].

    A radius that follows flexion is an array as long as the area.
    """

    radius: float | Float[np.ndarray, " t"]
    length: float
    threshold: float


@dataclass(frozen=True)
class Reading:
    """One meaning of the area-integrated law.

    Parameters
    ----------
    name
        For options and tables.
    words
        What the area is taken for.
    power
        Force grows with this power of the area; of the area beyond touching for "threshold".
    force
        Law of (area [m^2], patch, E* [Pa]), in N.
    """

    name: str
    words: str
    power: float
    force: Callable[[Any, PatchGeometry, Any], Any]

    def modulus(self, area: float, force: float, patch: PatchGeometry) -> float:
        """E* [Pa] with which `area` carries `force`; infinite where the reading sees no contact."""
        unit = float(self.force(area, patch, 1.0))
        return force / unit if unit > 0.0 else float("inf")


READINGS: tuple[Reading, ...] = (
    Reading("disc", "one Hertzian circle, a = sqrt(A/pi)", 1.5, lambda a, p, e: disc_force(a, p.radius, e)),
    Reading("discs", "two equal Hertzian circles, one per condyle", 1.5, lambda a, p, e: discs_force(a, p.radius, e)),
    Reading("strip", "strip of a cylinder, A = 2 b L", 2.0, lambda a, p, e: strip_force(a, p.radius, e, p.length)),
    Reading("cap", "overlap of an undeformed sphere, A = 2 pi R d", 1.5, lambda a, p, e: cap_force(a, p.radius, e)),
    Reading(
        "threshold",
        "undeformed sphere within the threshold, A = 2 pi R (d + T)",
        1.5,
        lambda a, p, e: threshold_force(a, p.radius, e, p.threshold),
    ),
)
"""Every reading; "disc" is what the paper's words ask for most directly."""
