"""The page of an identification: how well the law meets the forces, what it tells, and what it cannot tell."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geocontact.analyses.modulus.identified import Identified
from geocontact.analyses.modulus.page_answer import facts, headline, undescribed
from geocontact.analyses.modulus.page_intervals import modulus_intervals
from geocontact.analyses.page_words import NOT_A_DEVICE
from geocontact.view.page.content import Curve, Curves, Page, Picture, Section, Table, Words

FIGURE = (
    "Left: measured force as a line, force by the law dashed. Right: how far the sum of squares rises when E* is held "
    "beside its best value, in units of the cut: the interval of 95 % ends at 1."
)
LAW = (
    "The law turns one area into one force. It has no friction, no damping, no liner that creeps, and it takes the "
    "area of rigid surfaces within a threshold for that of an elastic contact: what E* says of a material is only as "
    "good as that reading. Read it beside the table of thresholds and readings."
)


def modulus_page(title: str, found: Identified, drawing: bytes, tables: Sequence[Table]) -> Page:
    """The page before it becomes a file; it opens with E*, or with the forces where the law does not describe them.

    Parameters
    ----------
    drawing
        The figure (SVG).
    tables
        Results first.
    """
    pairs = found.curves()
    first = next(iter(pairs.values()))
    forces: list[Section] = [
        Curves(f"Contact force, {side}", "N", [Curve("measured", pair.measured), Curve("by the law", pair.predicted)])
        for side, pair in pairs.items()
    ]
    intervals = modulus_intervals(found)
    sections: list[Section] = [
        *([*forces, intervals] if undescribed(found) else [intervals, *forces]),
        tables[0],
        Words("What the data cannot tell", found.not_identifiable()),
        Picture("Force by the law and profile of E*", FIGURE, drawing, wide=True),
        *tables[1:],
        Words("What the numbers do not contain", [LAW, NOT_A_DEVICE]),
    ]
    return Page(
        title=title,
        subtitle=_subtitle(found),
        time=first.time,
        time_label="time [s]",
        headline=headline(found),
        facts=facts(found),
        start_frame=int(np.argmax(first.measured)),
        sections=tuple(sections),
        plays=False,
    )


def _subtitle(found: Identified) -> str:
    sticks = found.first.model.adhesion
    law = "the area-integrated Hertz law" if sticks is None else f"Hertz's law less {sticks.words}, which is given"
    return f"Elastic modulus of a contact by {law}"
