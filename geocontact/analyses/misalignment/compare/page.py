"""The page of a comparison: a model beside a measurement."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from geocontact.analyses.misalignment.compare.pair import QUANTITIES, Pair
from geocontact.analyses.misalignment.page import FRAMES, NOT_IN_THE_NUMBERS, write_elbow_page
from geocontact.analyses.page_words import counted
from geocontact.analyses.run_record import Record
from geocontact.view.page.content import Curve, Curves, Picture, Readout, Row, Section, Table

COMPARED = "Means over bins of the angle: measured as marks, the model as lines, a colour per trial."


def write_comparison_report(
    path: Path, pairs: Sequence[Pair], drawings: Mapping[str, bytes], tables: Sequence[Table], record: Record
) -> int:
    """Write the page of a comparison, the first trial's force over time; returns its size in bytes.

    `drawings` are the SVG of each channel's figure.
    """
    first = pairs[0]
    shown = slice(None, None, -(-len(first.time) // FRAMES))
    force = {"measured": first.measured[shown], "model": first.model[shown]}
    sections: list[Section] = [
        Readout([Row(name, "N", [f"{v:.2f}" for v in values]) for name, values in force.items()]),
        Curves("Constraint force of the first trial", "N", [Curve(name, values) for name, values in force.items()]),
        *(Picture(QUANTITIES[each].name.capitalize(), COMPARED, svg, wide=True) for each, svg in drawings.items()),
        *tables,
        NOT_IN_THE_NUMBERS,
    ]
    title = f"Model beside {counted(len({p.trial for p in pairs}), 'recording')}"
    subtitle = "Model and measurement of an elbow exoskeleton"
    facts = [(f"{p.trial}, {p.channel}", f"R² {p.agreement.r2:.3f}") for p in pairs]
    return write_elbow_page(path, title, subtitle, first.time[shown], "time [s]", facts, sections, record)
