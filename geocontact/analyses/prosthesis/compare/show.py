"""What is shown of a comparison: ensembles by setting, errors beside trivial predictors, outliers."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from typing import Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.collector import contradicted
from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, counted
from geocontact.analyses.prosthesis.compare.changes import READ as CHANGES
from geocontact.analyses.prosthesis.quantity_words import NAMES
from geocontact.below_knee_prosthesis.comparison import (
    at_shares_of,
    by_setting_and_calibrated,
    curves_of,
    plain_curves,
)
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
ANSWERED = {
    "resultant": ("% BW", 100.0),
    "cop_ground": ("% of the foot", 100.0),
    "ankle_moment": ("N m/kg", 1.0),
}
"""Quantities of the headline, with unit and factor."""
STROKES = {"plate": INK, "model": stroke(0), MEAN: stroke(1, 1), ANOTHER: stroke(2, 2)}
"""One thing looks alike in all panels."""
WIDEST = 4
"""Settings, and the calibrated stances, side by side in the figure."""
WORDS = "Mean over the stances of a setting, a band of one standard deviation; both predictors know no model."
WITHOUT = [
    "Both predictors without a model know when the stance on the plate begins and ends; the simulation predicts it.",
    "Mean of the others: of the same person's other trials at any setting; of all others where there are none.",
    "Another setting: the plate of the person's first trial on another setting of the foot.",
    "The pelvis is free upwards, so that the impulse is nearly body weight times time, whatever the foot is.",
]
OVER = {
    False: (
        "Errors are over the stance that the plate saw. The study takes a quarter of a second of swing on both sides "
        "as well, where both forces are nothing, which makes its errors smaller (option “score”)."
    ),
    True: (
        "Errors are scored as in the study: with a quarter of a second of swing on both sides, where both forces are "
        "nothing, and centres of pressure low-passed at 6 Hz; over the stance alone, where the fit is tested, they are "
        "larger."
    ),
}
"""Over the stance alone, and as the study has it."""
MEASURES = [
    "Force and centre of pressure of the other leg are recorded and given; trials of a sole fit are listed apart.",
    "An outlier deviates by more than three standard deviations by the study's rule, or by the median.",
]


def answer(summary: pd.DataFrame) -> list[str]:
    """On how many stances the model is nearer than both predictors without a model, and by how much it is off."""
    rows = _over_all(summary)
    if not rows:
        return ["No stance is left to compare: a sole was fitted to each."]
    sizes = ", ".join(f"the {NAMES[name]} by {_size(name, row['rmse'])}" for name, row in rows.items())
    off = f"It misses {sizes} (root mean square, mean over the stances)."
    if not any(np.isfinite(row["mean of the others rmse"]) for row in rows.values()):
        return [off.replace("It misses", "The model misses"), "There is no other stance to compare it with."]
    if contradicted():
        return [off.replace("It misses", "The model misses")]
    won = ", ".join(f"{row['better']:.0f} of {row['trials']:.0f} ({NAMES[name]})" for name, row in rows.items())
    return [f"The model is nearer to the plate than both baseline predictors on {won}.", off]


def _over_all(summary: pd.DataFrame) -> dict[str, dict[Hashable, Any]]:
    own = summary[(summary["setting"] == "all") & summary["quantity"].isin(ANSWERED)]
    return {str(row["quantity"]): row for row in own.to_dict("records")}


def _size(name: str, value: float) -> str:
    unit, factor = ANSWERED[name]
    return f"{factor * value:.3g} {unit}"


def _facts(summary: pd.DataFrame) -> list[tuple[str, str]]:
    """Error of the model and of the better predictor, and R², of each quantity of the headline."""
    facts = []
    for name, row in _over_all(summary).items():
        plain = np.array([row["mean of the others rmse"], row["another rmse"]])
        beside = f", baseline {_size(name, np.nanmin(plain))}" if np.isfinite(plain).any() else ""
        facts.append((f"{NAMES[name]}, R² {row['r2 [-]']:.2f}", f"{_size(name, row['rmse'])}{beside}"))
    return facts


def in_words(table: pd.DataFrame) -> pd.DataFrame:
    """A table as the page shows it: quantities in words, yes and no, columns that hold nothing left out."""
    shown = table.dropna(axis="columns", how="all")
    shown = shown.drop(columns=[name for name in shown if (shown[name] == "").all()])
    for name in shown.columns:
        if name in ("calibrated", "outlier", "better") and _yes_or_no(shown[name]):
            shown = shown.assign(**{name: [{True: "yes", False: "no"}.get(each, "") for each in shown[name]]})
    if "quantity" in shown:
        shown = shown.assign(quantity=[NAMES.get(each, each) for each in shown["quantity"]])
    return shown


def _yes_or_no(column: pd.Series) -> bool:
    """Whether every value that is known is true or false; a count of 0 or 1 is neither."""
    return all(isinstance(each, bool | np.bool_) for each in column.dropna())


def comparison_page(stances: Sequence[JudgedStance], tables: Mapping[str, pd.DataFrame]) -> Page:
    """Ensembles, errors beside trivial predictors, outliers."""
    over = OVER[bool(stances[0].errors.share[0] < 0.0)]
    sections: list[Section] = [
        *comparison_curves(stances).panels,
        frame_table("Means by setting, compared with baseline predictors", in_words(tables["summary"]), 3),
        *(
            [frame_table("Changes between settings, predicted and measured", in_words(tables["changes"]), 3)]
            if "changes" in tables
            else []
        ),
        frame_table("Stances", in_words(tables["trials"]), 3),
        frame_table("Errors of each stance", in_words(tables["errors"]), 3),
        INPUTS,
        OPTIONS,
        Words("How to read the numbers", [*WITHOUT, CHANGES, over, *MEASURES, NOT_A_DEVICE]),
    ]
    return Page(
        title=f"{counted(len(stances), 'prosthetic stance')} compared with force plates",
        subtitle="Ground reaction, centre of pressure and ankle moment of a prosthetic foot",
        time=100.0 * stances[0].errors.share,
        time_label="stance on the plate [%]",
        headline=answer(tables["summary"]),
        facts=_facts(tables["summary"]),
        sections=tuple(sections),
        start_frame=len(stances[0].errors.share) // 2,
        plays=False,
    )


def comparison_curves(stances: Sequence[JudgedStance]) -> CurveSheet:
    """Curves of each quantity and setting: plate and model with a band of one standard deviation, both predictors."""
    settings = by_setting_and_calibrated(stances)
    panels = [
        _panel(name, f"{setting}, {counted(len(own), 'stance')}", own, plain, stances[0])
        for name in SHOWN
        for plain in [plain_curves(stances, name)]
        for setting, own in settings.items()
    ]
    over = Course("stance on the plate", "%", 100.0 * stances[0].errors.share)
    return CurveSheet(panels, over, min(len(settings), WIDEST))


def _panel(
    name: str,
    where: str,
    own: Sequence[JudgedStance],
    plain: Mapping[str, Mapping[str, Float[np.ndarray, " s"]]],
    axis: JudgedStance,
) -> Curves:
    title, unit, factor = SHOWN[name]
    found = []
    for label, curves in (
        ("plate", [at_shares_of(axis, one.measured(name), one) for one in own]),
        ("model", [at_shares_of(axis, one.simulated(name), one) for one in own]),
        *((label, curves_of(plain, own, label, axis)) for label in (MEAN, ANOTHER)),
    ):
        if not curves:
            continue
        mean, sd = factor * np.mean(curves, axis=0), factor * np.std(curves, axis=0)
        spread = len(own) > 1 and label in ("model", "plate")
        lower, upper = (mean - sd, mean + sd) if spread else (None, None)
        found.append(Curve(label, mean, lower, upper, STROKES[label]))
    return Curves(f"{title}: {where}", unit, found, words=WORDS if name == next(iter(SHOWN)) and len(own) > 1 else "")
