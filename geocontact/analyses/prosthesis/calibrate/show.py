"""What is shown of a calibration: curves by the plate and by the model, numbers with intervals."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import pandas as pd
from jaxtyping import Float
from numpy import ndarray

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import headline
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.view.curves.style import DOUBLE, GREY, PALETTE, in_style, panels
from geocontact.view.page.content import Curve, Curves, Page, Picture, Section, Words
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 0.09
"""Height of the drawing [m]."""
TITLES = ("x, along the walk", "y, upwards", "z, to the right")


@in_style
def stance_figure(stance: RecordedStance, predicted: Float[ndarray, "t 4"]) -> Figure:
    """Grey the plate, coloured the model."""
    figure, axes = panels(2, 2, DOUBLE, HEIGHT)
    for k, title in enumerate((*TITLES, "centre of pressure")):
        factor = 1.0 if k < 3 else 100.0
        axes[k].plot(stance.time, factor * stance.measured[:, k], color=GREY, lw=1.6, label="plate")
        axes[k].plot(stance.time, factor * predicted[:, k], color=PALETTE[0], lw=1.0, label="model")
        axes[k].set_title(title)
        axes[k].set_xlabel("time [s]")
        axes[k].set_ylabel("force [N]" if k < 3 else "from the heel [% of the foot]")
    axes[0].legend(fontsize=6, frameon=False)
    return figure


FIGURE = "Grey the plate, coloured the foot with the numbers below."
POSES = [
    "The keel is in equilibrium in every frame: its inertia is left out.",
    "The foot may slip beside its recorded speed, within its error, so that the force along the floor is the plate's.",
    "Friction is therefore told only where the foot slips in earnest.",
    "Height and pitch of the foot are sought besides, as constant errors of the standing trial.",
    "What errors of the poses do to each sample is in its weight.",
]
WALKED = [
    "The stance is simulated: inertia, socket and the free pelvis act, and the force is what comes of the start.",
    'The search began with the numbers in the column "along poses", found with a keel without inertia.',
    "Height and pitch of the foot are sought on, as constant errors of the standing trial.",
    "Angles are taken as they were recorded; what errors of the start, of hip and of knee do is in the weights.",
]
READ = [
    "Known: the data at least halve the width of the prior.",
    "Not identified: they do not; the value is stated beside its prior and has no interval.",
    "Unknown: the stance never loaded the zone, and the value is the usual one.",
    "Intervals count that residuals remember from frame to frame; they hold for this model, not beyond it.",
    "The last two rows, height and pitch of the foot (toes up) beside its standing trial, go into law.toml as [foot].",
]


def calibration_page(
    drawn: bytes,
    stance: RecordedStance,
    predicted: Float[ndarray, "t 4"],
    numbers: pd.DataFrame,
    sentences: Sequence[str],
    walked: bool,
) -> Page:
    """Curves, numbers and what they mean.

    Parameters
    ----------
    drawn
        The figure (SVG).
    walked
        Whether the numbers were found on the whole model.
    """
    curves = [
        Curves(title, unit, [Curve("plate", factor * stance.measured[:, k]), Curve("model", factor * predicted[:, k])])
        for k, (title, unit, factor) in enumerate(
            (
                ("Force along x", "N", 1.0),
                ("Force along y", "N", 1.0),
                ("Force along z", "N", 1.0),
                ("Centre of pressure from the heel", "% of the foot", 100.0),
            )
        )
    ]
    sections: list[Section] = [
        Picture("Plate and model", FIGURE, drawn),
        *curves,
        frame_table("Numbers of the zones", numbers, 3),
        INPUTS,
        OPTIONS,
        Words("What the numbers mean", (WALKED if walked else POSES) + READ),
    ]
    return Page(
        title="Calibrated sole of a prosthetic foot",
        subtitle="Stiffness, damping and friction of five zones from one stance",
        time=stance.time,
        time_label="time [s]",
        headline=headline(sentences),
        sections=tuple(sections),
        plays=False,
    )
