"""What a study comes to: the manifest of its trials, and their tables together."""

from __future__ import annotations

import shutil
from dataclasses import dataclass
from pathlib import Path

import pandas as pd

from geocontact.analyses.plain_page import write_plain_page
from geocontact.analyses.result import Result
from geocontact.analyses.results_folder import Scratch
from geocontact.io.text.results import write_table
from geocontact.study.collect import collect
from geocontact.study.read import PlannedStudy
from geocontact.study.store import RESULTS, Store
from geocontact.study.trial_run import DONE, WRONG, Outcome
from geocontact.study.trials import StudyTrial

MANIFEST = "trials"
WRONG_CODE, FAILED_CODE = 2, 1


@dataclass(frozen=True)
class StudiedTrial:
    """A trial, the address of its results, and what became of it."""

    trial: StudyTrial
    address: str
    outcome: Outcome


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class CohortResult(Result):
    """Results of all trials of a study.

    Parameters
    ----------
    planned
        The study as described.
    trials
        In the order of the description.
    store
        Where their results are.
    scratch
        Holds the store where no folder was named.
    """

    planned: PlannedStudy
    trials: tuple[StudiedTrial, ...]
    store: Store
    scratch: Scratch | None

    @property
    def done(self) -> tuple[StudiedTrial, ...]:
        """Trials with results."""
        return tuple(one for one in self.trials if one.outcome.state == DONE)

    @property
    def accepted(self) -> bool:
        """False where a trial could not be evaluated."""
        return len(self.done) == len(self.trials)

    @property
    def exit_code(self) -> int:
        """1 where a trial failed, 2 where none did but one had a mistake in its input."""
        states = {one.outcome.state for one in self.trials}
        return 0 if states == {DONE} else WRONG_CODE if states <= {DONE, WRONG} else FAILED_CODE

    def tables(self) -> dict[str, pd.DataFrame]:
        """`trials`: a row for each trial, what it differs in, what became of it, the folder of its results."""
        names = list(dict.fromkeys(name for one in self.trials for name in one.trial.factors))
        rows = [
            {
                "name": one.trial.name,
                **{name: one.trial.factors.get(name, "") for name in names},
                "state": one.outcome.state,
                "folder": f"{RESULTS}/{one.address}" if one.outcome.state == DONE else "",
                "words": one.outcome.line,
            }
            for one in self.trials
        ]
        return {MANIFEST: pd.DataFrame(rows)}

    def write_files(self, folder: Path) -> None:
        """Manifest, the tables of all trials together, the page."""
        if self.scratch is not None:
            for one in self.done:
                shutil.copytree(self.store.place(one.address), folder / RESULTS / one.address, dirs_exist_ok=True)
        write_table(self.table(), folder, MANIFEST)
        collect([(one.trial, one.address) for one in self.done], self.store, folder)
        self.write_page(folder / "report.html")

    def write_page(self, file: Path) -> None:
        """The manifest."""
        write_plain_page(self, self.planned.file.title, file)
