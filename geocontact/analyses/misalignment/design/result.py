"""What a design finds: offsets and strokes that keep the limit, tables, figure, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from geocontact.analyses.figure_files import drawing
from geocontact.analyses.json_file import write_json
from geocontact.analyses.misalignment.design.designed import Designed
from geocontact.analyses.misalignment.design.figure import design_figure, map_figure
from geocontact.analyses.misalignment.design.options import DesignOptions
from geocontact.analyses.misalignment.design.page import design_page
from geocontact.analyses.misalignment.design.tables import boundary_table, force_table, map_table, sensitivity_table
from geocontact.analyses.result import REPORT, Result

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
