"""Which offsets keep a force under its limit, and the force over the angle with its band."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geocontact.analyses.misalignment.design.designed import Designed
from geocontact.view.curves.style import BLACK, DOUBLE, GREY, PALETTE, in_style, legend, panels

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MM = 1e3
LEVELS = 12
BEYOND = 4.0
"""Forces above this many limits have the colour of that many."""


@in_style
def design_figure(d: Designed) -> Figure:
    """Draw largest |F| [N] over the offsets with the limit, and force, lowest, highest over the angle."""
    figure, (plane, course) = panels(1, 2, DOUBLE, 0.08)
    _map(figure, plane, d)
    beta, limit = np.degrees(d.beta), d.task.limit
    band = course.fill_between(beta, *d.band, color=PALETTE[0], alpha=0.25, lw=0)
    curve = course.plot(beta, d.force, color=PALETTE[0])[0]
    ends = [course.axhline(side * limit, color=BLACK, lw=0.8, ls="--") for side in (-1.0, 1.0)]
    course.axhline(0.0, color=GREY, lw=0.5)
    course.set_xlabel("angle of the exoskeleton [°]")
    course.set_ylabel("force on the limb [N]")
    legend(course, [(curve, "at the offsets"), (band, "within the uncertainty"), (ends[0], f"limit {limit:g} N")])
    return figure


@in_style
def map_figure(d: Designed) -> Figure:
    """Draw largest |F| [N] over the offsets with the limit alone."""
    figure, (plane,) = panels(1, 1, 0.11, 0.085)
    _map(figure, plane, d)
    return figure


def _map(figure: Figure, plane: Axes, d: Designed) -> None:
    """The largest |F| over the offsets with the limit, the robust radius and the uncertainty."""
    limit, offset = d.task.limit, d.offset
    x, y = (axis * MM for axis in d.axes)
    shown = np.ma.masked_invalid(d.map.peak.reshape(len(y), len(x)))
    levels = np.linspace(0.0, BEYOND * limit, LEVELS + 1)
    filled = plane.contourf(x, y, shown, levels, cmap="cividis", extend="max")
    figure.colorbar(filled, ax=plane, label="largest |F| [N]")
    plane.contour(x, y, shown, [limit], colors="white", linewidths=1.2)
    circles: list[tuple[Artist | tuple[Artist, ...], str]] = []
    around = np.linspace(0.0, 2.0 * np.pi, 361)
    for radius, colour, line, name in (
        (d.boundary.least, PALETTE[4], "--", f"any offset within {d.boundary.least * MM:.1f} mm keeps it"),
        (d.uncertainty, PALETTE[1], ":", f"uncertainty, {d.uncertainty * MM:g} mm"),
    ):
        if radius > 0.0:
            u, v = (offset[k] * MM + radius * MM * turn(around) for k, turn in enumerate((np.cos, np.sin)))
            circles.append((plane.plot(u, v, color=colour, ls=line, lw=1.0)[0], name))
    plane.plot(*(value * MM for value in offset), "+", color="white", markersize=6.0)
    plane.set_aspect("equal")
    plane.set_facecolor("0.8")
    plane.set_xlabel("offset x [mm]")
    plane.set_ylabel("offset y [mm]")
    if circles:
        legend(plane, circles)
