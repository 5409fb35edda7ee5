"""A gap case made of recordings."""

from __future__ import annotations

import shutil
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.gap.gather.options import GatherOptions
from geocontact.analyses.gap.gather.page import gather_page
from geocontact.analyses.result import REPORT, Part, Result
from geocontact.analyses.results_folder import Scratch
from geocontact.data.gap.case import GapCase
from geocontact.io.cases.gap_case_writer import trial_table

if TYPE_CHECKING:
    from geocontact.view.page.content import Page


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

    @property
    def title(self) -> str:
        """Which description was gathered."""
        return f"Trials of {self.options.settings.name}"

    @property
    def parts(self) -> frozenset[Part]:
        """The page; tables are among the files of the case."""
        return frozenset(("pages",))

    def tables(self) -> dict[str, pd.DataFrame]:
        """`trials/<id>`: every trial, those that may be fitted to first."""
        return {f"trials/{one.name}": trial_table(one) for one in (*self.case.calibration, *self.case.evaluation)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Every channel of the trials over time."""
        return {REPORT: gather_page(self.title, self.case)}

    def write_files(self, folder: Path) -> None:
        """Also case.toml, trials, cells and tables."""
        shutil.copytree(self.scratch.folder, folder, dirs_exist_ok=True)
        super().write_files(folder)
