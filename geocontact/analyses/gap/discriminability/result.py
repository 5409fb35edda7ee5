"""What trials are found to tell: tables, matrix and bars, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.figure_files import drawing, save_both
from geocontact.analyses.gap.discriminability.answer import answer
from geocontact.analyses.gap.discriminability.figures import confusion_figures, matrix_figure
from geocontact.analyses.gap.discriminability.options import DiscriminabilityOptions
from geocontact.analyses.gap.discriminability.page import confusion_page
from geocontact.analyses.gap.discriminability.tables import detectability_table, separability_table
from geocontact.analyses.json_file import write_json
from geocontact.analyses.options_table import options_table
from geocontact.analyses.result import Result
from geocontact.data.gap.case import GapCase
from geocontact.gap.identifiability.discriminability import Discriminability
from geocontact.io.text.results import write_table
from geocontact.io.text.written_units import CASES
from geocontact.view.page.tables import inputs_table
from geocontact.view.page.write import write_page

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class DiscriminabilityResult(Result):
    """Which effects trials would show, from which size on, and which look alike.

    Parameters
    ----------
    case
        Whose trials, SI units.
    found
        Separations of effects, smallest amplitudes, and the diagnosis that noise is known from.
    """

    options: DiscriminabilityOptions
    case: GapCase
    found: Discriminability

    def tables(self) -> dict[str, pd.DataFrame]:
        """`separability`: a row per pair of effects; `detectability`: the smallest amplitude of each."""
        return {"separability": separability_table(self.found), "detectability": detectability_table(self.found)}

    def figure(self) -> Figure:
        """Who is told from whom."""
        return matrix_figure(self.found)

    def figures(self) -> dict[str, Figure]:
        """Matrix and smallest amplitudes, by the name of their files."""
        return confusion_figures(self.found)

    def write_files(self, folder: Path) -> None:
        """Answer and tables, and unless they are not wanted figures and page."""
        write_json(folder / "confuse.json", answer(self.case, self.found, self.options.nats))
        for name, table in self.tables().items():
            write_table(table, folder, name, CASES)
        if not self.options.bare:
            drawings = {name: save_both(figure, folder, name) for name, figure in self.figures().items()}
            self._write_page(folder / "report.html", drawings)

    def write_page(self, file: Path) -> None:
        """Sentences, matrix, smallest amplitudes."""
        self._write_page(file, {name: drawing(figure) for name, figure in self.figures().items()})

    def _write_page(self, file: Path, drawings: Mapping[str, bytes]) -> None:
        provenance = [inputs_table(self.record.inputs), options_table(self.record)]
        write_page(confusion_page(self.case.name, self.found, drawings, provenance, self.warnings), file)
