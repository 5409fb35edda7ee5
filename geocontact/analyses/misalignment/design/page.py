"""The page of a design: which offsets and which stroke keep a force under its limit."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.page_words import NOT_A_DEVICE
from geocontact.view.page.content import Curve, Curves, Page, Picture, Readout, Row, Section, Table, Words
from geocontact.view.page.write import write_page

FIGURE = (
    "Left: the largest |F| over the range of angles for every pair of offsets; the white line is the limit, grey has "
    "no force because tan γ has a pole or the offset is longer than the link. Right: force over the angle at the "
    "offsets that the design is made for, with the band of all offsets within the uncertainty."
)
MODEL = (
    "A spring between limb and attachment, the joint a hinge whose axis stays or drifts as told, slow motion: no "
    "damping, no friction in the compensation joint, no slip of the cuff, a rigid upper attachment. Stiffness and all "
    "lengths together are known up to one factor only, F(k/s, s · lengths) = F: a force measured at some angles tells "
    "the product, not its parts."
)


def write_design_report(
    path: Path,
    title: str,
    angle: Float[np.ndarray, " m"],
    force: Float[np.ndarray, " m"],
    band: tuple[Float[np.ndarray, " m"], Float[np.ndarray, " m"]],
    drawing: bytes,
    tables: Sequence[Table],
    stroke: str,
    warnings: Sequence[str],
) -> int:
    """Write the self-contained page; returns its size in bytes.

    Parameters
    ----------
    angle, force, band
        Angle of the exoskeleton [deg], force [N], and its least and largest value within the uncertainty.
    drawing
        The figure (SVG).
    tables
        Results first; the first one's rows make the headline.
    stroke
        What is said about the stroke.
    """
    readout = [
        Row(name, "N", [f"{value:.2f}" for value in values])
        for name, values in (("force", force), ("lowest", band[0]), ("highest", band[1]))
    ]
    sections: list[Section] = [
        Readout(readout, "At this angle"),
        Curves("Force on the limb", "N", [Curve("at the offsets", force, *band)]),
        tables[0],
        Words("Stroke of the compensation joint", [stroke]),
        Picture("Admissible offsets", FIGURE, drawing, wide=True),
        *tables[1:],
        Words("What the numbers do not contain", [MODEL, NOT_A_DEVICE]),
    ]
    if warnings:
        sections.append(Words("Reservations of this run", list(warnings)))
    page = Page(
        title=title,
        subtitle="Exoskeleton beside a joint: offsets of the axes, stroke, and force on the limb",
        time=angle,
        time_label="angle [°]",
        headline=[(row[0], row[1]) for row in tables[0].rows],
        start_frame=int(np.argmax(np.abs(force))),
        sections=tuple(sections),
    )
    return write_page(page, path)
