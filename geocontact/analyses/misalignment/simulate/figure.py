"""Displacement surfaces: d_tot over the angle and each offset."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from geocontact.analyses.misalignment.labels import ANGLE
from geocontact.analyses.misalignment.simulate.displacement_surfaces import Surfaces
from geocontact.view.curves.style import BLACK, DOUBLE, empty, in_style

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LEVELS = 13
STRIPES = 31  # of a surface, each way


@in_style
def surface_figure(s: Surfaces) -> Figure:
    """Draw d_tot over angle and x (left) and over angle and y (right), the other offset being 0.

    As surfaces in space above, and as maps with lines of equal d_tot below, where values can be read off.
    """
    figure = empty(DOUBLE, 0.14)
    degrees, offset = np.degrees(s.angle), s.offset * 1e3
    most = float(max(np.abs(s.over_x).max(), np.abs(s.over_y).max())) * 1e3
    colours: dict[str, Any] = {"cmap": "RdBu_r", "vmin": -most, "vmax": most, "rasterized": True}
    maps = []
    for column, (values, name, other) in enumerate(((s.over_x * 1e3, "x", "y"), (s.over_y * 1e3, "y", "x"))):
        space: Any = figure.add_subplot(2, 2, 1 + column, projection="3d")
        space.plot_surface(*np.meshgrid(degrees, offset), values, rcount=STRIPES, ccount=STRIPES, lw=0.1, **colours)
        space.set_zlabel("d_tot [mm]")
        panel = figure.add_subplot(2, 2, 3 + column)
        shown = panel.pcolormesh(degrees, offset, values, shading="gouraud", **colours)
        lines = panel.contour(degrees, offset, values, levels=LEVELS, colors=BLACK, linewidths=0.5)
        panel.clabel(lines, fontsize=6.0, fmt="%g")
        for axes in (space, panel):
            axes.set_ylabel(f"offset {name} [mm]")
        space.set_xlabel("β [°]")
        panel.set_xlabel(ANGLE)
        space.set_title(f"{other} = 0, l = {s.l * 1e3:g} mm, z = {s.z * 1e3:g} mm", fontsize=7.0)
        maps.append(panel)
    figure.colorbar(shown, ax=maps, label="displacement d_tot [mm]")
    return figure
