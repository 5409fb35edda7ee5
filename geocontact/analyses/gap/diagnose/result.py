"""What a diagnosis finds: the answer, tables, figures, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.figure_files import save_both
from geocontact.analyses.gap.diagnose.figures import gap_figures, map_figure
from geocontact.analyses.gap.diagnose.options import DiagnoseOptions
from geocontact.analyses.gap.diagnose.page import gap_page
from geocontact.analyses.gap.diagnose.tables import diagnosis_tables
from geocontact.analyses.json_file import write_json
from geocontact.analyses.options_table import options_table
from geocontact.analyses.result import Result
from geocontact.data.gap.case import GapCase
from geocontact.data.gap.diagnosis import Diagnosis
from geocontact.gap.diagnose import Findings
from geocontact.io.text.results import write_table
from geocontact.io.text.written_units import CASES
from geocontact.view.page.tables import inputs_table
from geocontact.view.page.write import write_page

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class DiagnoseResult(Result):
    """Where a model misses the measurement, which effect it lacks, how far the gap shrinks with it.

    Parameters
    ----------
    case
        What was diagnosed, SI units.
    findings
        Answer, gap map, held-out curves, ranking, and all that they rest on.
    """

    options: DiagnoseOptions
    case: GapCase
    findings: Findings

    @property
    def diagnosis(self) -> Diagnosis:
        """The answer, as in diagnosis.json."""
        return self.findings.diagnosis

    def tables(self) -> dict[str, pd.DataFrame]:
        """`gap_map`, `ranking`, `held_out`; `trials` where something is named, `surface` where a mat has cells."""
        return diagnosis_tables(self.findings)

    def figure(self) -> Figure:
        """Where the gap is."""
        return map_figure(self.findings)

    def figures(self) -> dict[str, Figure]:
        """All figures by the name of their files."""
        return gap_figures(self.findings)

    def write_files(self, folder: Path) -> None:
        """Answer and tables, and unless they are not wanted figures and page."""
        write_json(folder / "diagnosis.json", self.diagnosis.as_dict())
        for name, table in self.tables().items():
            write_table(table, folder, name, CASES)
        if self.options.bare:
            return
        figures = self.figures()
        for name, figure in figures.items():
            save_both(figure, folder, name)
        self._write_page(folder / "report.html", figures)

    def write_page(self, file: Path) -> None:
        """Verdict, curves of held-out trials, figures and tables."""
        self._write_page(file, self.figures())

    def _write_page(self, file: Path, figures: Mapping[str, Figure]) -> None:
        provenance = [inputs_table(self.record.inputs), options_table(self.record)]
        write_page(gap_page(self.case, self.findings, figures, provenance, self.warnings), file)
