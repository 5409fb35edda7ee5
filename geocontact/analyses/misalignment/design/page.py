"""The page of a design: which offsets and which stroke keep a force under its limit."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np

from geocontact.analyses.misalignment.design.designed import Designed
from geocontact.analyses.misalignment.design.tables import sensitivity_table
from geocontact.analyses.misalignment.planar_words import MODEL, page_table
from geocontact.analyses.options_table import options_table
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.analyses.run_record import Record
from geocontact.view.page.content import Curve, Curves, Page, Picture, Readout, Row, Section, Table, Words
from geocontact.view.page.tables import inputs_table
from geocontact.view.page.write import write_page

FIGURE = (
    "Left: the largest |F| over the range of angles for every pair of offsets; the white line is the limit, grey has "
    "no force because tan γ has a pole or the offset is longer than the link. Right: force over the angle at the "
    "offsets that the design is made for, with the band of all offsets within the uncertainty."
)


def write_design_report(path: Path, record: Record, d: Designed, summary: dict[str, Any], drawing: bytes) -> int:
    """Write the self-contained page; returns its size in bytes.

    Parameters
    ----------
    summary
        What `design.json` holds.
    drawing
        The figure (SVG).
    """
    force = {"force": d.force, "lowest": d.band[0], "highest": d.band[1]}
    numbers = _numbers(summary)
    sections: list[Section] = [
        Readout([Row(name, "N", [f"{v:.2f}" for v in values]) for name, values in force.items()], "At this angle"),
        Curves("Force on the limb", "N", [Curve("at the offsets", d.force, *d.band)]),
        numbers,
        Words("Stroke of the compensation joint", [summary["needed_stroke"]["words"]]),
        Picture("Admissible offsets", FIGURE, drawing, wide=True),
        page_table("Sensitivity at these offsets", sensitivity_table(d)),
        inputs_table(record.inputs),
        options_table(record),
        Words("What the numbers do not contain", [MODEL, NOT_A_DEVICE]),
    ]
    page = Page(
        title=f"Offsets and stroke that keep the force under {d.task.limit:g} N",
        subtitle="Exoskeleton beside a joint: offsets of the axes, stroke, and force on the limb",
        time=np.degrees(d.beta),
        time_label="angle [°]",
        headline=headline(record.sentences, most=2),
        facts=[(row[0], row[1]) for row in numbers.rows[:5]],
        reservations=tuple(record.warnings),
        start_frame=int(np.argmax(np.abs(d.force))),
        sections=tuple(sections),
        plays=False,
    )
    return write_page(page, path)


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
