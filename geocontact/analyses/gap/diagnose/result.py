"""What a diagnosis finds: the answer, tables, figures, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.gap.diagnose.figures import gap_figures, map_figure
from geocontact.analyses.gap.diagnose.options import DiagnoseOptions
from geocontact.analyses.gap.diagnose.page import gap_page
from geocontact.analyses.gap.diagnose.tables import diagnosis_tables
from geocontact.analyses.json_file import write_json
from geocontact.analyses.result import PARTS, REPORT, Part, Result
from geocontact.data.gap.case import GapCase
from geocontact.data.gap.diagnosis import Diagnosis
from geocontact.gap.diagnose import Findings
from geocontact.io.text.written_units import CASES

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


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

    @property
    def title(self) -> str:
        """Name of the case."""
        return self.diagnosis.case

    @property
    def parts(self) -> frozenset[Part]:
        """Tables alone where no more is wanted."""
        return frozenset(("tables",)) if self.options.bare else PARTS

    def tables(self) -> dict[str, pd.DataFrame]:
        """`gap_map`, `ranking`, `held_out`; `trials` where something is named, `surface` where a mat has cells."""
        return diagnosis_tables(self.findings)

    def units(self, table: str) -> Mapping[str, str]:
        """SI, as in the case."""
        return CASES

    def figure(self) -> Figure:
        """Where the gap is."""
        return map_figure(self.findings)

    def figures(self) -> dict[str, Figure]:
        """All figures by the name of their files."""
        return gap_figures(self.findings)

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Verdict, curves of held-out trials, figures and tables."""
        return {REPORT: gap_page(self.case, self.findings, drawings)}

    def write_files(self, folder: Path) -> None:
        """Also the answer."""
        super().write_files(folder)
        write_json(folder / "diagnosis.json", self.diagnosis.as_dict())
