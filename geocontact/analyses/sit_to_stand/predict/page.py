"""The page of a prediction: chains that stand up as predicted, curves beside the recording, errors by predictor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pandas as pd

from geocontact.analyses.sit_to_stand.predict.read import HeldOutTrials
from geocontact.analyses.sit_to_stand.standing_page import motion_page
from geocontact.analyses.sit_to_stand.standing_scene import standing_curves, standing_scene
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.view.page.content import Page, Picture, Section
from geocontact.view.page.tables import frame_table

MODEL = [
    "Ground reaction, centre of pressure and torques are given over time, first and last posture within their noise.",
    "Coordinates between them and the strap's force are predicted; parameters are held.",
    "Without ground reaction, without torques: the same with less given.",
    "Mean of the calibration: coordinates and strap of its trials over parts of the movement.",
    "Both legs are one planar chain: torques and the ground's force are those of both, a strap is that of one.",
]


def prediction_page(
    sentences: Sequence[str],
    given: HeldOutTrials,
    trials: Sequence[TrialResult],
    drawn: bytes,
    tables: Mapping[str, pd.DataFrame],
) -> Page:
    """Moving chains with forces, curves, errors by predictor."""
    sections: list[Section] = [
        standing_scene(given.trials.subject, trials),
        *standing_curves(trials),
        Picture("The strap by each predictor", "Grey as recorded.", drawn),
        frame_table("Root mean square differences", tables["errors"], 3),
        frame_table("Between and beyond the collocation points", tables["certificate"], 3),
    ]
    titles = (
        "Standing up, predicted",
        f"{', '.join(t.recorded.name for t in trials)}; contacts calibrated on other trials",
    )
    return motion_page(titles, sentences, sections, MODEL)
