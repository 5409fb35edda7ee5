"""Angles of the person and force of the strap, as recorded and by each predictor."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.chain import COORDINATES, JOINTS
from geocontact.standing_up.trials import StandingTrial
from geocontact.view.curves.style import DOUBLE, GREY, LINES, PALETTE, in_style, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 0.1
"""Of the drawing [m]."""
STRAP = "normal force of one strap [N]"


@in_style
def compared_figure(recorded: StandingTrial, by: Mapping[str, StandingTrial]) -> Figure:
    """Grey as recorded; a panel for each joint of the person, and one for the strap."""
    figure, axes = panels(2, 2, DOUBLE, HEIGHT)
    for k, (name, trial) in enumerate({"recorded": recorded, **by}.items()):
        colour, line = (GREY, "-") if not k else (PALETTE[k - 1], LINES[k - 1])
        for ax, values in zip(axes, _shown(trial).values(), strict=True):
            ax.plot(trial.time, values, color=colour, ls=line, lw=1.2, label=name)
    for ax, label in zip(axes, _shown(recorded), strict=True):
        ax.set_xlabel("time since seat-off [s]")
        ax.set_ylabel(label)
    axes[0].legend(fontsize=6, frameon=False)
    return figure


def _shown(trial: StandingTrial) -> dict[str, Float[np.ndarray, " t"]]:
    angles = {f"{name} [°]": np.degrees(trial.q[:, COORDINATES.index(name)]) for name in JOINTS}
    return {**angles, STRAP: np.full(len(trial.time), np.nan) if trial.strap is None else trial.strap}
