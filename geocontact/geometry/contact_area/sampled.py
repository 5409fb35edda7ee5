"""A surface laid out for being measured against another one: points along the tree, face sums, what counts."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from jaxtyping import Bool, Float, Int, Int8

from geocontact.geometry.inside_outside import resolve_inside_outside
from geocontact.geometry.kernels.batch import chunk_spheres, move, signed_distances
from geocontact.geometry.kernels.clip import fraction_below
from geocontact.geometry.kernels.quarter import divided
from geocontact.geometry.plane import Plane
from geocontact.geometry.surface import Surface


def compact(faces: Int[np.ndarray, "k 3"], points: Distances) -> tuple[Int[np.ndarray, "k 3"], Distances]:
    """Only the points these faces use, and the faces renumbered to them."""
    named = np.zeros(len(points.distance), bool)
    named[faces] = True
    used = np.flatnonzero(named)
    place = np.empty(len(named), np.int64)
    place[used] = np.arange(len(used))
    return place[faces], points[used]


def quartered(
    faces: Int[np.ndarray, "k 3"], points: Distances, other: Surface, beyond: float
) -> tuple[Int[np.ndarray, "4*k 3"], Distances]:
    """Faces replaced by their four quarters (in this order per face) and the points with the new ones appended.

    A new point is measured up to the longest edge of its faces plus `beyond` [m], or as far as its neighbours allow
    (distance is 1-Lipschitz).
    """
    p = points
    quarters, middle, limit, across = divided(faces, p.points, p.distance, p.slot, p.across, beyond)
    return quarters, points + measure(other, middle, limit, across)


@dataclass(frozen=True, eq=False)
class Distances:
    """Distance of each sampled point to the other surface, in the other surface's frame about its centre.

    `distance` is unsigned; `side` is 1 outside, -1 inside (always 1 against an open surface); a point beyond its limit
    has slot -1 and its limit as distance. `across` is the signed distance to the splitting plane (1 without one);
    `undecided` counts points whose side the winding number could not give.
    """

    points: Float[np.ndarray, "n 3"]
    distance: Float[np.ndarray, " n"]
    side: Int8[np.ndarray, " n"]
    slot: Int[np.ndarray, " n"]
    closest: Float[np.ndarray, "n 3"]
    across: Float[np.ndarray, " n"]
    undecided: int = 0

    def __getitem__(self, chosen: np.ndarray) -> Distances:
        at = np.flatnonzero(chosen) if chosen.dtype == bool else chosen
        some = {name: values.take(at, axis=0) for name, values in self._arrays().items()}
        return Distances(**some, undecided=self.undecided)

    def __add__(self, other: Distances) -> Distances:
        more = other._arrays()
        joined = {name: np.concatenate([values, more[name]]) for name, values in self._arrays().items()}
        return Distances(**joined, undecided=self.undecided + other.undecided)

    def _arrays(self) -> dict[str, Any]:
        names = ("points", "distance", "side", "slot", "closest", "across")
        return {name: getattr(self, name) for name in names}

    @property
    def signed(self) -> Float[np.ndarray, " n"]:
        """Signed distance [m]; infinite beyond the limit."""
        return np.asarray(np.where(self.slot >= 0, self.distance, np.inf) * self.side)


@dataclass(frozen=True, eq=False)
class Sampled:
    """One surface prepared for queries against another; all positions about its own centre.

    points (n, 3) are its vertices in the order of `surface.walk`; faces (m, 3) index them and are those that count,
    numbered `index` (m,) in `surface`; across (n,) is the signed distance to the splitting plane; edges (m, 3) are
    lengths opposite to each corner; area, moment, negative are sums over whole faces.
    """

    surface: Surface
    points: Float[np.ndarray, "n 3"]
    faces: Int[np.ndarray, "m 3"]
    index: Int[np.ndarray, " m"]
    across: Float[np.ndarray, " n"]
    edges: Float[np.ndarray, "m 3"]
    area: Float[np.ndarray, " m"]
    moment: Float[np.ndarray, "m 3"]
    negative: Float[np.ndarray, " m"]
    limit: Float[np.ndarray, " n"]
    spheres: Float[np.ndarray, "c 5"]

    @classmethod
    def of(
        cls,
        surface: Surface,
        threshold: float,
        counts: Bool[np.ndarray, " f"] | None = None,
        split: Plane | None = None,
    ) -> Sampled:
        """Lay out `surface` for thresholds up to `threshold` [m]; only faces marked in `counts` contribute area."""
        walk = surface.walk
        place = np.full(len(surface.vertices), -1)
        place[walk] = np.arange(len(walk))
        index = np.arange(len(surface.faces)) if counts is None else np.flatnonzero(counts)
        index = index[(surface.face_area[index] > 0.0) & ~surface.repeated[index]]
        points = np.ascontiguousarray(surface.local[walk])
        faces = np.ascontiguousarray(place[surface.faces[index]])
        across = np.ones(len(walk)) if split is None else split.height(surface.vertices[walk])
        area = _some(surface.face_area, index)
        limit = threshold + surface.reach[walk]
        return cls(
            surface=surface,
            points=points,
            faces=faces,
            index=index,
            across=across,
            edges=_some(surface.edge_length, index),
            area=area,
            moment=area[:, None] * _middle(points, faces),
            negative=area * _negative_share(across[faces]),
            limit=limit,
            spheres=chunk_spheres(points, limit),
        )

    def distances(
        self, other: Surface, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]
    ) -> Distances:
        """Distances to `other` when x_other = rotation x_self + translation (both frames as given by their meshes)."""
        shift = rotation @ self.surface.centre + translation - other.centre
        points = move(self.points, rotation, shift)
        spheres = self.spheres.copy()
        spheres[:, :3] = move(np.ascontiguousarray(self.spheres[:, :3]), rotation, shift)
        return measure(other, points, self.limit, self.across, spheres)


def _some(values: np.ndarray, index: Int[np.ndarray, " m"]) -> np.ndarray:
    """Those of rising numbers, the very array where they are all."""
    return values if len(index) == len(values) else values[index]


def _middle(points: Float[np.ndarray, "n 3"], faces: Int[np.ndarray, "m 3"]) -> Float[np.ndarray, "m 3"]:
    """Middle of each face."""
    a, b, c = (points[corner] for corner in faces.T)
    return np.asarray((a + b + c) / 3.0)


def measure(
    other: Surface,
    points: Float[np.ndarray, "n 3"],
    limit: Float[np.ndarray, " n"],
    across: Float[np.ndarray, " n"] | None = None,
    spheres: Float[np.ndarray, "c 5"] | None = None,
) -> Distances:
    """Distances of points given about the centre of `other`, each up to its own limit [m]."""
    if spheres is None:
        spheres = chunk_spheres(points, limit)
    signed = other.closed and other.normals_trusted
    distance, side, slot, closest = signed_distances(other.tree, points, limit, spheres, signed)
    side, undecided = resolve_inside_outside(other, points, side, distance)
    across = np.ones(len(points)) if across is None else across
    return Distances(points, distance, side, slot, closest, across, undecided)


def _negative_share(across: Float[np.ndarray, "m 3"]) -> Float[np.ndarray, " m"]:
    """Share of each whole face on the negative side of the plane."""
    if (across > 0.0).all():
        return np.zeros(len(across))
    return np.array([fraction_below(a, b, c) for a, b, c in across])
