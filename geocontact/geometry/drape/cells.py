"""What became of the cells of a mat on a surface: where, how large, how far from what they were, whether folded."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float
from scipy.spatial import cKDTree

from geocontact.geometry.drape.mat import Mat
from geocontact.geometry.drape.spread import Geodesics, Joins, SurfacePoints

APART = 0.5  # of the smaller pitch: centres nearer to each other belong to cells that lie on one another


@dataclass(frozen=True, eq=False)
class Drape:
    """A mat on a surface, in the surface's frame. NaN where a cell is not covered.

    Parameters
    ----------
    nodes
        Corners of the cells [m].
    centre
        Of each cell, on the surface [m].
    normal
        Outward unit normal of each cell: the direction of its vector area, against which a uniform pressure pushes.
    area
        Of the surface under each cell [m^2].
    covered
        Cells that lie on the surface with all four corners.
    distortion
        Area over that of the flat cell, minus 1.
    stretch
        Mean length of the two sides along rows and of those along columns, over the pitch, minus 1.
    folded
        Cells that are turned over or lie on another cell.
    misses
        Distance of each mark from its point [m]; empty without marks.
    """

    nodes: Float[np.ndarray, "r1 c1 3"]
    centre: Float[np.ndarray, "r c 3"]
    normal: Float[np.ndarray, "r c 3"]
    area: Float[np.ndarray, "r c"]
    covered: Bool[np.ndarray, "r c"]
    distortion: Float[np.ndarray, "r c"]
    stretch: Float[np.ndarray, "r c 2"]
    folded: Bool[np.ndarray, "r c"]
    misses: Float[np.ndarray, " k"]

    @property
    def bulge(self) -> float:
        """Mean cosine between normals and directions from the middle: 1 on a ball, 0 on a plane, -1 inside a ball.

        Cells count with their distance from the middle. Below zero, the surface is hollow under the mat or its faces
        look into the body.
        """
        inside = self.covered
        centre = self.centre[inside]
        arm = centre - centre.mean(axis=0)
        size = float(np.linalg.norm(arm, axis=-1).sum())
        return float(np.einsum("ij,ij->", arm, self.normal[inside])) / size if size > 0.0 else 0.0

    def distortion_of(self, cells: Bool[np.ndarray, "r c"]) -> tuple[float, float]:
        """Largest and root mean square size of `distortion` over covered cells among `cells`; NaN without any."""
        known = self.distortion[self.covered & cells]
        if not known.size:
            return float("nan"), float("nan")
        return float(np.abs(known).max()), float(np.sqrt(np.mean(known**2)))

    @property
    def area_vector(self) -> Float[np.ndarray, "r c 3"]:
        """Vector area of each cell [m^2]: half the cross product of its diagonals, shorter than `area` on a curve."""
        return np.asarray(_vector_area(self.nodes) * np.sign(_dot(_vector_area(self.nodes), self.normal))[..., None])


def measured(
    geodesics: Geodesics, mat: Mat, nodes: SurfacePoints, misses: Float[np.ndarray, " k"] | None = None
) -> Drape:
    """The drape with these corners.

    A cell's area is that of the two triangles into which a diagonal of straightest lines parts it, the mean of both
    ways. A triangle with sides a, b, c over a surface on which its angles exceed pi by e (Gauss-Bonnet) has the area of
    the flat one with the same sides plus e (a^2 + b^2 + c^2) / 24 (Gauss 1828, sec. 26-28): exact where the surface can
    be laid flat, with an error of the sixth power of the sides elsewhere.
    """
    corners = [SurfacePoints(nodes.face[a, b].ravel(), nodes.point[a, b].reshape(-1, 3)) for a, b in CORNERS]
    covered = np.logical_and.reduce([corner.on for corner in corners])
    joins = {pair: geodesics.joined(corners[pair[0]], corners[pair[1]]) for pair in PAIRS}
    area = np.where(covered, _area(joins, [corner.point for corner in corners]), np.nan)
    diagonals = [geodesics.moved(corners[a], 0.5 * _shift(joins[a, b])) for a, b in ((0, 2), (1, 3))]
    middle = 0.5 * (diagonals[0].point + diagonals[1].point)
    plain = np.mean([corner.point for corner in corners], axis=0)
    middle = np.where(np.isfinite(middle), middle, plain)
    centre = np.full_like(middle, np.nan)
    outside = np.full_like(middle, np.nan)
    if covered.any():
        places = geodesics.nearest(middle[covered])
        centre[covered], outside[covered] = places.point, geodesics.normal(places)
    shape = (mat.rows, mat.columns)
    vector = mat.hand * _vector_area(nodes.point).reshape(-1, 3)
    facing = _dot(vector, outside)
    with np.errstate(invalid="ignore", divide="ignore"):
        normal = vector * np.sign(facing)[:, None] / np.linalg.norm(vector, axis=1, keepdims=True)
    sides = np.stack([0.5 * (joins[0, 1].length + joins[3, 2].length), 0.5 * (joins[0, 3].length + joins[1, 2].length)])
    folded = covered & ((facing < 0.0) | _on_another(centre, APART * min(mat.pitch)))
    return Drape(
        nodes.point,
        centre.reshape(*shape, 3),
        np.where(covered[:, None], normal, np.nan).reshape(*shape, 3),
        area.reshape(shape),
        covered.reshape(shape),
        area.reshape(shape) / mat.cell_area - 1.0,
        np.where(covered, sides / np.array(mat.pitch)[:, None] - 1.0, np.nan).T.reshape(*shape, 2),
        folded.reshape(shape),
        np.zeros(0) if misses is None else misses,
    )


_LOW, _HIGH = slice(None, -1), slice(1, None)
CORNERS = ((_LOW, _LOW), (_HIGH, _LOW), (_HIGH, _HIGH), (_LOW, _HIGH))
"""Corners of each cell, in the order first, next row, opposite, next column: once around."""
PAIRS = ((0, 1), (1, 2), (3, 2), (0, 3), (0, 2), (1, 3))
"""Sides and diagonals of a cell, by its corners."""


def _dot(a: Float[np.ndarray, "*n 3"], b: Float[np.ndarray, "*n 3"]) -> Float[np.ndarray, "*n"]:
    return np.asarray((a * b).sum(axis=-1))


def _shift(join: Joins) -> Float[np.ndarray, "n 3"]:
    return np.asarray(np.nan_to_num(join.length[:, None] * join.leaving))


def _vector_area(nodes: Float[np.ndarray, "r1 c1 3"]) -> Float[np.ndarray, "r c 3"]:
    """Half the cross product of the diagonals: that of any surface with this outline of four chords."""
    a, b, c, d = (nodes[corner] for corner in CORNERS)
    return np.asarray(0.5 * np.cross(c - a, d - b))


def _area(joins: dict[tuple[int, int], Joins], points: list[Float[np.ndarray, "n 3"]]) -> Float[np.ndarray, " n"]:
    """Mean of both partings of each cell; plain chords where a straightest line was not found."""
    length = {pair: join.length for pair, join in joins.items()}
    angles = [_angle(_towards(joins, k, (k + 1) % 4), _towards(joins, k, (k + 3) % 4)) for k in range(4)]
    excess = np.sum(angles, axis=0) - 2.0 * np.pi
    partings = []
    for a, b in ((0, 2), (1, 3)):
        whole = np.zeros(len(excess))
        for other in {0, 1, 2, 3} - {a, b}:
            sides = [length[tuple(p)] for p in PAIRS if set(p) <= {a, b, other}]  # type: ignore[index]
            whole = whole + heron(*sides) + excess / 48.0 * np.sum(np.square(sides), axis=0)
        partings.append(whole)
    found = 0.5 * (partings[0] + partings[1])
    chords = [np.linalg.norm(points[b] - points[a], axis=1) for a, b in PAIRS]
    coarse = heron(chords[0], chords[1], chords[4]) + heron(chords[2], chords[3], chords[4])
    return np.asarray(np.where(np.isfinite(found), found, coarse))


def _towards(joins: dict[tuple[int, int], Joins], k: int, other: int) -> Float[np.ndarray, "n 3"]:
    """Unit direction at corner k of a side towards another corner."""
    return joins[k, other].leaving if (k, other) in joins else -joins[other, k].arriving


def _angle(a: Float[np.ndarray, "n 3"], b: Float[np.ndarray, "n 3"]) -> Float[np.ndarray, " n"]:
    """Between unit vectors [rad]."""
    return np.asarray(np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), _dot(a, b)))


def heron(
    a: Float[np.ndarray, " n"], b: Float[np.ndarray, " n"], c: Float[np.ndarray, " n"]
) -> Float[np.ndarray, " n"]:
    """Area of flat triangles by their sides, in the order that keeps its digits (Kahan 2014, Miscalculating area)."""
    z, y, x = np.sort(np.stack([a, b, c]), axis=0)
    square = (x + (y + z)) * (z - (x - y)) * (z + (x - y)) * (x + (y - z))
    return np.asarray(0.25 * np.sqrt(np.maximum(square, 0.0)))


def _on_another(centre: Float[np.ndarray, "n 3"], near: float) -> Bool[np.ndarray, " n"]:
    """Cells whose centre is nearer than `near` [m] to another one."""
    found = np.zeros(len(centre), bool)
    there = np.flatnonzero(np.isfinite(centre).all(axis=1))
    if len(there):
        pairs = cKDTree(centre[there]).query_pairs(near, output_type="ndarray")
        found[there[pairs.ravel()]] = True
    return found
