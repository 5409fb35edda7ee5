"""Every number of predictions as they ran."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd

from geocontact.analyses.sit_to_stand.numbers_table import GIVEN, mesh_table, sizes_of
from geocontact.analyses.sit_to_stand.predict.predicted_trial import PredictedTrial
from geocontact.standing_up.numbers_that_ran import (
    Ran,
    end_numbers,
    model_numbers,
    parameter_numbers,
    search_numbers,
    size_numbers,
)


def prediction_numbers(predictions: Sequence[PredictedTrial]) -> list[Ran]:
    """Of the model, the parameters and the cost once, which all predictors share; of each motion its mesh."""
    first = predictions[0]
    rows = model_numbers(first.model) + parameter_numbers(first.phase.parameters, first.p, note=GIVEN)
    rows += size_numbers(sizes_of(first.phase)) + end_numbers(first.phase.control)
    for one in predictions:
        rows += search_numbers([one.motion], [one.trial.recorded], f"{one.name} ")
    return rows


def predicted_meshes(predictions: Sequence[PredictedTrial]) -> pd.DataFrame:
    """Of every motion."""
    return mesh_table("predictor", [(one.name, [one.motion]) for one in predictions])
