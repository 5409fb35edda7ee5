"""What a study comes to: the manifest of its trials, and their tables together."""

from __future__ import annotations

import shutil
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.figure_files import save_both
from geocontact.analyses.result import Result
from geocontact.analyses.results_folder import Scratch
from geocontact.io.text.results import write_table
from geocontact.study.collect import collect
from geocontact.study.curves import StudyCurves
from geocontact.study.description.trials import CohortTrial
from geocontact.study.latex import latex
from geocontact.study.page import REPORT, study_figure, study_page
from geocontact.study.read import PlannedStudy
from geocontact.study.store import RESULTS, Store
from geocontact.study.surface.tables import surface_difference_table, surface_fields, surface_table
from geocontact.study.surface.values import SurfaceValues
from geocontact.study.tables import agreement_table, difference_table, ensemble_table, outlier_table, value_table
from geocontact.study.trial_run import DONE, WRONG, TrialOutcome
from geocontact.view.page.write import write_page
from geocontact.view.surfaces.points_vtp import write_points_vtp

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MANIFEST = "trials"
PRINTED = ("values", "agreement")
"""Tables that are written as LaTeX too."""
WRONG_CODE, FAILED_CODE = 2, 1


@dataclass(frozen=True)
class StudiedTrial:
    """A trial, the address of its results, and what became of it."""

    trial: CohortTrial
    address: str
    outcome: TrialOutcome


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
    curves
        Of the columns that the summary is about.
    surface
        Distances at points that correspond, None where the study asks for none.
    scratch
        Holds the store where no folder was named.
    held
        Keeps other studies out of the folder until the tables are written.
    """

    planned: PlannedStudy
    trials: tuple[StudiedTrial, ...]
    store: Store
    curves: tuple[StudyCurves, ...]
    surface: SurfaceValues | None
    scratch: Scratch | None
    held: ExitStack

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
        """`trials`, a row for each with what became of it, then `ensemble` and other tables about all of them.

        The tables of all trials together are files: they may be larger than memory.
        """
        found = {
            MANIFEST: self._manifest(),
            "ensemble": ensemble_table(self.curves),
            "values": value_table(self.curves),
            "differences": difference_table(self.curves),
            "agreement": agreement_table(self.curves),
            "outliers": outlier_table(self.curves),
        }
        if self.surface is not None:
            found["surface"] = surface_table(self.surface)
            found["surface_differences"] = surface_difference_table(self.surface)
        return {name: table for name, table in found.items() if name == MANIFEST or len(table)}

    def _manifest(self) -> pd.DataFrame:
        names = list(dict.fromkeys(name for one in self.trials for name in one.trial.factors))
        rows = [
            {
                "name": one.trial.name,
                **{name: one.trial.factors.get(name, "") for name in names},
                "state": one.outcome.state,
                "folder": f"{RESULTS}/{one.address}" if one.outcome.state == DONE else "",
                "warnings [-]": len(self.store.told(one.address)["warnings"]) if one.outcome.state == DONE else 0,
                "words": one.outcome.line,
            }
            for one in self.trials
        ]
        return pd.DataFrame(rows)

    def figure(self) -> Figure | None:
        """Mean curves."""
        return study_figure(self.curves)

    def write_files(self, folder: Path) -> None:
        """Manifest, the tables of all trials together, the page; then other studies may write into the folder."""
        with self.held:
            self._write_files(folder)

    def _write_files(self, folder: Path) -> None:
        if self.scratch is not None:
            for one in self.done:
                shutil.copytree(self.store.place(one.address), folder / RESULTS / one.address, dirs_exist_ok=True)
        for name, table in self.tables().items():
            write_table(table, folder, name)
            if name in PRINTED:
                (folder / f"{name}.tex").write_text(latex(table), encoding="utf-8")
        collect([(one.trial, one.address) for one in self.done], self.store, folder)
        if self.surface is not None:
            write_points_vtp(folder / "surface.vtp", self.surface.points, surface_fields(self.surface))
        figure = self.figure()
        if figure is not None:
            save_both(figure, folder, "ensemble")
        self.write_page(folder / REPORT)

    def write_page(self, file: Path) -> None:
        """Mean curves, statistics, and all trials with a link to the page of each."""
        write_page(study_page(self.planned.file.title, self.record, self.curves, self.tables()), file)
