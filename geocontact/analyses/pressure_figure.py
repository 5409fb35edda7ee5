"""The static figure of an elastic foundation: force and peak over the motion, pressures at the largest force."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.motion import Course
from geocontact.view.curves.quantity import FORCE, PRESSURE
from geocontact.view.curves.sheet import plain, sheet
from geocontact.view.curves.style import DOUBLE, INCH, LINES, PALETTE, in_style, legend

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


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
    figure = sheet(DOUBLE / INCH, 0.09 / INCH)
    axes = figure.subplot_mosaic([["force", "map"], ["peak", "map"]], width_ratios=[3, 2])
    drawn = [
        (axes["force"].plot(course.values, values, color=PALETTE[k], ls=LINES[k])[0], name)
        for k, (name, values) in enumerate(force.items())
    ]
    axes["force"].set_ylabel(FORCE.label)
    legend(axes["force"], drawn)
    axes["peak"].plot(course.values, PRESSURE.shown(peak), color="black")
    axes["peak"].set_ylabel(plain("largest contact pressure [MPa]", 20))
    axes["peak"].set_xlabel(plain(course.label))
    for panel in ("force", "peak"):
        axes[panel].set_ylim(bottom=0.0)
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
