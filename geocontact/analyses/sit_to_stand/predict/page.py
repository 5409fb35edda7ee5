"""The page of a prediction: chains that stand up as predicted, curves beside the recording, errors by predictor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.figure_files import drawing
from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.predict.read import HeldOutTrials
from geocontact.analyses.sit_to_stand.standing_page import write_motion_page
from geocontact.analyses.sit_to_stand.standing_scene import standing_curves, standing_scene
from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.view.page.content import Picture, Section
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MODEL = [
    "Ground reaction, centre of pressure and torques are given over time, first and last posture within their noise.",
    "Coordinates between them and the strap's force are predicted; parameters are held.",
    "Without ground reaction, without torques: the same with less given.",
    "Mean of the calibration: coordinates and strap of its trials over parts of the movement.",
    "Both legs are one planar chain: torques and the ground's force are those of both, a strap is that of one.",
]


def write_prediction_page(
    path: Path,
    record: Record,
    given: HeldOutTrials,
    trials: Sequence[TrialResult],
    figure: Figure,
    tables: Mapping[str, pd.DataFrame],
) -> int:
    """Write the self-contained page; returns its size in bytes."""
    sections: list[Section] = [
        standing_scene(given.trials.subject, trials),
        *standing_curves(trials),
        Picture("The strap by each predictor", "Grey as recorded.", drawing(figure)),
        frame_table("Root mean square differences", tables["errors"], 3),
        frame_table("Between and beyond the collocation points", tables["certificate"], 3),
    ]
    titles = (
        "Standing up, predicted",
        f"{', '.join(t.recorded.name for t in trials)}; contacts calibrated on other trials",
    )
    return write_motion_page(path, record, titles, sections, MODEL)
