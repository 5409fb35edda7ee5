"""What is shown of a comparison: ensembles by setting, errors beside trivial predictors, outliers."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.pages import INPUTS, OPTIONS
from geocontact.analyses.frame.words import NOT_A_DEVICE, headline
from geocontact.analyses.prosthesis.compare.stances import UNITS
from geocontact.below_knee_prosthesis.comparison import by_setting, curves_of, plain_curves
from geocontact.below_knee_prosthesis.evaluation import ANOTHER, MEAN, JudgedStance
from geocontact.view.curves.style import DOUBLE, GREY, PALETTE, in_style, panels
from geocontact.view.page.content import Curve, Curves, Page, Picture, Section, Words
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

ROWS = {
    "resultant": ("resultant [BW]", 1.0),
    "impulse": ("impulse [BW s]", 1.0),
    "cop_ground": ("centre of pressure [% of the foot]", 100.0),
    "ankle_moment": ("ankle moment [N m/kg]", 1.0),
}
"""Quantity, its axis and factor."""
HEIGHT = 0.045
"""Height of a row [m]."""
MOST = 5
"""Settings that are drawn."""


@in_style
def ensemble_figure(stances: Sequence[JudgedStance]) -> Figure:
    """Grey the plates, coloured the model: mean, a band of one standard deviation; dashed the means without a model."""
    settings = dict(list(by_setting(stances).items())[:MOST])
    figure, axes = panels(len(ROWS), len(settings), DOUBLE, HEIGHT * len(ROWS))
    for row, (name, (label, factor)) in enumerate(ROWS.items()):
        plain = plain_curves(stances, name)
        for column, (setting, own) in enumerate(settings.items()):
            panel = axes[row * len(settings) + column]
            _bands(panel, own, name, factor)
            for colour, predictor in zip(PALETTE[1:], (MEAN, ANOTHER), strict=False):
                if curves := curves_of(plain, own, predictor):
                    mean = factor * np.mean(curves, axis=0)
                    panel.plot(100.0 * own[0].errors.share, mean, color=colour, lw=0.9, ls="--", label=predictor)
            if row == 0:
                panel.set_title(f"{setting}, {len(own)} stances")
            if column == 0:
                panel.set_ylabel(label)
            if row == len(ROWS) - 1:
                panel.set_xlabel("stance on the plate [%]")
    axes[0].legend(fontsize=6, frameon=False)
    return figure


def _bands(panel: Axes, own: Sequence[JudgedStance], name: str, factor: float) -> None:
    share = 100.0 * own[0].errors.share
    pairs = (("plate", GREY, [one.measured(name) for one in own]), ("model", PALETTE[0], _model(own, name)))
    for label, colour, curves in pairs:
        mean, sd = factor * np.mean(curves, axis=0), factor * np.std(curves, axis=0)
        panel.plot(share, mean, color=colour, lw=1.2, label=label)
        if len(own) > 1:
            panel.fill_between(share, mean - sd, mean + sd, color=colour, alpha=0.25, lw=0)


def _model(own: Sequence[JudgedStance], name: str) -> list[np.ndarray]:
    return [one.simulated(name) for one in own]


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
    """Curves of each quantity and setting: plate and model with a band of one standard deviation, both predictors."""
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
