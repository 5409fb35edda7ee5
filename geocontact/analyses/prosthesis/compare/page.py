"""The page of a comparison: ensembles, errors beside trivial predictors, outliers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.analyses.prosthesis.compare.tables import UNITS, by_setting, curves_of, plain_curves
from geocontact.below_knee_prosthesis.evaluation.judged_stance import JudgedStance
from geocontact.below_knee_prosthesis.evaluation.trivial_predictors import ANOTHER, MEAN
from geocontact.view.page.content import Curve, Curves, Page, Picture, Section, Words
from geocontact.view.page.tables import frame_table

FIGURE = (
    "Grey the plates, coloured the model: mean over a setting's stances, a band of one standard deviation. Dashed the "
    "two predictors without a model."
)
SHOWN = {
    "vertical": "Vertical force over body weight",
    "fore_aft": "Fore-aft force over body weight, forward positive",
    "medio_lateral": "Sideways force over body weight",
    "cop_ground": "Centre of pressure from heel to toe, share of the foot",
    "ankle_moment": "Ankle moment over body mass",
}
STROKES = ("model", "plate", MEAN, ANOTHER)
"""Numbers of their colours and dashes: one thing looks alike in all panels."""
WITHOUT = [
    "Both predictors without a model know when the stance on the plate begins and ends; the simulation has to find it.",
    "Mean of the others: of the same person's other trials at any setting; of all others where there are none.",
    "Another setting: the plate of the person's first trial on another setting of the foot.",
    "The pelvis is free upwards, so that the impulse is nearly body weight times time, whatever the foot is.",
]
MEASURES = [
    (
        "Errors are over the stance that the plate saw. The study takes a quarter of a second of swing on both sides "
        "as well, where both forces are nothing, which makes its errors smaller."
    ),
    "Force and centre of pressure of the other leg are recorded and given; trials that a sole was fitted to are apart.",
    "An outlier is further off than three standard deviations by the study's rule, or by the median.",
]


def comparison_page(
    drawn: bytes, stances: Sequence[JudgedStance], tables: Mapping[str, pd.DataFrame], sentences: Sequence[str]
) -> Page:
    """Ensembles, errors beside trivial predictors, outliers; `drawn` is the figure (SVG)."""
    sections: list[Section] = [
        Picture("Ensembles by setting", FIGURE, drawn, wide=True),
        frame_table("Means by setting, beside predictors without a model", tables["summary"], 3),
        frame_table("Stances", tables["trials"], 3),
        *comparison_panels(stances),
        frame_table("Errors of each stance", tables["errors"], 3),
        INPUTS,
        OPTIONS,
        Words("How to read the numbers", [*WITHOUT, *MEASURES, NOT_A_DEVICE]),
    ]
    return Page(
        title=f"{len(stances)} prosthetic stances beside their plates",
        subtitle="Ground reaction, centre of pressure and ankle moment of a variable-stiffness foot",
        time=100.0 * stances[0].errors.share,
        time_label="stance on the plate [%]",
        headline=headline(sentences, most=2),
        sections=tuple(sections),
        plays=False,
    )


def comparison_panels(stances: Sequence[JudgedStance]) -> list[Curves]:
    """Of each quantity and setting: plate and model with a band of one standard deviation, both predictors."""
    return [
        _panel(f"{title}: {setting}", name, own, plain_curves(stances, name))
        for name, title in SHOWN.items()
        for setting, own in by_setting(stances).items()
    ]


def _panel(
    title: str,
    name: str,
    own: Sequence[JudgedStance],
    plain: Mapping[str, Mapping[str, Float[np.ndarray, " s"]]],
) -> Curves:
    found = []
    for label, curves in (
        ("model", [one.simulated(name) for one in own]),
        ("plate", [one.measured(name) for one in own]),
        *((label, curves_of(plain, own, label)) for label in (MEAN, ANOTHER)),
    ):
        if not curves:
            continue
        mean, sd = np.mean(curves, axis=0), np.std(curves, axis=0)
        lower, upper = (mean - sd, mean + sd) if len(own) > 1 and label in ("model", "plate") else (None, None)
        found.append(Curve(label, mean, lower, upper, STROKES.index(label)))
    return Curves(title, UNITS.get(name, "-"), found)
