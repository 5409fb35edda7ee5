"""What a calibration gives: parameters with intervals, motions with certificates, channels over time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.figure_files import save_both
from geocontact.analyses.result import Result
from geocontact.analyses.sit_to_stand.calibrate.figure import standing_figure
from geocontact.analyses.sit_to_stand.calibrate.options import StandingCalibrateOptions
from geocontact.analyses.sit_to_stand.calibrate.page import write_standing_page
from geocontact.analyses.sit_to_stand.calibrate.read import StandingTrials
from geocontact.analyses.sit_to_stand.calibrate.tables import (
    certificate_table,
    correlation_table,
    errors_table,
    parameters_table,
    trial_table,
)
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.dynamics.collocation.solve import CollocationResult
from geocontact.io.opensim.moco_trajectory_writer import write_moco_trajectory
from geocontact.io.text.results import write_table
from geocontact.standing_up.chain import COORDINATES, JOINTS
from geocontact.standing_up.contact_numbers import ContactNumbers

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingCalibrateResult(Result):
    """Parameters of the contacts, and the motions of all trials with them.

    Parameters
    ----------
    found
        How the search ended.
    numbers
        What the trials tell of each parameter.
    shares
        Of the cost, by term.
    """

    options: StandingCalibrateOptions
    given: StandingTrials
    found: CollocationResult
    numbers: ContactNumbers
    trials: tuple[TrialResult, ...]
    shares: Mapping[str, float]

    @property
    def accepted(self) -> bool:
        """Whether the search was solved and every motion is certified."""
        seen = [trial.judged.certificate for trial in self.trials]
        return self.found.solved and all(each is not None and each.converged for each in seen)

    @property
    def errors(self) -> pd.DataFrame:
        """Root mean square difference of each channel of each trial."""
        return errors_table(self.trials, self.given.noise, self.given.tracks)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`parameters`, `errors`, `certificate`, `correlation`, and `trial_NAME` for each trial."""
        own = {f"trial_{trial.recorded.name}": trial_table(trial, self.given.tracks) for trial in self.trials}
        return {
            "parameters": parameters_table(self.numbers),
            "errors": self.errors,
            "certificate": certificate_table(self.trials),
            "correlation": correlation_table(self.numbers),
            **own,
        }

    def figure(self) -> Figure:
        """Ground reaction and centre of pressure, measured and modelled."""
        return standing_figure(self.trials)

    def write_files(self, folder: Path) -> None:
        """Tables, trajectories, figure, page."""
        for name, rows in self.tables().items():
            write_table(rows, folder, name)
        for trial in self.trials:
            write_solution(folder / f"solution_{trial.recorded.name}.sto", trial, self.found.solved)
        save_both(self.figure(), folder, "standing_up")
        self.write_page(folder / "report.html")

    def write_page(self, file: Path) -> None:
        """Moving chains with forces, curves, parameters, inputs."""
        write_standing_page(file, self.record, self.given, self.trials, self.tables())


def write_solution(file: Path, trial: TrialResult, solved: bool) -> None:
    """The motion as OpenSim's Moco reads it; torques are those of both legs [N m]."""
    q, u = trial.model.q, trial.model.u

    def paths(ending: str, values: Float[np.ndarray, "t 6"]) -> dict[str, Float[np.ndarray, " t"]]:
        return {f"/jointset/{name}/{name}/{ending}": values[:, k] for k, name in enumerate(COORDINATES)}

    states = paths("value", q) | paths("speed", u)
    controls = {f"/forceset/{name}_torque": trial.torque[:, k] for k, name in enumerate(JOINTS)}
    write_moco_trajectory(file, trial.recorded.time, states, controls, paths("accel", trial.acceleration), solved)
