"""What is shown of an identified keel: stiffness over the fulcrum, compressions beside beam theory, numbers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import headline
from geocontact.below_knee_prosthesis.keel.identification import IdentifiedKeel, MeasuredCompression
from geocontact.data.motion import Course
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, Points
from geocontact.view.page.content import Page, Section, Words
from geocontact.view.page.tables import frame_table

PER_MM = 1e-3
"""N/mm per N/m, and mm per m the other way round."""
BEAM = (
    "Beam theory (Euler and Bernoulli, small deflections): the keel is held at its posterior end and may turn but not "
    "move at the fulcrum; a spring in series stands for all that gives besides."
)
SOLE = (
    "On the sole: a tilted plate compresses it under the keel; EI and the stiffness of the foremost zone are "
    "fitted to the same compressions. These two are the numbers of the written foot."
)
INTERVALS = (
    "Intervals of 95 % contain the scatter of the compressions. Errors of lengths, of the fulcrum's place and of how "
    "the end is held are not in them."
)


def keel_curves(beam: IdentifiedKeel, measured: Sequence[MeasuredCompression], stiffness: pd.DataFrame) -> CurveSheet:
    """Stiffness over the fulcrum, and force over deflection of each curve."""
    over = Course("fulcrum", "mm", stiffness["fulcrum [mm]"].to_numpy(float))
    lines = [
        Curve("beam theory", PER_MM * stiffness["beam [N/m]"].to_numpy(float), stroke=0),
        Curve("sole", PER_MM * stiffness["sole [N/m]"].to_numpy(float), stroke=1),
    ]
    places = 1e3 * np.array(beam.fulcrums)
    slopes = PER_MM * np.array([one.slope()[0] for one in measured])
    panels = [Curves("Stiffness in compression", "N/mm", lines, points=[Points("measured", places, slopes, INK)])]
    for k, one in enumerate(measured):
        if one.curve:
            panels.append(_force_panel(beam, one, k))
    return CurveSheet(panels, over)


def _force_panel(beam: IdentifiedKeel, one: MeasuredCompression, k: int) -> Curves:
    """Deflection over force of a curve, measured and by beam theory."""
    order = np.argsort(one.force)
    force = one.force[order]
    fitted = Curve("beam theory", 1e3 * beam.deflection(k, force), stroke=0)
    seen = Points("measured", force, 1e3 * one.deflection[order], INK)
    title = f"Deflection, {one.name}"
    return Curves(title, "mm", [fitted], points=[seen], over=Course("force", "N", force))


def keel_page(
    name: str,
    curves: CurveSheet,
    tables: Mapping[str, pd.DataFrame],
    sentences: Sequence[str],
    facts: Sequence[tuple[str, str]],
) -> Page:
    """Curves, numbers with intervals, compressions, and how they are to be read."""
    sections: list[Section] = [
        *curves.panels,
        frame_table("What was identified, in SI", tables["keel"], 4),
        frame_table("Compressions", tables["compressions"], 4),
        INPUTS,
        OPTIONS,
        Words("How it is to be read", [BEAM, SOLE, INTERVALS]),
    ]
    return Page(
        title=f"Keel of {name}",
        subtitle="Identified from static compressions of the forefoot",
        time=tables["stiffness"]["fulcrum [mm]"].to_numpy(float),
        time_label="fulcrum [mm]",
        headline=headline(sentences, most=2),
        facts=facts,
        sections=tuple(sections),
        plays=False,
    )
