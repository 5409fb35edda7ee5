"""Grounds: a plane by its equation, stairs, and a surface, closed or only a sheet."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
from jaxtyping import Float

from geocontact.geometry.shapes import HalfSpace, Proximity, within
from geocontact.geometry.surface import Surface

Vector = tuple[float, float, float]


@runtime_checkable
class Ground(Protocol):
    """Whatever answers the shared proximity query: `HalfSpace`, a closed `Surface`, `Stairs`, `Sheet`."""

    def proximity(self, points: Float[np.ndarray, "n 3"], limit: float = np.inf) -> Proximity:
        """Nearest point of the ground, signed distance (negative inside) and outward normal."""


@dataclass(frozen=True)
class Stairs:
    """Level treads of different heights that follow each other along one direction, with upright risers between.

    The nearest point alone counts: a sphere that touches tread and riser in an inner corner feels the nearer one.

    Parameters
    ----------
    edges
        Where the risers stand along `along` [m], increasing.
    heights
        Heights of the treads along `up` [m], one more than edges.
    along, up
        Unit vectors at a right angle.
    """

    edges: tuple[float, ...]
    heights: tuple[float, ...]
    along: Vector = (1.0, 0.0, 0.0)
    up: Vector = (0.0, 1.0, 0.0)

    def __post_init__(self) -> None:
        frame = np.array([self.along, self.up])
        if not np.allclose(frame @ frame.T, np.eye(2), rtol=0.0, atol=1e-9):
            raise ValueError("along and up must be unit vectors at a right angle")
        if len(self.heights) != len(self.edges) + 1 or not (np.diff(self.edges) > 0.0).all():
            raise ValueError("stairs need increasing edges and one height more than edges")

    def proximity(self, points: Float[np.ndarray, "n 3"], limit: float = np.inf) -> Proximity:
        """Signed distance to the treads and risers; the normal on the surface itself is that of tread or riser."""
        along, up = np.asarray(self.along), np.asarray(self.up)
        x, y = (points @ along)[:, None], (points @ up)[:, None]
        edges, heights = np.array(self.edges), np.array(self.heights)
        ends = np.concatenate([[-np.inf], edges, [np.inf]])
        low, high = np.minimum(heights[1:], heights[:-1]), np.maximum(heights[1:], heights[:-1])
        nearest_x = np.hstack([np.clip(x, ends[:-1], ends[1:]), np.broadcast_to(edges, (len(x), len(edges)))])
        nearest_y = np.hstack([np.broadcast_to(heights, (len(x), len(heights))), np.clip(y, low, high)])
        rows, part = np.arange(len(x)), np.argmin(np.hypot(x - nearest_x, y - nearest_y), axis=1)
        dx, dy = x[:, 0] - nearest_x[rows, part], y[:, 0] - nearest_y[rows, part]
        inside = y[:, 0] < heights[np.searchsorted(edges, x[:, 0], side="right")]
        distance = np.hypot(dx, dy) * np.where(inside, -1.0, 1.0)
        towards = np.vstack([np.tile(up, (len(heights), 1)), np.sign(heights[:-1] - heights[1:])[:, None] * along])
        with np.errstate(invalid="ignore", divide="ignore"):
            gradient = (dx[:, None] * along + dy[:, None] * up) / distance[:, None]
        normal = np.where(np.abs(distance[:, None]) > 0.0, gradient, towards[part])
        closest = points - dx[:, None] * along - dy[:, None] * up
        return within(limit, Proximity(distance, closest, normal, np.full(len(x), -1, np.int64)))


@dataclass(frozen=True)
class Sheet:
    """Ground given by an open surface: above is where its faces look, below counts as inside.

    Sound as long as the sheet is not folded more sharply than the spheres are round, and reaches beyond them.
    """

    surface: Surface

    @property
    def up(self) -> Float[np.ndarray, " 3"]:
        """Mean of the faces' normals, weighted with their areas, as a unit vector: where above is on the whole.

        Zero where the faces look every way alike.
        """
        total = np.einsum("f,fi->i", self.surface.face_area, self.surface.face_normal)
        return np.asarray(total / max(float(np.linalg.norm(total)), 1e-30))

    def proximity(self, points: Float[np.ndarray, "n 3"], limit: float = np.inf) -> Proximity:
        """The surface's own answer with the side that the nearest face's normal tells."""
        near = self.surface.proximity(points, limit)
        found = near.face >= 0
        side = np.ones(len(points))
        offset = points[found] - near.closest[found]
        side[found] = np.where(
            np.einsum("ij,ij->i", offset, self.surface.face_normal[near.face[found]]) < 0.0, -1.0, 1.0
        )
        return Proximity(near.distance * side, near.closest, near.normal * side[:, None], near.face)


def plane_of(normal: Vector, offset: float) -> HalfSpace:
    """The ground below all x with n.x = offset [m], where n is `normal`, of any length, as a unit vector.

    ValueError for a normal that has no length or no finite one.
    """
    size = math.hypot(*normal)
    if not 0.0 < size < math.inf:
        raise ValueError("the normal has no length")
    x, y, z = (part / size for part in normal)
    return HalfSpace((x * offset, y * offset, z * offset), (x, y, z))


def ground_of_surface(surface: Surface) -> Surface | Sheet:
    """A closed surface as a body to stand on, an open one as a sheet."""
    return surface if surface.closed else Sheet(surface)
