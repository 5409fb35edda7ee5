"""Force of the strap and torque of the knee by design, and the best aim over the limit of the knee."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from geocontact.analyses.sit_to_stand.design.chosen import CertifiedDesign
from geocontact.standing_up.assistance.assisted_model import KNEE
from geocontact.standing_up.assistance.peaks import MEASURES, UNITS
from geocontact.view.curves.style import DOUBLE, GREY, LINES, PALETTE, in_style, panels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT = 0.06
"""Of the drawing [m]."""


@in_style
def design_figure(designs: Sequence[CertifiedDesign], front: Sequence[CertifiedDesign], aim: str) -> Figure:
    """Of the first trial; grey without help."""
    figure, axes = panels(1, 3 if front else 2, DOUBLE, HEIGHT)
    for k, one in enumerate(designs):
        trial = one.trials[0].model
        if trial.torque is None or trial.strap is None:
            raise ValueError("no torque or strap")
        colour, line = GREY if not k else PALETTE[k - 1], LINES[max(k - 1, 0)]
        for ax, values in zip(axes, (trial.strap, trial.torque[:, KNEE]), strict=False):
            ax.plot(trial.time, values, color=colour, ls=line, lw=1.2, label=one.name)
    for ax, label in zip(axes, ("normal force of one strap [N]", "knee torque of both legs [N m]"), strict=False):
        ax.set_xlabel("time since seat-off [s]")
        ax.set_ylabel(label)
    axes[0].legend(fontsize=6, frameon=False)
    if front:
        _front(axes[2], [*front, designs[-1]], aim)
    return figure


def _front(ax: Axes, each: Sequence[CertifiedDesign], aim: str) -> None:
    limits = np.array([one.limit for one in each])
    values = [one.movement.asked.sizes[MEASURES.index(aim)] for one in each]
    ax.plot(100.0 * limits, values, "o-", color=PALETTE[0], ms=3, lw=1.2)
    ax.set_xlabel("limit of the knee's true peak [% of without help]")
    ax.set_ylabel(f"least {aim}, {'mean' if aim == 'energy' else 'smooth peak'} [{UNITS[aim]}]")
