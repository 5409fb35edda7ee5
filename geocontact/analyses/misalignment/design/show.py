"""What is shown of a design: map of the offsets, force over the angle, page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE
from geocontact.analyses.misalignment.design.designed import Designed, sensitivity_table, stroke_words
from geocontact.analyses.misalignment.planar import MODEL, page_table
from geocontact.data.motion import Course
from geocontact.view.curves.declared import Curve, Curves, Limit
from geocontact.view.curves.drawn import draw_on
from geocontact.view.curves.style import DOUBLE, PALETTE, in_style, legend, panels
from geocontact.view.page.content import Page, Picture, Readout, Row, Section, Table, Words

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


MM = 1e3
LEVELS = 12
PAGE_MAP = 0.14
"""Width of the page's map [m]: narrow, so that its letters can be read on a phone."""
BEYOND = 4.0
"""Forces above this many limits have the colour of that many."""


@in_style
def design_figure(d: Designed) -> Figure:
    """Draw largest |F| [N] over the offsets with the limit, and force, lowest, highest over the angle."""
    figure, (plane, course) = panels(1, 2, DOUBLE, 0.08)
    _map(figure, plane, d)
    draw_on(course, force_curves(d), Course("angle of the exoskeleton", "°", np.degrees(d.beta)))
    return figure


def force_curves(d: Designed) -> Curves:
    """Force over the angle at the offsets, within the uncertainty, beside the limits."""
    return Curves("Force on the limb", "N", [Curve("at the offsets", d.force, *d.band)], limits=_limits(d))


@in_style
def map_figure(d: Designed) -> Figure:
    """Draw largest |F| [N] over the offsets with the limit alone."""
    figure, (plane,) = panels(1, 1, PAGE_MAP, 0.61 * PAGE_MAP)
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


FIGURE = (
    "The largest |F| over the range of angles for every pair of offsets. The white line is the limit, the white cross "
    "the offsets that the design is made for; grey has no force because tan γ has a pole or the offset is longer than "
    "the link."
)
NEAR = 3.0
"""Limits are drawn with the force unless they are more than so many times its size."""


def design_page(d: Designed, summary: dict[str, Any], drawing: bytes) -> Page:
    """The page of a design.

    Parameters
    ----------
    summary
        What `design.json` holds.
    drawing
        The map (SVG).
    """
    force = {"force": d.force, "lowest": d.band[0], "highest": d.band[1]}
    numbers = _numbers(summary)
    sections: list[Section] = [
        Picture("Admissible offsets", FIGURE, drawing),
        force_curves(d),
        Readout([Row(name, "N", [f"{v:.2f}" for v in values]) for name, values in force.items()], "At this angle"),
        numbers,
        Words("Stroke of the compensation joint", [summary["needed_stroke"]["words"]]),
        page_table("Sensitivity at these offsets", sensitivity_table(d)),
        INPUTS,
        OPTIONS,
        Words("What the numbers do not contain", [MODEL, NOT_A_DEVICE]),
    ]
    return Page(
        title=f"Offsets and stroke for a limit of {d.task.limit:g} N",
        subtitle="Exoskeleton beside a joint: offsets of the axes, stroke, and force on the limb",
        time=np.degrees(d.beta),
        time_label="angle [°]",
        headline=answer(d, summary),
        facts=[(row[0], row[1]) for row in numbers.rows[:5]],
        start_frame=int(np.argmax(np.abs(d.force))),
        sections=tuple(sections),
        plays=False,
    )


def answer(d: Designed, summary: dict[str, Any]) -> list[str]:
    """Whether the limit is kept at the offsets, how far they may go, and which stroke the uncertainty asks for."""
    radius, limit = summary["admissible_radius"], f"{d.task.limit:g} N"
    x, y = (each * 1e3 for each in d.offset)
    told = f"At x = {x:g} mm and y = {y:g} mm the force reaches {d.peak:.3g} N"
    if not d.keeps_limit:
        told += f" and exceeds the limit of {limit}."
    else:
        beyond = "" if radius["exceeded_within_map"] else "at least "
        told += (
            f" and keeps the limit of {limit}; offsets may go {beyond}{radius['radius_mm']:.3g} mm any way from there."
        )
    if not np.isfinite(d.peak):
        told = f"At x = {x:g} mm and y = {y:g} mm there is no force to keep the limit of {limit} with."
    stroke = stroke_words(d.task.compensation, d.stroke)
    return [told, f"Offsets within {d.uncertainty * 1e3:g} mm: {stroke}."]


def _limits(d: Designed) -> list[Limit]:
    """Both signs of the limit, as far as the force comes near."""
    size, limit = float(np.nanmax(np.abs(d.band), initial=0.0)), d.task.limit
    if limit > NEAR * size:
        return []
    return [Limit(f"limit {sign}{limit:g} N", side * limit) for sign, side in (("", 1.0), ("−", -1.0))]


def _numbers(told: dict[str, Any]) -> Table:
    one, radius, stroke, points = told["offset"], told["admissible_radius"], told["needed_stroke"], told["map"]
    beyond = "" if radius["exceeded_within_map"] else " or more"
    least, largest = stroke["free_of_force_mm"]
    robust = "robust radius" if one["admissible"] else "robust radius; the limit is exceeded at the offsets themselves"
    without = f"{points['pole']} with a pole, {points['fold']} with a fold"
    rows = [
        ("largest |F| at these offsets", f"{one['peak_N']:.2f} N", f"at {one['peak_at_deg']:.1f}°"),
        (f"limit of {told['limit_N']:g} N", one["limit"], "at these offsets"),
        ("offsets may go in any direction", f"{radius['radius_mm']:.2f} mm{beyond}", robust),
        ("free of force between", f"{least:.2f} … {largest:.2f} mm", f"offsets within {stroke['uncertainty_mm']:g} mm"),
        ("lower stroke end at most", f"{stroke['lower_end_at_most_mm']:.2f} mm", "for the limit"),
        ("upper stroke end at least", f"{stroke['upper_end_at_least_mm']:.2f} mm", "for the limit"),
        ("offsets of the map that keep it", f"{points['admissible']} of {points['offsets']}", without),
    ]
    return Table("What the limit asks for", ("what", "value", "note"), rows)
