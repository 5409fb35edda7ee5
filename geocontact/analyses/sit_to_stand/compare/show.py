"""What a comparison shows: chains that stand up as predicted, curves beside the recording, errors by predictor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.sit_to_stand.show import motion_page, standing_curves, standing_scene
from geocontact.standing_up.chain import COORDINATES, JOINTS, Subject
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingTrial
from geocontact.view.curves.style import DOUBLE, GREY, LINES, PALETTE, in_style, panels
from geocontact.view.page.content import Page, Picture, Section
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MEANT = [
    "Given yes: that predictor is told the channel, so that its error there is no prediction.",
    "All given: ground reaction, centre of pressure and torques; the others are told less.",
    "Mean and nearest of the calibration know how long the trial is; the nearest is so by first and last posture.",
    "R² is about the mean of what was recorded: below 0 that mean is the better model.",
]
HEIGHT = 0.1
"""Height of the drawing [m]."""
STRAP = "normal force of one strap [N]"


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


@in_style
def compared_figure(recorded: StandingTrial, by: Mapping[str, StandingTrial]) -> Figure:
    """Grey as recorded; a panel for each joint of the person, and one for the strap."""
    figure, axes = panels(2, 2, DOUBLE, HEIGHT)
    for k, (name, trial) in enumerate({"recorded": recorded, **by}.items()):
        colour, line = (GREY, "-") if not k else (PALETTE[k - 1], LINES[k - 1])
        for ax, values in zip(axes, _shown(trial).values(), strict=True):
            ax.plot(trial.time, values, color=colour, ls=line, lw=1.2, label=name)
    for ax, label in zip(axes, _shown(recorded), strict=True):
        ax.set_xlabel("time since seat-off [s]")
        ax.set_ylabel(label)
    axes[0].legend(fontsize=6, frameon=False)
    return figure


def _shown(trial: StandingTrial) -> dict[str, Float[np.ndarray, " t"]]:
    angles = {f"{name} [°]": np.degrees(trial.q[:, COORDINATES.index(name)]) for name in JOINTS}
    return {**angles, STRAP: np.full(len(trial.time), np.nan) if trial.strap is None else trial.strap}
