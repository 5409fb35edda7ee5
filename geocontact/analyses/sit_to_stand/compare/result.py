"""What a comparison finds: errors by trial, channel and predictor, figure, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from geocontact.analyses.figure_files import drawing, save_both
from geocontact.analyses.options_table import options_table
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.analyses.result import Result
from geocontact.analyses.sit_to_stand.compare.figure import compared_figure
from geocontact.analyses.sit_to_stand.compare.options import StandingCompareOptions
from geocontact.analyses.sit_to_stand.predict.read import HeldOutTrials
from geocontact.analyses.sit_to_stand.predict.result import ALL, PredictedTrial
from geocontact.analyses.sit_to_stand.standing_scene import FRAMES, standing_curves, standing_scene
from geocontact.analyses.sit_to_stand.standing_tables import certificate_rows
from geocontact.io.text.results import write_table
from geocontact.standing_up.trials import StandingTrial
from geocontact.view.page.content import Page, Picture, Words
from geocontact.view.page.tables import frame_table, inputs_table
from geocontact.view.page.write import write_page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MEANT = [
    "Given yes: that predictor is told the channel, so that its error there is no prediction.",
    "All given: ground reaction, centre of pressure and torques; the others are told less.",
    "Mean and nearest of the calibration know how long the trial is; the nearest is so by first and last posture.",
    "R² is about the mean of what was recorded: below 0 that mean is the better model.",
]


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class StandingCompareResult(Result):
    """Predictions beside recordings.

    Parameters
    ----------
    predictions
        Trials outer, predictors inner.
    trivial
        Predictors without a model, by trial and name.
    errors
        One row for each trial, predictor and channel.
    """

    options: StandingCompareOptions
    given: HeldOutTrials
    predictions: tuple[PredictedTrial, ...]
    trivial: Mapping[str, Mapping[str, StandingTrial]]
    errors: pd.DataFrame

    @property
    def accepted(self) -> bool:
        """Whether every motion is certified."""
        seen = [one.trial.judged.certificate for one in self.predictions]
        return all(each is not None and each.converged for each in seen)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`comparison` and `certificate`."""
        rows = []
        for one in self.predictions:
            rows += certificate_rows(one.name, [one.trial.recorded.name], [one.trial.judged])
        return {
            "comparison": self.errors,
            "certificate": pd.DataFrame(rows).rename(columns={"phase": "predictor"}),
        }

    def figure(self) -> Figure:
        """Angles and strap of the first trial."""
        first = self.given.trials.trials[0]
        own = {one.name: one.trial.model for one in self.predictions if one.trial.recorded.name == first.name}
        return compared_figure(first, {ALL: own[ALL], **self.trivial[first.name]})

    def write_files(self, folder: Path) -> None:
        """Tables, figure, page."""
        for name, rows in self.tables().items():
            write_table(rows, folder, name)
        save_both(self.figure(), folder, "comparison")
        self.write_page(folder / "report.html")

    def write_page(self, file: Path) -> None:
        """Moving chains, curves, errors by predictor, inputs."""
        best = [one.trial for one in self.predictions if one.name == ALL]
        page = Page(
            title="Standing up, predicted and recorded",
            subtitle=f"{', '.join(t.recorded.name for t in best)}; contacts calibrated on other trials",
            time=np.linspace(0.0, 100.0, FRAMES),
            time_label="part of the movement [%]",
            headline=headline(self.sentences),
            reservations=tuple(self.record.warnings),
            sections=(
                standing_scene(self.given.trials.subject, best),
                Picture("Angles and strap of the first trial", "Grey as recorded.", drawing(self.figure()), wide=True),
                *standing_curves(best),
                frame_table("Errors by trial, predictor and channel", self.errors, 3),
                frame_table("Between and beyond the collocation points", self.tables()["certificate"], 3),
                inputs_table(self.record.inputs),
                options_table(self.record),
                Words("What the numbers mean", [*MEANT, NOT_A_DEVICE]),
            ),
        )
        write_page(page, file)
