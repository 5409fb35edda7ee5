"""A gap case made of recordings."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from geocontact.analyses.gap.gather.options import GatherOptions
from geocontact.analyses.gap.gather.page import write_gather_page
from geocontact.analyses.result import Result
from geocontact.analyses.results_folder import Scratch
from geocontact.data.gap.case import GapCase
from geocontact.io.cases.gap_case_writer import trial_table


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class GatherResult(Result):
    """Trials of a gap case as they were brought together; `write` makes the folder that `diagnose` reads.

    Parameters
    ----------
    case
        The case, SI units.
    scratch
        Where its files lie until they are written.
    """

    options: GatherOptions
    case: GapCase
    scratch: Scratch

    def tables(self) -> dict[str, pd.DataFrame]:
        """`trials/<id>`: every trial, those that may be fitted to first."""
        return {f"trials/{one.name}": trial_table(one) for one in (*self.case.calibration, *self.case.evaluation)}

    def write_files(self, folder: Path) -> None:
        """case.toml, trials, cells and tables, page."""
        shutil.copytree(self.scratch.folder, folder, dirs_exist_ok=True)
        self.write_page(folder / "report.html")

    def write_page(self, file: Path) -> None:
        """Every channel of the trials over time."""
        write_gather_page(file, f"Trials of {self.options.settings.name}", self.record, self.case)
