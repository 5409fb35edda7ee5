"""Ensembles of a study: one column for each setting, simulated and measured."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from geocontact.analyses.prosthesis.compare.tables import by_setting, curves_of, plain_curves
from geocontact.below_knee_prosthesis.evaluation.judged_stance import JudgedStance
from geocontact.below_knee_prosthesis.evaluation.trivial_predictors import ANOTHER, MEAN
from geocontact.view.curves.style import DOUBLE, GREY, PALETTE, in_style, panels

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
"""Of a row [m]."""
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
