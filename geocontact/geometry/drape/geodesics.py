"""Straightest lines over a surface, held ready for many of them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.geometry.kernels.geodesic import FLAT, joined, moved, traced
from geocontact.geometry.neighbours import neighbours
from geocontact.geometry.surface import Surface


@dataclass(frozen=True, eq=False)
class SurfacePoints:
    """Points of a surface, each with the face it lies on.

    Parameters
    ----------
    face
        Index of the face, -1 where a line ran off the surface.
    point
        [m]; NaN there.
    """

    face: Int[np.ndarray, "*n"]
    point: Float[np.ndarray, "*n 3"]

    @property
    def on(self) -> Bool[np.ndarray, "*n"]:
        """Which are on the surface."""
        return np.asarray(self.face >= 0)


@dataclass(frozen=True, eq=False)
class Joins:
    """Straightest lines between pairs of places; NaN where there is none.

    Parameters
    ----------
    length
        [m].
    leaving, arriving
        Unit directions at the first and at the second place, each in the plane of its face.
    miss
        How far beside its goal the line ends [m]: a line may pass a corner of the mesh on the one side or on the other
        and meet no place in between.
    """

    length: Float[np.ndarray, " n"]
    leaving: Float[np.ndarray, "n 3"]
    arriving: Float[np.ndarray, "n 3"]
    miss: Float[np.ndarray, " n"]


@dataclass(frozen=True, eq=False)
class Geodesics:
    """A surface made ready for lines over it.

    Parameters
    ----------
    surface
        Faces counter-clockwise seen from outside, open or closed. Lines end at open edges, and at edges where three
        faces meet or two that are turned against each other. Faces without area are crossed.
    """

    surface: Surface

    @cached_property
    def faces(self) -> Int[np.ndarray, "m 3"]:
        """Corners of the faces, coincident vertices as one."""
        return np.ascontiguousarray(self.surface.topology.merged[self.surface.faces], np.int64)

    @cached_property
    def neighbour(self) -> Int[np.ndarray, "m 3"]:
        """The face across each edge."""
        return neighbours(self.faces)

    @cached_property
    def _wide(self) -> Int[np.ndarray, " k"]:
        """Faces with an area, on which places can be."""
        longest = np.maximum(self.surface.edge_length.max(axis=1), 1e-300)
        found = np.flatnonzero(2.0 * self.surface.face_area > FLAT * longest**2)
        if not len(found):
            raise ValueError(f"{self.surface.name}: no face has an area; nothing can be laid onto it")
        return found

    @cached_property
    def _ground(self) -> Surface:
        """The surface without faces that have no area."""
        if len(self._wide) == len(self.surface.faces):
            return self.surface
        faces = np.ascontiguousarray(self.surface.faces[self._wide])
        return Surface(self.surface.vertices, faces, self.surface.name, self.surface.assume_closed)

    def nearest(self, points: Float[np.ndarray, "n 3"]) -> SurfacePoints:
        """The places nearest to points [m]."""
        found = self._ground.proximity(points)
        return SurfacePoints(self._wide[found.face].astype(np.int64), found.closest)

    def normal(self, places: SurfacePoints) -> Float[np.ndarray, "*n 3"]:
        """Outward unit normals of their faces; NaN off the surface."""
        return np.asarray(np.where(places.on[..., None], self.surface.face_normal[places.face], np.nan))

    def along(
        self, start: SurfacePoints, direction: Float[np.ndarray, "n 3"], stations: Float[np.ndarray, " s"]
    ) -> tuple[SurfacePoints, Float[np.ndarray, "n s 3"]]:
        """Places at signed lengths [m] along the straightest line through each start, and the line's directions there.

        `direction` is turned into the plane of the start's face. Negative lengths lie behind; directions point ahead
        everywhere.
        """
        normal = self.normal(start)
        ahead = direction - np.einsum("ij,ij->i", direction, normal)[:, None] * normal
        size = np.linalg.norm(ahead, axis=1, keepdims=True)
        if (size[start.on] == 0.0).any():
            raise ValueError("a direction stands upright on the surface; give one that runs along it")
        ahead /= size
        n, s = len(start.face), len(stations)
        face, point = np.full((n, s), -1), np.full((n, s, 3), np.nan)
        heading = np.full((n, s, 3), np.nan)
        for sign in (1.0, -1.0):
            side = np.flatnonzero(stations >= 0.0 if sign > 0.0 else stations < 0.0)
            side = side[np.argsort(np.abs(stations[side]), kind="stable")]
            mesh = self.surface.vertices, self.faces, self.neighbour
            ray = start.face, start.point, sign * ahead
            face[:, side], point[:, side], way = traced(*mesh, *ray, np.abs(stations[side]))
            heading[:, side] = sign * way
        return SurfacePoints(face, point), heading

    def moved(self, start: SurfacePoints, shift: Float[np.ndarray, "n 3"]) -> SurfacePoints:
        """Places reached by a straightest line of the length and direction of each shift [m], along its face."""
        face, point = moved(self.surface.vertices, self.faces, self.neighbour, start.face, start.point, shift)
        return SurfacePoints(face, point)

    def joined(self, start: SurfacePoints, goal: SurfacePoints) -> Joins:
        """Straightest lines from places to near ones: where the surface turns little between them."""
        return Joins(
            *joined(self.surface.vertices, self.faces, self.neighbour, start.face, start.point, goal.face, goal.point)
        )
