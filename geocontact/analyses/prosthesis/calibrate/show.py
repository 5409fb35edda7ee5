"""What is shown of a calibration: curves by the plate and by the model, numbers with intervals."""

from __future__ import annotations

from collections.abc import Sequence

import pandas as pd
from jaxtyping import Float
from numpy import argmax, ndarray

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import headline
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.data.motion import Course
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet
from geocontact.view.page.content import Page, Section, Words
from geocontact.view.page.tables import frame_table

QUANTITIES = (
    (1, "Force along y, upwards", "N", 1.0),
    (0, "Force along x, the walk", "N", 1.0),
    (2, "Force along z, to the right", "N", 1.0),
    (3, "Centre of pressure from the heel", "% of the foot", 100.0),
)
"""Column, title, unit and factor of what a plate measures and the model predicts."""


def stance_curves(stance: RecordedStance, predicted: Float[ndarray, "t 4"]) -> CurveSheet:
    """Force and centre of pressure by plate and model."""
    panels = [
        Curves(
            title,
            unit,
            [
                Curve("plate", factor * stance.measured[:, k], stroke=INK),
                Curve("model", factor * predicted[:, k], stroke=0),
            ],
        )
        for k, title, unit, factor in QUANTITIES
    ]
    return CurveSheet(panels, Course("time", "s", stance.time))


POSES = [
    "The keel is in equilibrium in every frame: its inertia is left out.",
    "The foot may slip against its recorded speed, within its error, so that the force along the floor is the plate's.",
    "Friction is therefore identified only where the foot really slips.",
    "Height and pitch of the foot are identified as well, as constant errors of the standing trial.",
    "What errors of the poses do to each sample is in its weight.",
]
WALKED = [
    "The stance is simulated: inertia, socket and the free pelvis act, and the force is what comes of the start.",
    'The search began with the numbers in the column "along poses", found with a keel without inertia.',
    "Height and pitch of the foot continue to be identified, as constant errors of the standing trial.",
    "Angles are taken as they were recorded; what errors of the start, of hip and of knee do is in the weights.",
]
READ = [
    "Known: the data at least halve the width of the prior.",
    "Not identified: they do not; the value is stated with its prior and has no interval.",
    "Unknown: the stance never loaded the zone, and the value is the usual one.",
    "Intervals count that residuals remember from frame to frame; they hold for this model, not beyond it.",
    "The last two rows, height and pitch of the foot (toes up) off its standing trial, go into law.toml as [foot].",
]


def calibration_page(
    stance: RecordedStance,
    curves: CurveSheet,
    numbers: pd.DataFrame,
    sentences: Sequence[str],
    walked: bool,
) -> Page:
    """Curves, numbers and what they mean.

    Parameters
    ----------
    curves
        Those of `stance_curves`.
    walked
        Whether the numbers were found on the whole model.
    """
    sections: list[Section] = [
        *curves.panels,
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
        start_frame=int(argmax(stance.measured[:, 1])),
        sections=tuple(sections),
        plays=False,
    )
