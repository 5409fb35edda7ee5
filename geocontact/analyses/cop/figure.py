"""Static figures of a centre of pressure: forces, centre, free moment and path over time, and the stances."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.analyses.cop.loads import NAMES, SHARE, FootLoads, loads_table, stance_table, stances
from geocontact.analyses.frame.pages import drawing
from geocontact.view.curves.sheet import sheet
from geocontact.view.page.content import Picture

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

COLOURS = ("#0072B2", "#D55E00", "#009E73")  # Okabe-Ito: told apart by colour-blind readers


@dataclass(frozen=True)
class LoadCurves:
    """Load over time in SI units; NaN where there is no centre of pressure."""

    time: Float[np.ndarray, " t"]
    force: Float[np.ndarray, "t 3"]
    centre: Float[np.ndarray, "t 3"]
    free_moment: Float[np.ndarray, " t"]


def cop_figure(ours: LoadCurves, plate: LoadCurves | None, normal: Float[np.ndarray, "t 3"], title: str) -> Figure:
    """Forces, centre and free moment over time, and the path.

    Parameters
    ----------
    ours, plate
        The spheres' load, and a force plate's beside it (dashed).
    normal
        Normal of the ground in each frame, NaN without contact: the path is seen along the axis nearest to it.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = sheet(11.0, 6.4)
    FigureCanvasAgg(figure)
    panels = figure.subplot_mosaic([["force", "path"], ["centre", "path"], ["free", "path"]], width_ratios=[3, 2])
    known = normal[np.isfinite(normal[:, 0])]
    up = int(np.argmax(np.abs(known.mean(axis=0)))) if len(known) else 1
    right, ahead = ((2, 1), (2, 0), (0, 1))[up]
    for curves, style, whose in ((ours, "-", "spheres"), (plate, "--", "plate")):
        if curves is None:
            continue
        for k, axis in enumerate("xyz"):
            panels["force"].plot(curves.time, curves.force[:, k], style, color=COLOURS[k], label=f"{axis}, {whose}")
        for k in (ahead, right):
            panels["centre"].plot(
                curves.time, curves.centre[:, k] * 1e3, style, color=COLOURS[k], label=f"{'xyz'[k]}, {whose}"
            )
        panels["free"].plot(curves.time, curves.free_moment, style, color="black", label=whose)
        panels["path"].plot(
            curves.centre[:, right] * 1e3, curves.centre[:, ahead] * 1e3, style, color="grey", lw=0.8, zorder=1
        )
    _path(panels["path"], ours, right, ahead)
    panels["path"].set_title(f"centre of pressure seen along {'xyz'[up]}", fontsize=9)
    for name, label in (("force", "force on the foot [N]"), ("centre", "centre [mm]"), ("free", "free moment [N m]")):
        panels[name].set_ylabel(label)
        panels[name].axhline(0.0, color="grey", lw=0.6)
        panels[name].legend(fontsize=8, frameon=False, ncols=2)
    panels["free"].set_xlabel("time [s]")
    figure.suptitle(title.replace("$", r"\$"), fontsize=11)
    return figure


def _path(axes: Axes, curves: LoadCurves, right: int, ahead: int) -> None:
    found = np.isfinite(curves.centre[:, 0])
    axes.set_xlabel(f"{'xyz'[right]} [mm]")
    axes.set_ylabel(f"{'xyz'[ahead]} [mm]")
    if not found.any():
        axes.text(0.5, 0.5, "no centre of pressure", ha="center", va="center", transform=axes.transAxes)
        return
    x, y = curves.centre[found, right] * 1e3, curves.centre[found, ahead] * 1e3
    dots = axes.scatter(x, y, c=curves.time[found], s=9, cmap="viridis", zorder=2)
    axes.figure.colorbar(dots, ax=axes, label="time [s]", shrink=0.7)
    axes.set_aspect("equal", adjustable="datalim")


PERCENT = 100.0
STANCES = (
    "Every complete stance as a line, from where the normal force reaches the gate until it falls below: 0 to 100 % of "
    "its own duration. stances.csv has the values."
)


def stance_pictures(r: FootLoads) -> list[Picture]:
    """Normal force, and the centre along the foot where that is known, over the stance; none without a stance."""
    if not r.options.stances or not stances(r):
        return []
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    table = stance_table(r, loads_table(r))
    panels = [("normal [N]", "normal force [N]", 1.0)]
    if r.axis is not None:
        panels.append((f"{NAMES[r.options.point]}{SHARE}", "centre from the heel [% of foot length]", PERCENT))
    figure = sheet(4.6 * len(panels), 3.2)
    FigureCanvasAgg(figure)
    for axes, (name, label, factor) in zip(np.ravel(figure.subplots(1, len(panels))), panels, strict=True):
        for _, one in table.groupby("stance [-]"):
            axes.plot(one["cycle [%]"], one[name] * factor, lw=1.0)
        axes.set_xlabel("stance [%]")
        axes.set_ylabel(label)
    return [Picture("Over the stance", STANCES, drawing(figure), wide=len(panels) > 1)]
