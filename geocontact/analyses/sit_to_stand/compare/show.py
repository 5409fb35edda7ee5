"""What a comparison shows: chains that stand up as predicted, curves beside the recording, errors by predictor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.sit_to_stand.show import PARTS, motion_page, over_parts, standing_curves, standing_scene
from geocontact.standing_up.chain import COORDINATES, JOINTS, Subject
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingTrial
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, stroke
from geocontact.view.page.content import Page, Section
from geocontact.view.page.tables import frame_table

MEANT = [
    "Given yes: the predictor receives this channel, so its error there is not an error of prediction.",
    "All given: ground reaction, centre of pressure and torques; the others receive less.",
    "Mean and nearest of the calibration know its duration; the nearest has the most similar first and last posture.",
    "R² compares with the mean of the recording: below 0 that mean is the better model.",
]
PREDICTED = "{} of {}, by predictor"
"""Title of a panel, with the trial."""


def compared_page(
    sentences: Sequence[str],
    subject: Subject,
    trials: Sequence[TrialResult],
    predicted: CurveSheet,
    tables: Mapping[str, pd.DataFrame],
) -> Page:
    """Moving chains, curves, errors by predictor; `predicted` are those of `compared_curves`."""
    sections: list[Section] = [
        standing_scene(subject, trials),
        *predicted.panels,
        *standing_curves(trials),
        frame_table("Errors by trial, predictor and channel", tables["comparison"], 3),
        frame_table("Between and beyond the collocation points", tables["certificate"], 3),
    ]
    titles = (
        "Standing up, predicted and recorded",
        f"{', '.join(t.recorded.name for t in trials)}; contacts calibrated on other trials",
    )
    return motion_page(titles, sentences, sections, MEANT)


def compared_curves(recorded: StandingTrial, by: Mapping[str, StandingTrial]) -> CurveSheet:
    """A panel for each joint of the person and one for the strap: as recorded, and by each predictor."""
    strokes = {"recorded": INK} | {name: stroke(k, k) for k, name in enumerate(by)}
    shown = {name: _shown(trial) for name, trial in {"recorded": recorded, **by}.items()}
    panels = [
        Curves(
            PREDICTED.format(what, recorded.name),
            unit,
            [
                Curve(name, over_parts(recorded.time, own[what, unit]), stroke=strokes[name])
                for name, own in shown.items()
            ],
        )
        for what, unit in _shown(recorded)
    ]
    return CurveSheet(panels, PARTS)


def _shown(trial: StandingTrial) -> dict[tuple[str, str], Float[np.ndarray, " t"]]:
    angles = {(f"{name.capitalize()} angle", "deg"): np.degrees(trial.q[:, COORDINATES.index(name)]) for name in JOINTS}
    strap = np.full(len(trial.time), np.nan) if trial.strap is None else trial.strap
    return {**angles, ("Normal force of one strap", "N"): strap}
