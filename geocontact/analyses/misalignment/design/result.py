"""Offsets and strokes that keep a force under a limit: `geocontact elbow design`, `gc.misalignment.design`.

>>> import geocontact as gc
>>> link = {"k": 222.43, "l": gc.mm(169), "z": gc.mm(127)}
>>> asked = {"range": gc.deg(0, 120), "limit": 5.0, "stroke": gc.mm(0, 60), "step": gc.mm(4)}
>>> result = gc.misalignment.design(**link, offset=gc.mm(48, 59), **asked)
>>> print(result)
stroke 0 … 60 mm, x = 48 mm, y = 59 mm: |F| up to 8.64 N exceeds the limit of 5 N
offsets within 0 mm: a stroke from -16.35 mm or less to 61.81 mm or more keeps the limit: the lower end must
be decreased by 16.35 mm and the upper end must be increased by 1.81 mm
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import note, reserve, say
from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.json_file import write_json
from geocontact.analyses.frame.pages import drawing
from geocontact.analyses.frame.result import REPORT, Result
from geocontact.analyses.misalignment.design.designed import (
    Designed,
    boundary_table,
    described,
    designed,
    force_table,
    map_table,
    read,
    sensitivity_table,
    stroke_words,
)
from geocontact.analyses.misalignment.design.options import DesignOptions
from geocontact.analyses.misalignment.design.show import design_figure, design_page, map_figure
from geocontact.axis_misalignment.axis_drift import AxisDrift
from geocontact.axis_misalignment.planar_joint import FATES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class DesignResult(Result):
    """Offsets and strokes that keep a force under its limit.

    Parameters
    ----------
    design
        Map, boundary, stroke and sensitivities, in SI.
    summary
        What `design.json` holds, with units in the keys.
    """

    options: DesignOptions
    design: Designed
    summary: dict[str, Any]

    @property
    def angle(self) -> Float[np.ndarray, " m"]:
        """Angle of the exoskeleton's hinge [rad]."""
        return self.design.beta

    @property
    def force(self) -> Float[np.ndarray, " m"]:
        """Constraint force over the angle at the offsets [N]."""
        return self.design.force

    @property
    def peak(self) -> float:
        """Largest size of the constraint force over the angle at the offsets [N]."""
        return self.design.peak

    @property
    def needed_stroke(self) -> tuple[float, float]:
        """Ends of the stroke that keeps the force under the limit within the uncertainty [m]."""
        return self.design.stroke.lower, self.design.stroke.upper

    def tables(self) -> dict[str, pd.DataFrame]:
        """`force` over the angle, `map` of the offsets, `boundary`, `sensitivity`."""
        d = self.design
        return {
            "force": force_table(d),
            "map": map_table(d),
            "boundary": boundary_table(d),
            "sensitivity": sensitivity_table(d),
        }

    def figures(self) -> dict[str, Figure]:
        """`design`: the limit in the plane of the offsets, and the force over the angle with its band."""
        return {"design": design_figure(self.design)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Map of the offsets, force over the angle, what the limit asks for, sensitivities."""
        return {REPORT: design_page(self.design, self.summary, drawing(map_figure(self.design)))}

    def write_files(self, folder: Path) -> None:
        """design.json besides."""
        write_json(folder / "design.json", self.summary)
        super().write_files(folder)


MM = 1e3


def run(drift: AxisDrift, o: DesignOptions) -> DesignResult:
    """Map of the offsets, robust radius, stroke that is needed, sensitivities."""
    found = designed(drift, o)
    _reserve(found)
    _report(found)
    summary = described(found)
    note("design", summary)
    return DesignResult(options=o, design=found, summary=summary)


def _reserve(d: Designed) -> None:
    for fate, words in FATES.items():
        count = int((d.map.fate == fate).sum())
        if count:
            x, y = d.map.offsets[int(np.argmax(d.map.fate == fate))] * MM
            reserve(f"{count} of {len(d.map.fate)} offsets of the map (x = {x:g} mm, y = {y:g} mm …): {words}")
    if d.boundary.least >= d.boundary.most:
        reserve("the limit is not exceeded anywhere in the map: how far offsets may go is computed up to its edge only")
    if np.isnan(d.sensitivities[0].peak_slope):
        reserve("no sensitivities where there is no force: give another `offset` than what is aimed at")


def _report(d: Designed) -> None:
    c = d.task.compensation
    state = "locked" if c.lower == c.upper == 0.0 else f"stroke {c.lower * MM:g} … {c.upper * MM:g} mm"
    x, y = d.offset[0] * MM, d.offset[1] * MM
    verdict = "keeps" if d.keeps_limit else "exceeds"
    say(f"{state}, x = {x:g} mm, y = {y:g} mm: |F| up to {d.peak:.2f} N {verdict} the limit of {d.task.limit:g} N")
    if d.keeps_limit:
        say(f"offsets may go {d.boundary.least * MM:.2f} mm from there in any direction")
    say(f"offsets within {d.uncertainty * MM:g} mm: {stroke_words(c, d.stroke)}")


design = Job("elbow design", DesignOptions, read, run)
