"""What a comparison finds: errors by trial, channel and predictor, figure, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.result import REPORT, Result
from geocontact.analyses.sit_to_stand.compare.figure import compared_figure
from geocontact.analyses.sit_to_stand.compare.options import StandingCompareOptions
from geocontact.analyses.sit_to_stand.compare.page import compared_page
from geocontact.analyses.sit_to_stand.numbers_table import ran_table
from geocontact.analyses.sit_to_stand.predict.numbers import predicted_meshes, prediction_numbers
from geocontact.analyses.sit_to_stand.predict.predicted_trial import ALL, PredictedTrial
from geocontact.analyses.sit_to_stand.predict.read import HeldOutTrials
from geocontact.analyses.sit_to_stand.predict.searches import complete
from geocontact.analyses.sit_to_stand.standing_tables import certificate_rows
from geocontact.standing_up.trials import StandingTrial

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


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
        """Whether every trial is predicted, and every motion certified."""
        return complete(self.predictions, len(self.given.trials.trials))

    def tables(self) -> dict[str, pd.DataFrame]:
        """`comparison`, `certificate`, `numbers` and `mesh`."""
        rows = []
        for one in self.predictions:
            rows += certificate_rows(one.name, [one.trial.recorded.name], [one.trial.judged])
        return {
            "comparison": self.errors,
            "certificate": pd.DataFrame(rows).rename(columns={"phase": "predictor"}),
            "numbers": ran_table(prediction_numbers(self.predictions)),
            "mesh": predicted_meshes(self.predictions),
        }

    def figures(self) -> dict[str, Figure]:
        """`comparison`: angles and strap of the first trial."""
        first = self.given.trials.trials[0]
        own = {one.name: one.trial.model for one in self.predictions if one.trial.recorded.name == first.name}
        return {"comparison": compared_figure(first, {ALL: own[ALL], **self.trivial[first.name]})}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Moving chains, curves, errors by predictor."""
        best = [one.trial for one in self.predictions if one.name == ALL]
        drawn, subject = drawings["comparison"], self.given.trials.subject
        return {REPORT: compared_page(self.sentences, subject, best, drawn, self.tables())}
