"""The page of an identification: how well the law meets the forces, what it tells, and what it cannot tell."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from geocontact.analyses.modulus.figure import ForcePair
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.view.page.content import Curve, Curves, Intervals, Page, Picture, Readout, Row, Section, Table, Words
from geocontact.view.page.write import write_page

FIGURE = (
    "Left: measured force as a line, force by the law dashed. Right: how far the sum of squares rises when E* is held "
    "beside its best value, in units of the cut: the interval of 95 % ends at 1."
)
LAW = (
    "The law turns one area into one force. It has no friction, no damping, no liner that creeps, and it takes the "
    "area of rigid surfaces within a threshold for that of an elastic contact: what E* says of a material is only as "
    "good as that reading. Read it beside the table of thresholds and readings."
)


def write_modulus_report(
    path: Path,
    title: str,
    pairs: Mapping[str, ForcePair],
    drawing: bytes,
    tables: Sequence[Table],
    intervals: Intervals,
    lost: Sequence[str],
    warnings: Sequence[str],
    sentences: Sequence[str] = (),
) -> int:
    """Write the self-contained page; returns its size in bytes.

    Parameters
    ----------
    pairs
        Measured and predicted forces by side, all at the same times.
    drawing
        The figure (SVG).
    tables
        Results first; the first one's numbers make the headline.
    intervals
        E* of each side.
    lost
        What the data cannot tell, a sentence each.
    warnings, sentences
        Reservations, and what was found.
    """
    first = next(iter(pairs.values()))
    texts = [
        Row(f"{side}, {kind}", "N", [f"{value:.1f}" for value in values])
        for side, pair in pairs.items()
        for kind, values in (("measured", pair.measured), ("by the law", pair.predicted))
    ]
    sections: list[Section] = [Readout(texts)]
    for side, pair in pairs.items():
        curves = [Curve("measured", pair.measured), Curve("by the law", pair.predicted)]
        sections.append(Curves(f"Contact force, {side}", "N", curves))
    sections += [
        intervals,
        tables[0],
        Words("What the data cannot tell", list(lost)),
        Picture("Force by the law and profile of E*", FIGURE, drawing, wide=True),
        *tables[1:],
        Words("What the numbers do not contain", [LAW, NOT_A_DEVICE]),
    ]
    page = Page(
        title=title,
        subtitle="Elastic modulus of a contact by the area-integrated Hertz law",
        time=first.time,
        time_label="time [s]",
        headline=headline(sentences, most=2),
        reservations=tuple(warnings),
        facts=[(f"{row[0]}: {row[1]}", f"{row[2]} ({row[3]})" if row[3] else row[2]) for row in tables[0].rows[:5]],
        start_frame=int(np.argmax(first.measured)),
        sections=tuple(sections),
    )
    return write_page(page, path)
