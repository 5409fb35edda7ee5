"""Contact pressures and their resultants as files and figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.motion import Course
from geocontact.io.opensim.external_loads import write_external_loads
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.loads.pressure_load import PressureLoad
from geocontact.view.curves.declared import INK, Curve, Curves
from geocontact.view.curves.drawn import draw_on
from geocontact.view.curves.quantity import PRESSURE
from geocontact.view.curves.sheet import plain
from geocontact.view.curves.style import DOUBLE, empty, in_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


CONTACT_LOADS = "contact_loads"
"""Name of both files, without ending."""


def write_contact_loads(
    folder: Path,
    time: Float[np.ndarray, " t"],
    loads: Mapping[str, Sequence[PressureLoad]],
    moving_body: str,
    fixed_body: str,
) -> None:
    """contact_loads.mot and .xml: force of each compartment on FIXED at its centre of pressure, and back on MOVING.

    Forces, points and torques are expressed in FIXED's body, so that they hold in any motion of the model. The torque
    is what the pressures turn about their centre; where nothing presses all are 0 at the body's origin.

    Parameters
    ----------
    loads
        Load on FIXED in its body's frame at each time, by compartment.
    moving_body, fixed_body
        Names of the bodies in the model.
    """
    names: list[str] = []
    columns, bodies = [], {}
    for side, over_time in loads.items():
        force = np.array([load.wrench.force for load in over_time])
        moment = np.array([load.wrench.moment for load in over_time])
        centre = np.nan_to_num(np.array([load.centre for load in over_time]))
        torque = moment - np.cross(centre, force)
        for stem, body, sign in ((f"contact_{side}", fixed_body, 1.0), (f"contact_back_{side}", moving_body, -1.0)):
            names += [f"{stem}_force_{kind}{axis}" for kind in "vp" for axis in "xyz"]
            names += [f"{stem}_torque_{axis}" for axis in "xyz"]
            columns += [sign * force, centre, sign * torque]
            bodies[f"{stem}_force"] = body
    data, title = f"{CONTACT_LOADS}.mot", f"Contact forces between {moving_body} and {fixed_body}"
    write_storage(folder / data, time, names, np.hstack(columns), title=title, degrees=False)
    write_external_loads(folder / f"{CONTACT_LOADS}.xml", data, bodies, torques=True, frame=fixed_body)


@dataclass(frozen=True, eq=False)
class PressureMap:
    """FIXED [m], the pressure of its faces [Pa] at one frame, and the way of the centre of pressure [m].

    `largest` is the upper end of the colours [Pa]: the largest pressure of a face in all frames, as on the page.
    """

    vertices: Float[np.ndarray, "n 3"]
    faces: Int[np.ndarray, "m 3"]
    pressure: Float[np.ndarray, " m"]
    centre: Float[np.ndarray, "t 3"]
    frame: int
    largest: float


@in_style
def pressure_figure(
    course: Course,
    force: Mapping[str, Float[np.ndarray, " t"]],
    peak: Float[np.ndarray, " t"],
    shown: PressureMap,
) -> Figure:
    """Force of the whole and of compartments [N], largest pressure [Pa], and the map of one frame."""
    figure = empty(DOUBLE, 0.1)
    axes = figure.subplot_mosaic([["force", "map"], ["peak", "map"]], width_ratios=[3, 2])
    forces = Curves("Contact force", "N", [Curve(name, values) for name, values in force.items()])
    largest = Curves(
        "Largest contact pressure", "MPa", [Curve("largest contact pressure", PRESSURE.shown(peak), stroke=INK)]
    )
    for name, panel in (("force", forces), ("peak", largest)):
        draw_on(axes[name], panel, course)
        axes[name].set_ylim(bottom=0.0)
    _map(axes["map"], shown)
    axes["map"].set_title(plain(f"FIXED at {course.at(shown.frame)}"))
    return figure


def _map(axes: Axes, shown: PressureMap) -> None:
    """FIXED seen against the load, coloured where it is pressed; the way of the centre of pressure in black."""
    from matplotlib.tri import Triangulation

    corners = shown.vertices[shown.faces] * 1e3
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    loaded = shown.pressure > 0.0
    view = normal[loaded].sum(axis=0) if loaded.any() else np.array([0.0, 1.0, 0.0])
    axis = int(np.argmax(np.abs(view)))
    sign = 1.0 if view[axis] >= 0.0 else -1.0
    right, up = ((1, 2), (2, 0), (0, 1))[axis]
    visible = np.flatnonzero(normal[:, axis] * sign > 0.0)
    order = visible[np.argsort(corners[visible][:, :, axis].mean(axis=1) * sign, kind="stable")]
    x, y = shown.vertices[:, right] * 1e3, shown.vertices[:, up] * 1e3
    values = np.where(loaded[order], PRESSURE.shown(shown.pressure[order]), np.nan)
    grey = Triangulation(x, y, shown.faces[order])
    axes.tripcolor(grey, facecolors=np.full(len(order), 0.85), cmap="Greys_r", vmin=0.0, vmax=1.0, rasterized=True)
    if loaded[order].any():
        pressed = np.isfinite(values)
        loaded_faces = Triangulation(x, y, shown.faces[order[pressed]])
        most = float(PRESSURE.shown(np.array(shown.largest)))
        colours = axes.tripcolor(
            loaded_faces, facecolors=values[pressed], cmap="inferno_r", vmin=0.0, vmax=most, rasterized=True
        )
        axes.figure.colorbar(colours, ax=axes, label=PRESSURE.label, shrink=0.7)
    axes.plot(shown.centre[:, right] * 1e3, shown.centre[:, up] * 1e3, color="black", lw=0.8)
    axes.set_aspect("equal")
    axes.set_xlabel(f"{'xyz'[right]} [mm]")
    axes.set_ylabel(f"{'xyz'[up]} [mm]")
