"""What a calibration gives: parameters with intervals, motions with certificates, channels over time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.result import REPORT, Result
from geocontact.analyses.sit_to_stand.calibrate.numbers import calibration_numbers
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.calibrate.page import calibration_page
from geocontact.analyses.sit_to_stand.calibrate.tables import (
    certificate_table,
    correlation_table,
    parameters_table,
    profile_table,
)
from geocontact.analyses.sit_to_stand.exports import write_motion
from geocontact.analyses.sit_to_stand.gap_files import write_strap_case
from geocontact.analyses.sit_to_stand.model_file import write_standing_model
from geocontact.analyses.sit_to_stand.numbers_table import mesh_table, ran_table
from geocontact.analyses.sit_to_stand.standing_figure import standing_figure
from geocontact.analyses.sit_to_stand.standing_tables import errors_table, trial_table
from geocontact.analyses.sit_to_stand.standing_trials import StandingUpTrials
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.standing_up.calibrated_phase import CalibratedPhase

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingCalibrateResult(Result):
    """Parameters of the contacts, and the motions of all trials with them.

    Parameters
    ----------
    phases
        A, and B where an exoskeleton was worn.
    trials
        Channels by the last of them.
    """

    options: StandingCalibrateOptions
    given: StandingUpTrials
    phases: tuple[CalibratedPhase, ...]
    trials: tuple[TrialResult, ...]

    @property
    def found(self) -> CollocationResult:
        """How the last search ended."""
        return self.phases[-1].found

    @property
    def accepted(self) -> bool:
        """Whether all phases were solved and every motion is certified."""
        wanted = 2 if self.given.exoskeleton else 1
        return len(self.phases) == wanted and all(phase.certified for phase in self.phases)

    @property
    def errors(self) -> pd.DataFrame:
        """Root mean square difference of each channel of each trial."""
        return errors_table(self.trials, self.given.noise, self.given.tracks)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`parameters`, `errors`, `certificate`, `correlation`, `numbers`, `mesh`, `trial_NAME`; `profiles` too."""
        noise, tracks = self.given.noise, self.given.tracks
        own = {f"trial_{trial.recorded.name}": trial_table(trial, noise, tracks) for trial in self.trials}
        return {
            "parameters": parameters_table(self.phases),
            "errors": self.errors,
            "certificate": certificate_table(self.phases),
            "correlation": correlation_table(self.phases),
            **({"profiles": profile_table(self.phases)} if self.options.profiles else {}),
            "numbers": ran_table(calibration_numbers(self.phases, self.given.trials)),
            "mesh": mesh_table("phase", [(phase.name, phase.found.motions) for phase in self.phases]),
            **own,
        }

    def figures(self) -> dict[str, Figure]:
        """`standing_up`: ground reaction and centre of pressure, measured and modelled."""
        return {"standing_up": standing_figure(self.trials)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Moving chains with forces, curves, parameters."""
        return {REPORT: calibration_page(self.sentences, self.given, self.trials, self.tables())}

    def write_files(self, folder: Path) -> None:
        """Trajectories and model, the strap's case for `gap gather`; tables, figure, page."""
        values = {n.name: n.value for n in self.phases[-1].numbers.numbers}
        for trial in self.trials:
            write_motion(folder, self.given.subject, trial, values, self.found.solved)
        write_standing_model(folder / "model.osim", self.given.subject, values, worn=self.given.exoskeleton)
        if self.phases[-1].name == "B":
            write_strap_case(folder / "gap", self.given.subject, self.given.trials, values)
        super().write_files(folder)
