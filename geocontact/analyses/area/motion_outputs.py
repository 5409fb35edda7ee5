"""What one motion is shown as and written to: figures, page, maps, series for ParaView, stills, loads for OpenSim."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geocontact.analyses.area.bodies import Bodies
from geocontact.analyses.area.contact import MotionResult
from geocontact.analyses.area.distance_file import FILE, write_maps
from geocontact.analyses.area.export_model import EXPORT
from geocontact.analyses.area.exports import write_exports
from geocontact.analyses.area.figure import area_figure, colour_span, write_paraview, write_stills
from geocontact.analyses.area.options import AreaOptions
from geocontact.analyses.area.page import thinned_page
from geocontact.analyses.area.pressure_page import shown_pressures
from geocontact.analyses.frame.contact_pressures import PressureMap, pressure_figure, write_contact_loads
from geocontact.analyses.frame.pages import Thinned
from geocontact.geometry.contact_area.comparison import Compared
from geocontact.geometry.contact_area.pose_error import AreaUncertainty
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.pose_draws import POSE_DRAWS, PoseDraws
from geocontact.loads.pressure_evolution import PressureEvolution

if TYPE_CHECKING:
    from matplotlib.figure import Figure

PARAVIEW = "paraview"
"""Folder of the series for ParaView."""

PRESSURE_MAPS = "pressure.npz"


def write_further(o: AreaOptions, bodies: Bodies, one: MotionResult, folder: Path) -> list[str]:
    """What was asked for beside tables, figures and page of one motion, into its folder; what is to be said of it."""
    folder.mkdir(exist_ok=True)
    if one.pressure is not None and o.bodies is not None:
        loads = one.pressure.parts or {"total": one.pressure.loads}
        write_contact_loads(folder, one.motion.time, loads, *o.bodies)
    if one.uncertainty is not None:
        _write_draws(one, one.uncertainty, folder / POSE_DRAWS)
    _write_maps(o, bodies, one, folder)
    notes = [] if o.export is None else write_exports(o, o.export, bodies, one, folder / EXPORT)
    return notes + (write_stills(folder, bodies, one, heading(bodies, one)) if o.stills else [])


def _write_draws(one: MotionResult, u: AreaUncertainty, file: Path) -> None:
    thresholds = np.asarray(one.evolution.thresholds)
    areas = np.stack([u.drawn(k) for k in range(len(thresholds))], axis=1)
    PoseDraws(one.motion.time, thresholds, areas).written(file)


def heading(bodies: Bodies, one: MotionResult) -> str:
    """Title of figures and page."""
    return bodies.title + (f", {one.name}" if one.name else "")


def figure_of(bodies: Bodies, one: MotionResult) -> Figure:
    """Areas and separation over the motion, and FIXED in the frame with the largest area."""
    fixed, maps = bodies.fixed, one.maps
    return area_figure(
        one.evolution,
        fixed.vertices,
        fixed.faces,
        maps.fixed_at_largest,
        maps.largest,
        heading(bodies, one),
        one.motion.course,
        colour_span(one.evolution),
    )


def pressure_figure_of(bodies: Bodies, one: MotionResult, e: PressureEvolution) -> Figure:
    """Force and largest pressure over the motion, and FIXED in the frame with the largest force."""
    force = {side: np.array([load.pressing for load in loads]) for side, loads in e.sides.items()}
    peak, centre = (np.array([getattr(load, name) for load in e.loads]) for name in ("peak", "centre"))
    at = PressureMap(
        bodies.fixed.vertices, bodies.fixed.faces, e.maps[e.heaviest], centre, e.heaviest, float(e.pressure.max())
    )
    return pressure_figure(one.motion.course, force, peak, at)


def _write_maps(o: AreaOptions, bodies: Bodies, one: MotionResult, folder: Path) -> None:
    if o.save_map:
        write_maps(folder / FILE, bodies.moving, bodies.fixed, one.motion, one.evolution, one.maps)
        if one.pressure is not None:
            _write_pressure_maps(folder / PRESSURE_MAPS, bodies.fixed, one, one.pressure)
    if o.paraview:
        write_paraview(folder / PARAVIEW, bodies, one)


def _write_pressure_maps(file: Path, fixed: Surface, one: MotionResult, e: PressureEvolution) -> None:
    np.savez_compressed(
        file,
        allow_pickle=False,
        frames=np.array(e.frames),
        time=one.motion.time[e.frames],
        pressure=e.pressure,
        vertices=fixed.vertices,
        faces=fixed.faces,
    )


def page_of(bodies: Bodies, one: MotionResult) -> Thinned:
    """The page of one motion."""
    reference, compared = bodies.reference, None
    if one.comparison is not None and reference is not None:
        compared = Compared(one.comparison, reference.tolerance)
    return thinned_page(
        bodies.moving,
        bodies.fixed,
        one.motion,
        bodies.settings,
        one.evolution,
        one.maps,
        heading(bodies, one),
        None if one.pressure is None else shown_pressures(one.pressure, bodies.fixed),
        compared,
        one.uncertainty,
        one.congruence,
        one.published,
        one.wear,
    )
