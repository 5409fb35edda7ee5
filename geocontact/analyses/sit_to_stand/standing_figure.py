"""Ground reaction and centre of pressure of all trials, by plate and model, and what is left of the balance."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.view.curves.style import DOUBLE, GREY, PALETTE, in_style, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 0.1
"""Of the drawing [m]."""
TITLES = ("force upwards", "force forwards", "centre of pressure", "residual between the points")
UNITS = ("[N]", "[N]", "ahead of the origin [mm]", "[N]")


@in_style
def standing_figure(trials: Sequence[TrialResult]) -> Figure:
    """Grey the plate, coloured the model."""
    figure, axes = panels(2, 2, DOUBLE, HEIGHT)
    for k, trial in enumerate(trials):
        seen, model, colour = trial.recorded, trial.model, PALETTE[k % len(PALETTE)]
        pairs = (
            (seen.force[:, 1], model.force[:, 1]),
            (seen.force[:, 0], model.force[:, 0]),
            (1e3 * seen.centre, 1e3 * model.centre),
        )
        for ax, (one, other) in zip(axes, pairs, strict=False):
            ax.plot(seen.time, one, color=GREY, lw=1.0)
            ax.plot(seen.time, other, color=colour, lw=1.0, label=seen.name)
        axes[3].semilogy(trial.judged.time, trial.judged.force, color=colour, lw=0.6)
    for ax, title, unit in zip(axes, TITLES, UNITS, strict=True):
        ax.set_title(title)
        ax.set_xlabel("time since seat-off [s]")
        ax.set_ylabel(unit)
    axes[0].legend(fontsize=6, frameon=False)
    return figure
