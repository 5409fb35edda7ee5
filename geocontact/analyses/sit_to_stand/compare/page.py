"""The page of a comparison: chains that stand up as predicted, curves beside the recording, errors by predictor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import pandas as pd

from geocontact.analyses.sit_to_stand.standing_page import motion_page
from geocontact.analyses.sit_to_stand.standing_scene import standing_curves, standing_scene
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.standing_up.chain import Subject
from geocontact.view.page.content import Page, Picture, Section
from geocontact.view.page.tables import frame_table

MEANT = [
    "Given yes: that predictor is told the channel, so that its error there is no prediction.",
    "All given: ground reaction, centre of pressure and torques; the others are told less.",
    "Mean and nearest of the calibration know how long the trial is; the nearest is so by first and last posture.",
    "R² is about the mean of what was recorded: below 0 that mean is the better model.",
]


def compared_page(
    sentences: Sequence[str],
    subject: Subject,
    trials: Sequence[TrialResult],
    drawn: bytes,
    tables: Mapping[str, pd.DataFrame],
) -> Page:
    """Moving chains, curves, errors by predictor."""
    sections: list[Section] = [
        standing_scene(subject, trials),
        Picture("Angles and strap of the first trial", "Grey as recorded.", drawn, wide=True),
        *standing_curves(trials),
        frame_table("Errors by trial, predictor and channel", tables["comparison"], 3),
        frame_table("Between and beyond the collocation points", tables["certificate"], 3),
    ]
    titles = (
        "Standing up, predicted and recorded",
        f"{', '.join(t.recorded.name for t in trials)}; contacts calibrated on other trials",
    )
    return motion_page(titles, sentences, sections, MEANT)
