"""The static figure of a mat: force and pressure over time, and the cells with their largest pressure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.geometry.drape.cells import Drape
from geocontact.loads.mat.load import MatLoad
from geocontact.loads.mat.map import MatMap
from geocontact.view.curves.sheet import sheet
from geocontact.view.extremes import thinned_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure

COLOURS = ("#0072B2", "#D55E00", "#009E73")  # Okabe-Ito: told apart by colour-blind readers


UNTOUCHED = "#c9cdd2"  # of cells without pressure, as of faces on the page


def mat_figure(
    time: Float[np.ndarray, " t"],
    load: MatLoad,
    laid: Drape,
    pressure: Float[np.ndarray, "t n"],
    placed: MatMap,
    largest: float,
) -> Figure:
    """Force with its components, area and largest pressure over time; beside them the largest pressure of each cell.

    `largest` is the upper end of the colours [Pa]: the largest pressure of a face in all frames, as on the page.
    """
    from matplotlib import colormaps
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = sheet(11.0, 6.0)
    FigureCanvasAgg(figure)
    panels = figure.subplot_mosaic([["force", "cells"], ["peak", "cells"], ["area", "cells"]], width_ratios=[3, 2])
    for k, axis in enumerate("xyz"):
        panels["force"].plot(*thinned_line(time, load.wrench.force[:, k]), color=COLOURS[k], label=axis)
    panels["force"].plot(*thinned_line(time, load.perpendicular), color="black", label="perpendicular to the interface")
    panels["force"].axhline(0.0, color="grey", lw=0.6)
    panels["force"].legend(fontsize=8, frameon=False, ncols=2)
    panels["peak"].plot(*thinned_line(time, load.peak * 1e-3), color="black", label="largest")
    panels["peak"].plot(*thinned_line(time, load.mean * 1e-3), color="grey", label="mean where it touches")
    panels["peak"].legend(fontsize=8, frameon=False)
    panels["area"].plot(*thinned_line(time, load.area * 1e4), color="black")
    grid = np.full(laid.area.shape, np.nan)
    grid[placed.cell[:, 0], placed.cell[:, 1]] = pressure.max(axis=0) * 1e-3
    grid[grid == 0.0] = -1.0
    colours = colormaps["inferno_r"].with_extremes(under=UNTOUCHED)
    image = panels["cells"].imshow(grid, cmap=colours, vmin=0.0, vmax=largest * 1e-3 or 1.0)
    figure.colorbar(image, ax=panels["cells"], label="largest pressure [kPa]", shrink=0.8)
    panels["cells"].set_xlabel("column")
    panels["cells"].set_ylabel("row")
    for name, label in (("force", "force on the body [N]"), ("peak", "pressure [kPa]"), ("area", "area [cm²]")):
        panels[name].set_ylabel(label)
    panels["area"].set_xlabel("time [s]")
    return figure
