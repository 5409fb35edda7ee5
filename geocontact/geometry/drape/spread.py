"""A mat spread along straightest lines, and positions on it, counted in cells."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Literal

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.geometry.drape.mat import Mat
from geocontact.geometry.kernels.geodesic import FLAT, joined, moved, traced
from geocontact.geometry.surface import Surface
from geocontact.geometry.topology import neighbours


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


Way = Literal["rows", "columns"]


@dataclass(frozen=True, eq=False)
class Anchor:
    """Where the middle of the mat lies and which way its rows run from there.

    Parameters
    ----------
    place
        One place on the surface.
    heading
        Unit direction of increasing row there, in the plane of the place's face.
    """

    place: SurfacePoints
    heading: Float[np.ndarray, " 3"]

    @classmethod
    def at(cls, geodesics: Geodesics, point: Float[np.ndarray, " 3"], heading: Float[np.ndarray, " 3"]) -> Anchor:
        """At the place nearest to a point [m], with a heading near the one given (need not be a unit vector)."""
        place = geodesics.nearest(point[None])
        normal = geodesics.normal(place)[0]
        ahead = heading - (heading @ normal) * normal
        if not np.linalg.norm(ahead) > 1e-6 * np.linalg.norm(heading):
            raise ValueError("the rows of the mat stand upright on the surface; their direction must run along it")
        return cls(place, ahead / np.linalg.norm(ahead))

    def turned(self, geodesics: Geodesics, angle: float) -> Anchor:
        """The heading turned by an angle [rad], counter-clockwise seen from outside."""
        side = np.cross(geodesics.normal(self.place)[0], self.heading)
        return Anchor(self.place, np.cos(angle) * self.heading + np.sin(angle) * side)

    def carried(self, geodesics: Geodesics, ahead: float, aside: float) -> Anchor:
        """Moved [m] along its heading and to the left of it, in one straight line; the heading keeps its angle to it.

        Off the surface the place says so.
        """
        far = float(np.hypot(ahead, aside))
        if far == 0.0:
            return self
        way = self.turned(geodesics, float(np.arctan2(aside, ahead)))
        places, headings = geodesics.along(self.place, way.heading[None], np.array([far]))
        there = SurfacePoints(places.face[0], places.point[0])
        if not there.on[0]:
            return Anchor(there, headings[0, 0])
        return Anchor(there, headings[0, 0]).turned(geodesics, -float(np.arctan2(aside, ahead)))


def spread(
    geodesics: Geodesics,
    anchor: Anchor,
    mat: Mat,
    ahead: Float[np.ndarray, " a"],
    aside: Float[np.ndarray, " b"],
    spine: Way = "rows",
) -> SurfacePoints:
    """Places of all mat positions (ahead, aside) [m] from the anchor, along rows and along columns; shape (a, b).

    The spine runs along the rows (or columns) through the anchor; from each of its stations a rib leaves at a right
    angle (geodesic parallel, or Fermi, coordinates; do Carmo, Differential Geometry of Curves and Surfaces, sec. 4.6).
    Lengths along the spine and along every rib are kept, and all of them where the surface can be laid flat. Elsewhere
    neighbouring ribs at distance v from the spine are apart by the factor cos(v sqrt(K)), K the Gaussian curvature.
    """
    columns = mat.hand * np.cross(geodesics.normal(anchor.place)[0], anchor.heading)
    if spine == "rows":
        nodes, heading = geodesics.along(anchor.place, anchor.heading[None], ahead)
        ribs, sense = aside, mat.hand
    else:
        nodes, heading = geodesics.along(anchor.place, columns[None], aside)
        ribs, sense = ahead, -mat.hand
    base = SurfacePoints(nodes.face[0], nodes.point[0])
    out = sense * np.cross(geodesics.normal(base), heading[0])
    places, _ = geodesics.along(base, out, ribs)
    if spine == "rows":
        return places
    return SurfacePoints(np.ascontiguousarray(places.face.T), np.ascontiguousarray(places.point.transpose(1, 0, 2)))


def corners_at(
    shape: tuple[int, ...], cells: Float[np.ndarray, "k 2"]
) -> tuple[Int[np.ndarray, "k 4"], Float[np.ndarray, "k 4"]]:
    """Corners of the cell that each position lies in (flat indices of nodes of `shape`), and their bilinear shares."""
    low, (s, t) = _in_cell(shape, cells)
    first = low @ np.array([shape[1], 1])
    index = np.stack([first, first + shape[1], first + 1, first + shape[1] + 1], axis=1)
    return index, np.stack([(1.0 - s) * (1.0 - t), s * (1.0 - t), (1.0 - s) * t, s * t], axis=1)


def between(nodes: SurfacePoints, cells: Float[np.ndarray, "k 2"]) -> Float[np.ndarray, "k 3"]:
    """Points at positions counted in cells [m], linear between the corners of their cell; NaN where it is not there."""
    index, share = corners_at(nodes.face.shape, cells)
    corners = nodes.point.reshape(-1, 3)[index]
    return np.asarray(np.where(share[..., None] > 0.0, share[..., None] * corners, 0.0).sum(axis=1))


def directions(points: Float[np.ndarray, "r1 c1 3"], cells: Float[np.ndarray, "k 2"]) -> Float[np.ndarray, "k 2 3"]:
    """Unit directions of increasing row and of increasing column at positions counted in cells; NaN off the surface.

    By differences of the corners, of second order also at the ends of the mat; beside corners that are off the surface
    by the sides of the position's own cell.
    """
    index, share = corners_at(points.shape, cells)
    smooth = np.stack([_slope(points, k).reshape(-1, 3)[index] for k in (0, 1)], axis=1)
    ways = np.where(share[:, None, :, None] > 0.0, share[:, None, :, None] * smooth, 0.0).sum(axis=2)
    _, (s, t) = _in_cell(points.shape, cells)
    a, b, c, d = points.reshape(-1, 3)[index].transpose(1, 0, 2)
    s, t = s[:, None], t[:, None]
    own = np.stack([(1.0 - t) * (b - a) + t * (d - c), (1.0 - s) * (c - a) + s * (d - b)], axis=1)
    ways = np.where(np.isfinite(ways).all(axis=(1, 2))[:, None, None], ways, own)
    return np.asarray(ways / np.linalg.norm(ways, axis=2, keepdims=True))


def _slope(points: Float[np.ndarray, "r1 c1 3"], axis: int) -> Float[np.ndarray, "r1 c1 3"]:
    """Change of the corners from one to the next [m]."""
    return np.asarray(np.gradient(points, axis=axis, edge_order=2 if points.shape[axis] > 2 else 1))


def _in_cell(
    shape: tuple[int, ...], cells: Float[np.ndarray, "k 2"]
) -> tuple[Int[np.ndarray, "k 2"], Float[np.ndarray, "2 k"]]:
    """First corner (row, column) of the cell that each position lies in, and how far in it is along both."""
    low = np.clip(np.floor(cells).astype(np.int64), 0, np.array(shape[:2]) - 2)
    return low, (cells - low).T
