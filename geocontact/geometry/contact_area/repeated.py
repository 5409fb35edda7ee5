"""The clipped area again and again: many poses of one surface in the field of another that is prepared once.

The area is that of the rule `clip` to rounding; only vertices near the threshold are searched for, a grid certifies the
rest (`kernels.cells`). The derivative to the pose comes with it, exact for the clip: the share of a cut triangle has a
closed derivative to its corners' distances, and a corner's distance changes with its pose along the direction to its
nearest point (the distance is a minimum, so the nearest point's own motion does not count).
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.geometry.contact_area.area import areas_cut_once
from geocontact.geometry.contact_area.sampled import Sampled
from geocontact.geometry.kernels.cells import BEYOND, OPEN, WITHIN, Cells, divided, measured_cells
from geocontact.geometry.kernels.repeated import ON_IT, areas_at, corner_slopes, face_chunks
from geocontact.geometry.kernels.triangle import LEAF
from geocontact.geometry.surface import Surface

FINE = 4  # fine cells along a coarse one
CELLS = 40_000  # coarse cells at most: a threshold that is small against the body has larger cells
SHARE = 0.3  # edge of a fine cell over the root of threshold times edge: the slack is then a small share of the edge
BATCH = 16  # poses that a thread does in one go


@dataclass(frozen=True, eq=False)
class ClippedAreas:
    """Area within the threshold at each pose, and its derivative.

    area (t,) [m^2]; slope (t, 6): to a shift [m] and a small turn [rad] of the measured surface in the other one's
    axes, the turn about that one's origin.
    """

    area: Float[np.ndarray, " t"]
    slope: Float[np.ndarray, "t 6"]


class RepeatedArea:
    """Area of one surface within a threshold of another, at as many poses as wanted.

    Parameters
    ----------
    measured
        The surface whose area is wanted.
    other
        The one whose distance counts; signed where it is closed.
    threshold
        Largest signed distance that counts [m], above 0.
    counts
        Marks the faces of `measured` that count; None for all.
    """

    def __init__(
        self, measured: Surface, other: Surface, threshold: float, counts: Bool[np.ndarray, " f"] | None = None
    ) -> None:
        self.measured, self.other, self.threshold = measured, other, threshold
        self._sampled = Sampled.of(measured, threshold, counts)
        order, self._start = _by_leaf(self._sampled)
        self._faces = np.ascontiguousarray(self._sampled.faces[order])
        self._area = np.ascontiguousarray(self._sampled.area[order])
        self._chunks = face_chunks(self._sampled.points, self._faces, self._area, self._start)
        edge = float(np.median(self._sampled.edges))
        # sides that only winding numbers give cannot stand in a grid: every pose is searched for as a whole then
        gridded = not other.closed or other.normals_trusted
        self._cells = grid_around(other, threshold, SHARE * float(np.sqrt(threshold * edge))) if gridded else None

    def at(
        self, rotation: Float[np.ndarray, "t 3 3"], translation: Float[np.ndarray, "t 3"], workers: int | None = None
    ) -> ClippedAreas:
        """Area and derivative at x_other = rotation x_measured + translation [m], whatever the number of threads."""
        parts = [slice(k, k + BATCH) for k in range(0, len(rotation), BATCH)]
        with ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
            found = list(pool.map(lambda part: self._some(rotation[part], translation[part]), parts))
        return ClippedAreas(np.concatenate([a for a, _ in found]), np.concatenate([s for _, s in found]))

    def _some(
        self, rotation: Float[np.ndarray, "t 3 3"], translation: Float[np.ndarray, "t 3"]
    ) -> tuple[Float[np.ndarray, " t"], Float[np.ndarray, "t 6"]]:
        rotation = np.ascontiguousarray(rotation)
        if self._cells is None:
            area, slope = np.zeros(len(rotation)), np.zeros((len(rotation), 6))
            searched = np.arange(len(rotation))
        else:
            shift = rotation @ self.measured.centre + translation - self.other.centre
            area, slope, doubt = areas_at(
                self.other.tree, self._cells, self._sampled.points, self._faces, self._area, self._start,
                self._chunks, self.threshold, self.other.closed, rotation, shift,
            )  # fmt: skip
            searched = np.flatnonzero(doubt)
        for k in searched:
            area[k], slope[k] = self._searched(rotation[k], translation[k])
        slope[:, 3:] += np.cross(self.other.centre, slope[:, :3])
        return area, slope

    def _searched(
        self, rotation: Float[np.ndarray, "3 3"], translation: Float[np.ndarray, " 3"]
    ) -> tuple[float, Float[np.ndarray, " 6"]]:
        """One pose without the grid, sides from winding numbers where normals give none."""
        sampled, d = self._sampled, self._sampled.distances(self.other, rotation, translation)
        value = d.side * d.distance
        weight = corner_slopes(sampled.faces, value - self.threshold, sampled.area, len(value))
        used = np.flatnonzero((weight != 0.0) & (np.abs(value) > ON_IT))
        unit = (d.points[used] - d.closest[used]) / value[used, None]
        pull = weight[used, None] * unit
        slope = np.concatenate([pull.sum(axis=0), np.cross(d.points[used], pull).sum(axis=0)])
        return float(areas_cut_once(sampled, d, (self.threshold,))[0]), slope


def grid_around(surface: Surface, threshold: float, fine: float) -> Cells:
    """The cells around a surface, fine ones of about the edge given [m] where the threshold passes."""
    tree, signed = surface.tree, surface.closed
    reach = threshold * (1.0 + 1e-9)
    size = tree.root[3:] - tree.root[:3] + 2.0 * reach
    coarse = max(FINE * fine, float(np.cbrt(np.prod(size) / CELLS)))
    count = np.maximum(np.ceil(size / coarse), 1).astype(np.int64)
    low = 0.5 * (tree.root[3:] + tree.root[:3]) - 0.5 * count * coarse
    near, place, side, span = measured_cells(tree, low, coarse, count, signed)
    state = np.full(len(side), OPEN)
    off = (span[:, 0] > threshold) & (side != 0)
    state[off] = np.where(side[off] > 0, BEYOND, WITHIN)
    state[span[:, 1] <= threshold] = WITHIN
    opened = np.flatnonzero(state == OPEN)
    block = np.full(len(side), -1)
    block[opened] = np.arange(len(opened))
    inner = divided(tree, low, coarse, count, FINE, opened, signed)
    return Cells(
        low, count, coarse, coarse / FINE, FINE, state, block, len(opened) * FINE**3,
        *(np.concatenate([a, b]) for a, b in zip(inner, (near, place, side), strict=True)),
    )  # fmt: skip


def _by_leaf(sampled: Sampled) -> tuple[Int[np.ndarray, " m"], Int[np.ndarray, " c"]]:
    """Order of the counted faces by leaves of their tree, and where each leaf starts in it (and the last one ends)."""
    tree = sampled.surface.tree
    place = np.empty(len(tree.face), np.int64)
    for leaf, filled in enumerate(tree.fill):
        place[tree.slots[leaf * LEAF : leaf * LEAF + filled]] = leaf * LEAF + np.arange(filled)
    along = np.empty(len(place), np.int64)
    along[tree.face] = place
    order = np.argsort(along[sampled.index])
    leaf = along[sampled.index[order]] // LEAF
    return order, np.append(np.flatnonzero(np.diff(leaf, prepend=-1)), len(order))
