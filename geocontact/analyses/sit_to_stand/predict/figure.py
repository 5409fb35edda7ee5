"""Force of the strap as recorded and by each predictor."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from geocontact.analyses.sit_to_stand.trial_result import TrialResult
from geocontact.standing_up.trials import StandingTrial
from geocontact.view.curves.style import DOUBLE, GREY, LINES, PALETTE, in_style, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 0.06
"""Of the drawing [m]."""


@in_style
def strap_figure(predictions: Sequence[tuple[str, TrialResult]], means: Mapping[str, StandingTrial]) -> Figure:
    """Grey as recorded, coloured the predictors, dotted the mean of other trials; a panel for each trial."""
    names = list(means)
    figure, axes = panels(1, len(names), DOUBLE, HEIGHT)
    for ax, name in zip(axes, names, strict=True):
        own = [(who, trial) for who, trial in predictions if trial.recorded.name == name]
        seen = own[0][1].recorded
        if seen.strap is not None:
            ax.plot(seen.time, seen.strap, color=GREY, lw=1.0, label="recorded")
        for k, (who, trial) in enumerate(own):
            if trial.model.strap is not None:
                ax.plot(seen.time, trial.model.strap, color=PALETTE[k], ls=LINES[k], lw=1.2, label=who)
        if (mean := means[name].strap) is not None:
            ax.plot(seen.time, mean, color="black", ls=":", lw=1.0, label="mean of the calibration")
        ax.set_title(name)
        ax.set_xlabel("time since seat-off [s]")
        ax.set_ylabel("normal force of one strap [N]")
    axes[0].legend(fontsize=6, frameon=False)
    return figure
