"""Frames of a pressure mat as one wrench, one centre and one area per frame, of the whole and of its segments."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Bool, Float

from geocontact.data.wrench import Wrench
from geocontact.loads.mat.map import MatMap
from geocontact.loads.weighted_centre import weighted_centre

AROUND = 0.2  # of the area; cells whose normals add up to less have no side that they look to
AT_ONCE = 500  # frames, for bounded memory
TOUCHED = 1000.0
"""Pa; a cell under less carries its noise only."""


@dataclass(frozen=True, eq=False)
class MatLoad:
    """What a mat's pressure does to the body, over time, in the surface's frame.

    Parameters
    ----------
    wrench
        Force and moment about its origin.
    pressing
        Sum of pressure times sensing area [N], whichever way the cells look; not smaller than the force.
    perpendicular
        Part of the force along the inward mean normal of the interface [N].
    normal
        That mean normal, outwards, unit length; NaN, as `perpendicular` is then, where cells look all ways.
    area
        Of the cells under at least the touching pressure [m^2].
    peak, mean
        Largest pressure, and mean over that area, 0 where nothing touches [Pa].
    centre
        Centre of pressure [m]: cells weighted with pressure times area, NaN below the gate. Where the surface bends it
        lies a little under it.
    """

    wrench: Wrench
    pressing: Float[np.ndarray, " t"]
    perpendicular: Float[np.ndarray, " t"]
    normal: Float[np.ndarray, " 3"]
    area: Float[np.ndarray, " t"]
    peak: Float[np.ndarray, " t"]
    mean: Float[np.ndarray, " t"]
    centre: Float[np.ndarray, "t 3"]


def mat_load(
    placed: MatMap,
    pressure: Float[np.ndarray, "t n"],
    origin: Float[np.ndarray, " 3"],
    frame: str,
    gate: float = 0.0,
    touched: float = TOUCHED,
    cells: Bool[np.ndarray, " n"] | None = None,
) -> MatLoad:
    """Load of pressures [Pa] on the cells of a map.

    Readings below zero, noise of unloaded cells, count in forces and moments; in the centre they have no weight.

    Parameters
    ----------
    origin, frame
        Point that the moment refers to [m], and the name of the surface's frame.
    gate
        Pressing [N] below which there is no centre of pressure.
    touched
        Pressure from which a cell counts as touched [Pa].
    cells
        Which cells count: those of a segment. All without.
    """
    use = np.ones(len(placed.area), bool) if cells is None else cells
    pressure, area = pressure[:, use], placed.area[use]
    if not use.any():
        raise ValueError("a segment needs at least one cell that lies on the surface")
    force = pressure @ placed.force[use]
    moment = pressure @ placed.moment[use] - np.cross(origin, force)
    weight = pressure * area
    pressing = weight.sum(axis=1)
    loaded = (pressing > 0.0) & (pressing >= gate)
    centre = _centres(placed.centre[use], np.maximum(weight, 0.0), loaded)
    on = pressure >= touched
    touched_area = (on * area).sum(axis=1)
    mean = np.divide((on * weight).sum(axis=1), touched_area, out=np.zeros(len(on)), where=touched_area > 0.0)
    normal = _facing(placed.force[use], area)
    at = np.broadcast_to(np.asarray(origin, float), force.shape)
    return MatLoad(
        Wrench(force, moment, at, frame),
        pressing,
        -(force @ normal),
        normal,
        touched_area,
        pressure.max(axis=1, initial=0.0),
        mean,
        centre,
    )


def _facing(force: Float[np.ndarray, "n 3"], area: Float[np.ndarray, " n"]) -> Float[np.ndarray, " 3"]:
    """Mean outward normal; NaN where cells look all ways, as those of a belt do."""
    facing = -force.sum(axis=0)
    size = float(np.linalg.norm(facing))
    return np.asarray(facing / size if size > AROUND * float(area.sum()) else np.full(3, np.nan))


def _centres(
    points: Float[np.ndarray, "n 3"], weight: Float[np.ndarray, "t n"], loaded: Bool[np.ndarray, " t"]
) -> Float[np.ndarray, "t 3"]:
    """Weighted centre of each loaded frame, NaN in the others, a few frames at a time."""
    centre = np.full((len(weight), 3), np.nan)
    for some in np.array_split(np.flatnonzero(loaded), loaded.sum() // AT_ONCE + 1):
        same = np.broadcast_to(points, (len(some), *points.shape))
        centre[some] = weighted_centre(same, weight[some], "centre of pressure")
    return centre


def segment_loads(
    placed: MatMap,
    pressure: Float[np.ndarray, "t n"],
    origin: Float[np.ndarray, " 3"],
    frame: str,
    segments: Mapping[str, Bool[np.ndarray, " n"]],
    gate: float = 0.0,
    touched: float = TOUCHED,
) -> dict[str, MatLoad]:
    """`mat_load` of each segment; together they are the whole where every cell is in one of them."""
    return {name: mat_load(placed, pressure, origin, frame, gate, touched, cells) for name, cells in segments.items()}
