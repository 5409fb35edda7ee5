"""The page of a design: which offsets and which stroke keep a force under its limit."""

from __future__ import annotations

from typing import Any

import numpy as np

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.misalignment.design.description import stroke_words
from geocontact.analyses.misalignment.design.designed import Designed
from geocontact.analyses.misalignment.design.tables import sensitivity_table
from geocontact.analyses.misalignment.planar_words import MODEL, page_table
from geocontact.analyses.page_words import NOT_A_DEVICE
from geocontact.view.page.content import Curve, Curves, Limit, Page, Picture, Readout, Row, Section, Table, Words

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
        Curves("Force on the limb", "N", [Curve("at the offsets", d.force, *d.band)], limits=_limits(d)),
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
