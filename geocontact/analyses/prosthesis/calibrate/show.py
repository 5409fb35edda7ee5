"""What is shown of a calibration: curves by the plate and by the model, numbers with intervals."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float
from numpy import argmax, ndarray

from geocontact.analyses.frame.collector import contradicted
from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import rounded
from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.data.motion import Course
from geocontact.identify.signals.agreement import Agreement
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


@dataclass(frozen=True)
class CalibratedFit:
    """What the first screen says of a calibration.

    Parameters
    ----------
    vertical, centre
        Agreement of the vertical force over body weight, and of the centre of pressure over the foot.
    along
        What is said of the force along the floor.
    offset
        Of the foot, from its standing trial, in words.
    exponent
        Of the force law.
    """

    vertical: Agreement
    centre: Agreement
    along: str
    offset: str
    exponent: float


def answer(fit: CalibratedFit, numbers: pd.DataFrame) -> list[str]:
    """How well the calibrated sole makes the force on the plate, and how many of its numbers that identifies."""
    missed = (
        f"The calibrated sole misses the vertical force by {fit.vertical.rmsd:.1%} of body weight and the centre of "
        f"pressure by {fit.centre.rmsd:.1%} of the foot"
    )
    if contradicted():
        return [f"{missed}."]
    return [
        f"{missed}; the stance identifies {_identified(numbers)} of its numbers.",
        f"The force along the floor {fit.along}.",
        f"The foot is {fit.offset} off its standing trial.",
    ]


def _identified(numbers: pd.DataFrame) -> str:
    sole = numbers[~numbers["number"].str.startswith("foot.")]
    return f"{int((sole['verdict'] == 'known').sum())} of {len(sole)}"


def numbers_in_words(numbers: pd.DataFrame, exponent: float) -> pd.DataFrame:
    """Numbers as the page shows them: names in words, the exponent of the law in the unit, three digits."""
    unit = "N/m" if exponent == 1.0 else f"N/m^{exponent:.3g}"

    def text(value: object) -> object:
        return rounded(value, 3) if isinstance(value, float) and np.isfinite(value) else value

    named = [", ".join(each.replace("_", " ").split(".")) for each in numbers["number"]]
    units = [unit if each == "N/m^n" else each for each in numbers["unit"]]
    shown = numbers.assign(number=named, unit=units)
    for name in shown.select_dtypes("float").columns:
        shown[name] = shown[name].map(text)
    return shown


def calibration_page(
    stance: RecordedStance,
    curves: CurveSheet,
    numbers: pd.DataFrame,
    fit: CalibratedFit,
    walked: bool,
    several: pd.DataFrame | None = None,
) -> Page:
    """Curves, numbers and what they mean.

    Parameters
    ----------
    curves
        Those of `stance_curves`.
    walked
        Whether the numbers were found on the whole model.
    several
        Fit of each stance, where several were fitted together: curves are of the first.
    """
    sections: list[Section] = [
        *curves.panels,
        *([] if several is None else [frame_table("Stances that were fitted together", several, 3)]),
        frame_table("Numbers of the zones", numbers_in_words(numbers, fit.exponent), 3),
        INPUTS,
        OPTIONS,
        Words("What the numbers mean", (WALKED if walked else POSES) + READ),
    ]
    return Page(
        title="Calibrated sole of a prosthetic foot",
        subtitle="Stiffness, damping and friction of its zones from recorded stances",
        time=stance.time,
        time_label="time [s]",
        headline=answer(fit, numbers),
        facts=[
            ("vertical force missed by", f"{fit.vertical.rmsd:.1%} of body weight, R² {fit.vertical.r2:.2f}"),
            ("centre of pressure missed by", f"{fit.centre.rmsd:.1%} of the foot, R² {fit.centre.r2:.2f}"),
            *([] if contradicted() else [("numbers identified", _identified(numbers))]),
        ],
        start_frame=int(argmax(stance.measured[:, 1])),
        sections=tuple(sections),
        plays=False,
    )
