"""Which offsets and strokes keep the force on a limb under a limit."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.misalignment.design.description import described, stroke_words
from geocontact.analyses.misalignment.design.designed import Designed, designed
from geocontact.analyses.misalignment.design.options import DesignOptions
from geocontact.analyses.misalignment.design.result import DesignResult
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.axis_drift import AxisDrift
from geocontact.axis_misalignment.planar_joint import FATES

MM = 1e3


def run(drift: AxisDrift, o: DesignOptions, record: Record) -> DesignResult:
    """Map of the offsets, robust radius, stroke that is needed, sensitivities."""
    found = designed(drift, o)
    _reserve(record, found)
    _say(record, found)
    summary = described(found)
    record.results["design"] = summary
    return DesignResult(record=record, options=o, design=found, summary=summary)


def _reserve(record: Record, d: Designed) -> None:
    for fate, words in FATES.items():
        count = int((d.map.fate == fate).sum())
        if count:
            x, y = d.map.offsets[int(np.argmax(d.map.fate == fate))] * MM
            record.warn(f"{count} of {len(d.map.fate)} offsets of the map (x = {x:g} mm, y = {y:g} mm …): {words}")
    if d.boundary.least >= d.boundary.most:
        record.warn("the limit is exceeded nowhere within the map: how far offsets may go is told up to its edge only")
    if np.isnan(d.sensitivities[0].peak_slope):
        record.warn("no sensitivities where there is no force: give another `offset` than what is aimed at")


def _say(record: Record, d: Designed) -> None:
    c = d.task.compensation
    state = "locked" if c.lower == c.upper == 0.0 else f"stroke {c.lower * MM:g} … {c.upper * MM:g} mm"
    x, y = d.offset[0] * MM, d.offset[1] * MM
    verdict = "keeps" if d.keeps_limit else "exceeds"
    record.say(
        f"{state}, x = {x:g} mm, y = {y:g} mm: |F| up to {d.peak:.2f} N {verdict} the limit of {d.task.limit:g} N"
    )
    if d.keeps_limit:
        record.say(f"offsets may go {d.boundary.least * MM:.2f} mm from there in any direction")
    record.say(f"offsets within {d.uncertainty * MM:g} mm: {stroke_words(c, d.stroke)}")
