"""What a prediction gives: motions beside the recorded ones, and how far each predictor is off."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from geocontact.analyses.result import REPORT, Result
from geocontact.analyses.sit_to_stand.exports import write_motion
from geocontact.analyses.sit_to_stand.numbers_table import ran_table
from geocontact.analyses.sit_to_stand.predict.figure import strap_figure
from geocontact.analyses.sit_to_stand.predict.numbers import predicted_meshes, prediction_numbers
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.predict.page import prediction_page
from geocontact.analyses.sit_to_stand.predict.predicted_trial import ALL, MEAN, PredictedTrial
from geocontact.analyses.sit_to_stand.predict.read import HeldOutTrials
from geocontact.analyses.sit_to_stand.predict.searches import complete
from geocontact.analyses.sit_to_stand.standing_tables import certificate_rows, errors_table, trial_table
from geocontact.analyses.sit_to_stand.trial_result import DEGREE, TrialResult
from geocontact.io.text.results import write_table
from geocontact.standing_up.chain import COORDINATES
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.trials import StandingTrial

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page

COMPARED = ("coordinates", "force", "centre", "torque", "strap")


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingPredictResult(Result):
    """Predicted motions.

    Parameters
    ----------
    predictions
        Trials outer, predictors inner.
    means
        The trivial predictor, by trial.
    """

    options: StandingPredictOptions
    given: HeldOutTrials
    predictions: tuple[PredictedTrial, ...]
    means: Mapping[str, StandingTrial]

    @property
    def best(self) -> tuple[TrialResult, ...]:
        """Trials by the predictor that is given everything."""
        return tuple(one.trial for one in self.predictions if one.name == ALL)

    @property
    def accepted(self) -> bool:
        """Whether every trial is predicted, and every motion certified."""
        return complete(self.predictions, len(self.given.trials.trials))

    @property
    def errors(self) -> pd.DataFrame:
        """Root mean square difference of each channel by each predictor."""
        parts = []
        for one in self.predictions:
            rows = errors_table([one.trial], self.given.trials.noise, COMPARED)
            parts.append(rows.assign(predictor=one.name))
        parts.append(pd.DataFrame([row for trial in self.best for row in self._by_the_mean(trial)]))
        columns = ["trial", "predictor", "quantity", "unit", "rmsd", "noise"]
        return pd.concat(parts, ignore_index=True)[columns]

    def _by_the_mean(self, trial: TrialResult) -> list[dict[str, object]]:
        seen, mean, noise = trial.recorded, self.means[trial.recorded.name], self.given.trials.noise
        columns = [
            (name, "deg", DEGREE, mean.q[:, k] - seen.q[:, k], noise.angle)
            for k, name in enumerate((*COORDINATES, *EXO_JOINTS))
            if k > 1
        ]
        if seen.strap is not None and mean.strap is not None:
            columns.append(("strap", "N", 1.0, mean.strap - seen.strap, noise.strap))
        columns += [
            (f"{site} strap", "N", 1.0, mean.elsewhere[site] - force, noise.strap)
            for site, force in seen.elsewhere.items()
            if site in mean.elsewhere
        ]
        return [
            {
                "trial": seen.name,
                "predictor": MEAN,
                "quantity": name,
                "unit": unit,
                "rmsd": factor * float(np.sqrt(np.mean(off**2))),
                "noise": factor * size,
            }
            for name, unit, factor, off, size in columns
            if np.isfinite(off).all()
        ]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`errors`, `certificate`, `numbers`, `mesh`, and `trial_NAME` by the predictor that is given everything."""
        rows = []
        for one in self.predictions:
            rows += certificate_rows(one.name, [one.trial.recorded.name], [one.trial.judged])
        certificates = pd.DataFrame(rows).rename(columns={"phase": "predictor"})
        own = {
            f"trial_{trial.recorded.name}": trial_table(trial, self.given.trials.noise, COMPARED) for trial in self.best
        }
        ran = {"numbers": ran_table(prediction_numbers(self.predictions)), "mesh": predicted_meshes(self.predictions)}
        return {"errors": self.errors, "certificate": certificates, **ran, **own}

    def figures(self) -> dict[str, Figure]:
        """`strap`: its force by all predictors."""
        return {"strap": strap_figure([(one.name, one.trial) for one in self.predictions], self.means)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Moving chains with forces, curves, errors by predictor."""
        return {REPORT: prediction_page(self.sentences, self.given, self.best, drawings["strap"], self.tables())}

    def write_files(self, folder: Path) -> None:
        """Trajectories; tables, figure, page."""
        self._write_motions(folder)
        super().write_files(folder)

    def write_numbers(self, folder: Path) -> None:
        """Tables and trajectories of the trials that there are."""
        for name, rows in self.tables().items():
            write_table(rows, folder, name)
        self._write_motions(folder)

    def _write_motions(self, folder: Path) -> None:
        for one in self.predictions:
            if one.name == ALL:
                write_motion(folder, self.given.trials.subject, one.trial, self.given.values, one.solved)
