"""Force and centre of pressure of a stance, by the plate and by the calibrated foot."""

from __future__ import annotations

from typing import TYPE_CHECKING

from jaxtyping import Float
from numpy import ndarray

from geocontact.below_knee_prosthesis.calibration.recorded_stance import RecordedStance
from geocontact.view.curves.style import DOUBLE, GREY, PALETTE, in_style, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 0.09
"""Of the drawing [m]."""
TITLES = ("x, along the walk", "y, upwards", "z, to the right")


@in_style
def stance_figure(stance: RecordedStance, predicted: Float[ndarray, "t 4"]) -> Figure:
    """Grey the plate, coloured the model."""
    figure, axes = panels(2, 2, DOUBLE, HEIGHT)
    for k, title in enumerate((*TITLES, "centre of pressure")):
        factor = 1.0 if k < 3 else 100.0
        axes[k].plot(stance.time, factor * stance.measured[:, k], color=GREY, lw=1.6, label="plate")
        axes[k].plot(stance.time, factor * predicted[:, k], color=PALETTE[0], lw=1.0, label="model")
        axes[k].set_title(title)
        axes[k].set_xlabel("time [s]")
        axes[k].set_ylabel("force [N]" if k < 3 else "from the heel [% of the foot]")
    axes[0].legend(fontsize=6, frameon=False)
    return figure
