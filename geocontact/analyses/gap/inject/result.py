"""What comes of an effect that was put in: the case that has it, and whether it was found."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.gap.diagnose.result import DiagnoseResult
from geocontact.analyses.gap.inject.answer import answer, parameter_rows
from geocontact.analyses.gap.inject.judged import Judgement
from geocontact.analyses.gap.inject.options import InjectOptions
from geocontact.analyses.json_file import write_json
from geocontact.analyses.result import Part, Result
from geocontact.analyses.results_folder import Scratch
from geocontact.chain.candidate import Candidate
from geocontact.data.gap.diagnosis import Diagnosis
from geocontact.gap.inject import Injected

if TYPE_CHECKING:
    from matplotlib.figure import Figure

CASE, DIAGNOSIS = "case", "diagnosis"
COLUMNS = ["parameter", "unit", "planted", "found", "low", "high"]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class InjectResult(Result):
    """A known effect in measured trials, and what the diagnosis makes of them.

    Parameters
    ----------
    effect
        What was put in.
    planted
        The case that has it, values of its parameters (SI), and the gap that it makes.
    diagnosed
        The diagnosis of that case.
    judgement
        Whether the effect was found, against the diagnosis of the case without it.
    scratch
        Where the case lies until it is written.
    """

    options: InjectOptions
    effect: Candidate
    planted: Injected
    diagnosed: DiagnoseResult
    judgement: Judgement
    scratch: Scratch

    @property
    def diagnosis(self) -> Diagnosis:
        """The answer, as in diagnosis/diagnosis.json."""
        return self.diagnosed.diagnosis

    @property
    def title(self) -> str:
        """Which effect was put into which case."""
        return f"{self.effect.label} in {self.diagnosis.case}"

    @property
    def parts(self) -> frozenset[Part]:
        """None: the diagnosis writes its own, planted.json has the effect's parameters."""
        return frozenset()

    def tables(self) -> dict[str, pd.DataFrame]:
        """`planted`: parameters of the effect as they were put in and found; `diagnosis/ranking` and so on."""
        rows = parameter_rows(self.effect, self.planted, self.diagnosis)
        found = {f"{DIAGNOSIS}/{name}": table for name, table in self.diagnosed.tables().items()}
        return {"planted": pd.DataFrame(rows, columns=COLUMNS), **found}

    def figures(self) -> dict[str, Figure]:
        """Those of the diagnosis: `diagnosis/gap_map` and so on."""
        return {f"{DIAGNOSIS}/{name}": figure for name, figure in self.diagnosed.figures().items()}

    def figure(self) -> Figure:
        """Where the gap is."""
        return self.diagnosed.figure()

    def write_files(self, folder: Path) -> None:
        """The case, its diagnosis with a record of its own, and what was put in."""
        shutil.copytree(self.scratch.folder / CASE, folder / CASE)
        (folder / DIAGNOSIS).mkdir()
        self.diagnosed.put(folder / DIAGNOSIS)
        write_json(folder / "planted.json", answer(self.effect, self.planted, self.diagnosis, self.judgement))

    def write_page(self, file: Path) -> None:
        """That of the diagnosis."""
        self.diagnosed.write_page(file)
