"""Grounds whose numbers are symbols: a plane and stairs, so that one set of equations serves every slope and flight."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol, runtime_checkable

import numpy as np

from geocontact.geometry.shapes import HalfSpace
from geocontact.loads.ground import Stairs

if TYPE_CHECKING:
    from casadi import SX

CLOSE = 1e-12
"""m; added to a distance in the root, which has a derivative where the centre of a sphere lies on the surface."""
APART = 1e-9
"""m²; of two parts of stairs that are as near, the earlier one counts."""


@runtime_checkable
class SymbolicGround(Protocol):
    """Whatever tells how far a place is from it."""

    def near(self, place: SX) -> tuple[SX, SX]:
        """Signed distance of a place [m], negative below the ground, and the outward normal there."""


@dataclass(frozen=True)
class SymbolicPlane:
    """A plane.

    Parameters
    ----------
    numbers
        Unit normal, and how far along it the plane lies from the origin [m]: `plane_numbers`.
    """

    numbers: SX

    def near(self, place: SX) -> tuple[SX, SX]:
        """The answer of `HalfSpace.proximity`, in symbols."""
        from casadi import dot

        return dot(place, self.numbers[:3, :]) - self.numbers[3], self.numbers[:3, :]


@dataclass(frozen=True)
class SymbolicStairs:
    """Stairs along x with y up, as `loads.ground.Stairs`: the nearest part counts.

    Parameters
    ----------
    numbers
        Edges, then one height more [m]: `stairs_numbers`.
    """

    numbers: SX

    def near(self, place: SX) -> tuple[SX, SX]:
        """The answer of `Stairs.proximity`, in symbols."""
        from casadi import fmax, fmin, if_else, sqrt, vertcat

        count = (self.numbers.shape[0] - 1) // 2
        edges, heights = self.numbers[:count, :], self.numbers[count:, :]
        x, y = place[0], place[1]
        under = heights[0]
        parts = []
        for k in range(count + 1):
            low = x if not k else fmax(x, edges[k - 1])
            parts.append((x - (low if k == count else fmin(low, edges[k])), y - heights[k]))
        for k in range(count):
            lower, upper = fmin(heights[k], heights[k + 1]), fmax(heights[k], heights[k + 1])
            parts.append((x - edges[k], y - fmin(fmax(y, lower), upper)))
            under = if_else(x >= edges[k], heights[k + 1], under)
        (dx, dy), *others = parts
        for along, up in others:
            nearer = along**2 + up**2 < dx**2 + dy**2 - APART
            dx, dy = if_else(nearer, along, dx), if_else(nearer, up, dy)
        distance = sqrt(dx**2 + dy**2 + CLOSE**2) * if_else(y < under, -1.0, 1.0)
        return distance, vertcat(dx, dy, 0.0) / distance


def plane_numbers(ground: HalfSpace) -> list[float]:
    """Numbers of `SymbolicPlane`."""
    normal = np.asarray(ground.normal, float) / np.linalg.norm(ground.normal)
    return [*map(float, normal), float(normal @ np.asarray(ground.point, float))]


def stairs_numbers(ground: Stairs) -> list[float]:
    """Numbers of `SymbolicStairs`. ValueError for stairs that do not rise along x with y up."""
    if not np.allclose([ground.along, ground.up], [(1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], rtol=0.0, atol=1e-12):
        raise ValueError("stairs go along x, with y up")
    return [*ground.edges, *ground.heights]
