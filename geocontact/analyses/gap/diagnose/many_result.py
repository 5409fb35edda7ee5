"""What the diagnoses of many cases come to."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from geocontact.analyses.gap.diagnose.options import ManyOptions
from geocontact.analyses.result import Part, Result
from geocontact.analyses.results_folder import Scratch

SUMMARY = "summary"
FAILED = 1


@dataclass(frozen=True)
class Outcome:
    """What became of one case.

    Parameters
    ----------
    code
        0 done, 2 for a mistake in the input, 1 for any other failure.
    line
        What it says: the verdict, or what is wrong.
    warnings
        Reservations.
    row
        Of the summary.
    """

    name: str
    code: int
    line: str
    warnings: tuple[str, ...] = ()
    row: tuple[tuple[str, str | float], ...] = ()


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ManyResult(Result):
    """Diagnoses of the cases in a folder, each in a sub-folder of its own.

    Parameters
    ----------
    outcomes
        What became of each case, by name.
    scratch
        Where the results of each case lie until they are written.
    """

    options: ManyOptions
    outcomes: tuple[Outcome, ...]
    scratch: Scratch

    @property
    def done(self) -> tuple[Outcome, ...]:
        """Cases that could be diagnosed."""
        return tuple(one for one in self.outcomes if one.code == 0)

    @property
    def accepted(self) -> bool:
        """False where a case could not be diagnosed."""
        return len(self.done) == len(self.outcomes)

    @property
    def exit_code(self) -> int:
        """That of the worst case."""
        codes = {one.code for one in self.outcomes}
        return FAILED if FAILED in codes else max(codes)

    @property
    def title(self) -> str:
        """With the folder of the cases."""
        return f"Gap diagnoses of {self.options.case.name}"

    @property
    def parts(self) -> frozenset[Part]:
        """The summary alone; pages are those of the cases."""
        return frozenset(("tables",))

    def tables(self) -> dict[str, pd.DataFrame]:
        """`summary`: a row for each case that could be diagnosed."""
        return {SUMMARY: pd.DataFrame([dict(one.row) for one in self.done])}

    def write_files(self, folder: Path) -> None:
        """Also all results of each case in a sub-folder of its name."""
        super().write_files(folder)
        for one in self.done:
            shutil.copytree(self.scratch.folder / one.name, folder / one.name)
