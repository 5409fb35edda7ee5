"""What is shown of a comparison: ensembles by setting, errors beside trivial predictors, outliers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, counted, headline
from geocontact.below_knee_prosthesis.comparison import by_setting, curves_of, plain_curves
from geocontact.below_knee_prosthesis.evaluation import ANOTHER, MEAN, JudgedStance
from geocontact.data.motion import Course
from geocontact.view.curves.declared import INK, Curve, Curves, CurveSheet, stroke
from geocontact.view.page.content import Page, Section, Words
from geocontact.view.page.tables import frame_table

SHOWN = {
    "vertical": ("Vertical force", "BW", 1.0),
    "fore_aft": ("Fore-aft force, forward positive", "BW", 1.0),
    "medio_lateral": ("Sideways force", "BW", 1.0),
    "cop_ground": ("Centre of pressure from heel to toe", "% of the foot", 100.0),
    "ankle_moment": ("Ankle moment over body mass", "N m/kg", 1.0),
}
"""Title, unit and factor of the quantities that are drawn."""
STROKES = {"plate": INK, "model": stroke(0), MEAN: stroke(1, 1), ANOTHER: stroke(2, 2)}
"""One thing looks alike in all panels."""
WIDEST = 3
"""Settings side by side in the figure."""
WORDS = "Mean over the stances of a setting, a band of one standard deviation; both predictors know no model."
WITHOUT = [
    "Both predictors without a model know when the stance on the plate begins and ends; the simulation predicts it.",
    "Mean of the others: of the same person's other trials at any setting; of all others where there are none.",
    "Another setting: the plate of the person's first trial on another setting of the foot.",
    "The pelvis is free upwards, so that the impulse is nearly body weight times time, whatever the foot is.",
]
MEASURES = [
    (
        "Errors are over the stance that the plate saw. The study takes a quarter of a second of swing on both sides "
        "as well, where both forces are nothing, which makes its errors smaller."
    ),
    "Force and centre of pressure of the other leg are recorded and given; trials of a sole fit are listed apart.",
    "An outlier deviates by more than three standard deviations by the study's rule, or by the median.",
]


def comparison_page(
    stances: Sequence[JudgedStance], tables: Mapping[str, pd.DataFrame], sentences: Sequence[str]
) -> Page:
    """Ensembles, errors beside trivial predictors, outliers."""
    sections: list[Section] = [
        *comparison_curves(stances).panels,
        frame_table("Means by setting, compared with baseline predictors", tables["summary"], 3),
        frame_table("Stances", tables["trials"], 3),
        frame_table("Errors of each stance", tables["errors"], 3),
        INPUTS,
        OPTIONS,
        Words("How to read the numbers", [*WITHOUT, *MEASURES, NOT_A_DEVICE]),
    ]
    return Page(
        title=f"{len(stances)} prosthetic stances compared with their plates",
        subtitle="Ground reaction, centre of pressure and ankle moment of a variable-stiffness foot",
        time=100.0 * stances[0].errors.share,
        time_label="stance on the plate [%]",
        headline=headline(sentences, most=2),
        sections=tuple(sections),
        start_frame=len(stances[0].errors.share) // 2,
        plays=False,
    )


def comparison_curves(stances: Sequence[JudgedStance]) -> CurveSheet:
    """Curves of each quantity and setting: plate and model with a band of one standard deviation, both predictors."""
    settings = by_setting(stances)
    panels = [
        _panel(name, f"{setting}, {counted(len(own), 'stance')}", own, plain)
        for name in SHOWN
        for plain in [plain_curves(stances, name)]
        for setting, own in settings.items()
    ]
    over = Course("stance on the plate", "%", 100.0 * stances[0].errors.share)
    return CurveSheet(panels, over, min(len(settings), WIDEST))


def _panel(
    name: str, where: str, own: Sequence[JudgedStance], plain: Mapping[str, Mapping[str, Float[np.ndarray, " s"]]]
) -> Curves:
    title, unit, factor = SHOWN[name]
    found = []
    for label, curves in (
        ("plate", [one.measured(name) for one in own]),
        ("model", [one.simulated(name) for one in own]),
        *((label, curves_of(plain, own, label)) for label in (MEAN, ANOTHER)),
    ):
        if not curves:
            continue
        mean, sd = factor * np.mean(curves, axis=0), factor * np.std(curves, axis=0)
        spread = len(own) > 1 and label in ("model", "plate")
        lower, upper = (mean - sd, mean + sd) if spread else (None, None)
        found.append(Curve(label, mean, lower, upper, STROKES[label]))
    return Curves(f"{title}: {where}", unit, found, words=WORDS if name == next(iter(SHOWN)) and len(own) > 1 else "")
