"""What an analysis writes for 3-D viewers when asked: a time series for ParaView and stills."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.data.version import VERSION
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.surface import Surface
from geocontact.view.surfaces.camera import View
from geocontact.view.surfaces.directions import camera_directions
from geocontact.view.surfaces.scene import ContactScene, ContactSeries, MappedBody
from geocontact.view.surfaces.still import draw_stills
from geocontact.view.surfaces.vtp_series import write_vtp_series

STILL = "still_"


def write_paraview(
    folder: Path,
    moving: Surface,
    fixed: Surface,
    motion: Motion,
    evolution: AreaEvolution,
    maps: DistanceMaps,
    pressures: Mapping[int, Float[np.ndarray, " f"]] | None = None,
) -> None:
    """Write the frames kept in `maps` as .vtp files with .pvd collections; `pressures` [Pa] of FIXED's faces."""
    frames = np.asarray(maps.frames, np.int64)
    pressure = None if pressures is None else np.array([pressures[k] for k in maps.frames])
    series = ContactSeries(
        time=motion.time[frames],
        poses=motion.poses[frames],
        fixed=MappedBody(fixed.vertices, fixed.faces, maps.fixed, pressure),
        moving=MappedBody(moving.vertices, moving.faces, maps.moving),
        thresholds=evolution.thresholds,
        signed=evolution.signed,
        time_unit=motion.time_unit,
    )
    write_vtp_series(series, folder, f"geocontact {VERSION}")


def write_stills(
    folder: Path,
    moving: Surface,
    fixed: Surface,
    motion: Motion,
    evolution: AreaEvolution,
    maps: DistanceMaps,
    title: str,
) -> list[str]:
    """Draw the frame with the largest area from each anatomical direction; returns what has to be said about it."""
    k = maps.largest
    scene = ContactScene(
        fixed_vertices=fixed.vertices,
        fixed_faces=fixed.faces,
        distance=maps.fixed_at_largest,
        moving_vertices=motion.poses[k].apply(moving.vertices),
        moving_faces=moving.faces,
        thresholds=evolution.thresholds,
        time=float(motion.course.values[k]),
        signed=evolution.signed in ("both", "fixed"),
        time_unit=motion.course.unit,
    )
    directions = camera_directions(np.asarray(evolution.split_normal) * evolution.medial_side)
    views = {folder / f"{STILL}{_word(name)}.png": View(name, way) for name, way in directions.items()}
    return list(dict.fromkeys(still.note for still in draw_stills(scene, views, title) if still.note))


def _word(direction: str) -> str:
    """First word of a direction, fit for a file name: "superior (+y)", "−x" to "superior", "minus_x"."""
    return direction.split(maxsplit=1)[0].replace("+", "plus_").replace("−", "minus_")
