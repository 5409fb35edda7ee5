"""What an analysis writes for 3-D viewers when asked: a time series for ParaView and stills."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geocontact.analyses.area.motion_result import MotionResult
from geocontact.analyses.area.read import Bodies
from geocontact.data.version import VERSION
from geocontact.view.surfaces.camera import View
from geocontact.view.surfaces.directions import camera_directions
from geocontact.view.surfaces.scene import ContactScene, ContactSeries, MappedBody
from geocontact.view.surfaces.still import draw_stills
from geocontact.view.surfaces.vtp_series import write_vtp_series

STILL = "still_"


def write_paraview(folder: Path, bodies: Bodies, one: MotionResult) -> None:
    """Write the frames whose distances are kept as .vtp files with .pvd collections, pressures of FIXED's faces too."""
    kept, e, motion = one.maps.frames, one.evolution, one.motion
    frames = np.asarray(kept, np.int64)
    pressure = None if one.pressure is None else np.array([one.pressure.maps[k] for k in kept])
    series = ContactSeries(
        time=motion.time[frames],
        poses=motion.poses[frames],
        fixed=MappedBody(bodies.fixed.vertices, bodies.fixed.faces, one.maps.fixed, pressure),
        moving=MappedBody(bodies.moving.vertices, bodies.moving.faces, one.maps.moving),
        thresholds=e.thresholds,
        signed=e.signed,
        time_unit=motion.time_unit,
    )
    write_vtp_series(series, folder, f"geocontact {VERSION}")


def write_stills(folder: Path, bodies: Bodies, one: MotionResult, title: str) -> list[str]:
    """Draw the frame with the largest area from each side; returns what has to be said about it."""
    k, evolution, motion = one.maps.largest, one.evolution, one.motion
    scene = ContactScene(
        fixed_vertices=bodies.fixed.vertices,
        fixed_faces=bodies.fixed.faces,
        distance=one.maps.fixed_at_largest,
        moving_vertices=motion.poses[k].apply(bodies.moving.vertices),
        moving_faces=bodies.moving.faces,
        thresholds=evolution.thresholds,
        time=float(motion.course.values[k]),
        signed=evolution.signed in ("both", "fixed"),
        time_unit=motion.course.unit,
    )
    directions = camera_directions(np.asarray(evolution.split_normal) * evolution.medial_side)
    views = {folder / f"{STILL}{_word(name)}.png": View(name, way) for name, way in directions.items()}
    return list(dict.fromkeys(still.note for still in draw_stills(scene, views, title) if still.note))


def _word(direction: str) -> str:
    """First word of a direction, fit for a file name: "medial (+z)", "−x" to "medial", "minus_x"."""
    return direction.split(maxsplit=1)[0].replace("+", "plus_").replace("−", "minus_")
