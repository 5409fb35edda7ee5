"""Torques of the exoskeleton's motors without a person, as recorded and by the fit."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.view.curves.style import DOUBLE, GREY, PALETTE, in_style, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 0.06
"""Of the drawing [m]."""


@in_style
def device_figure(
    time: Float[np.ndarray, " t"], motors: Float[np.ndarray, "t 3"], fitted: Float[np.ndarray, "t 3"]
) -> Figure:
    """A panel for each hinge."""
    figure, axes = panels(1, len(EXO_JOINTS), DOUBLE, HEIGHT)
    for k, (ax, name) in enumerate(zip(axes, EXO_JOINTS, strict=True)):
        ax.plot(time, motors[:, k], color=GREY, lw=1.5, label="motor")
        ax.plot(time, fitted[:, k], color=PALETTE[0], lw=0.8, label="fitted")
        ax.set_title(name)
        ax.set_xlabel("time [s]")
        ax.set_ylabel("torque of both legs [N m]")
    axes[0].legend(fontsize=6, frameon=False)
    return figure
