"""Static figures of a centre of pressure: forces, centre, free moment and path over time, and the stances."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.analyses.cop.loads import MM, NAMES, SHARE, FootLoads, loads_table, stance_table, stances
from geocontact.data.motion import Course
from geocontact.view.curves.declared import Curve, Curves, CurveSheet, mean_curve
from geocontact.view.curves.drawn import draw_on
from geocontact.view.curves.style import DOUBLE, GREY, empty, in_style
from geocontact.view.extremes import FRAMES, with_extremes

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ROWS = 3  # of panels beside the path
DOTS = 10 * FRAMES  # of a path; of more, the outermost of each stretch are drawn


@in_style
def cop_figure(
    sheet: CurveSheet,
    time: Float[np.ndarray, " t"],
    centre: Float[np.ndarray, "t 3"],
    normal: Float[np.ndarray, " 3"] | None,
) -> Figure:
    """Forces, centre and free moment over time, and the path.

    Parameters
    ----------
    sheet
        Curves over time.
    centre
        Centre of pressure [m], NaN where there is none.
    normal
        Mean normal of the ground, None without a centre: the path is seen along the axis nearest to it.
    """
    up = 1 if normal is None else int(np.argmax(np.abs(normal)))
    right, ahead = ((2, 1), (2, 0), (0, 1))[up]
    columns = -(-len(sheet.panels) // ROWS)
    figure = empty((columns + 1) * 0.45 * DOUBLE, 0.055 * ROWS)
    grid = figure.add_gridspec(ROWS, columns + 1)
    for k, panel in enumerate(sheet.panels):
        draw_on(figure.add_subplot(grid[k % ROWS, k // ROWS]), panel, sheet.over)
    path = figure.add_subplot(grid[:, -1])
    _path(path, time, centre, right, ahead)
    path.set_title(f"Centre of pressure seen along {'xyz'[up]}", loc="left")
    return figure


def _path(axes: Axes, time: Float[np.ndarray, " t"], centre: Float[np.ndarray, "t 3"], right: int, ahead: int) -> None:
    found = np.flatnonzero(np.isfinite(centre[:, 0]))
    found = found[with_extremes(len(found), [centre[found, k] for k in (right, ahead)], DOTS)]
    axes.set_xlabel(f"{'xyz'[right]} [mm]")
    axes.set_ylabel(f"{'xyz'[ahead]} [mm]")
    if not len(found):
        axes.text(0.5, 0.5, "no centre of pressure", ha="center", va="center", transform=axes.transAxes)
        return
    x, y = centre[found, right] * MM, centre[found, ahead] * MM
    axes.plot(x, y, color=GREY, lw=0.8, zorder=1)
    dots = axes.scatter(x, y, c=time[found], s=9, cmap="viridis", zorder=2)
    axes.figure.colorbar(dots, ax=axes, label="time [s]", shrink=0.7)
    axes.set_aspect("equal", adjustable="datalim")


PERCENT = 100.0
STANCES = (
    "Every complete stance as a thin line and their mean, from where the normal force reaches the gate until it falls "
    "below: 0 to 100 % of its own duration. stances.csv has the values."
)


def stance_curves(r: FootLoads) -> list[Curves]:
    """Normal force, and the centre along the foot where that is known, over the stance; none without a stance."""
    if not r.options.stances or not stances(r):
        return []
    table = stance_table(r, loads_table(r))
    each = [one for _, one in table.groupby("stance [-]")]
    panels = [("normal [N]", "Normal force over the stance", "N", 1.0)]
    if r.axis is not None:
        along = f"{NAMES[r.options.point]}{SHARE}"
        panels.append((along, "Centre from the heel over the stance", "% of foot length", PERCENT))
    found: list[Curves] = []
    for name, title, unit, factor in panels:
        trials = factor * np.array([one[name].to_numpy(float) for one in each])
        curves = [Curve(f"stance {k + 1}", one, stroke=0, thin=True) for k, one in enumerate(trials)]
        mean = [mean_curve("stances", trials, 0)] if np.isfinite(trials).any() else []
        over = Course("stance", "%", each[0]["cycle [%]"].to_numpy(float))
        found.append(Curves(title, unit, [*mean, *curves], over=over, words="" if found else STANCES))
    return found
