"""Outcomes over what is varied, with bands, and the roll-over shapes of three values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np

from geocontact.analyses.prosthesis.design.sweep import DIGITS, SHOWN, UNITS, AimAnswer, Sweep
from geocontact.below_knee_prosthesis.design.carried_load import CarriedLoad
from geocontact.below_knee_prosthesis.design.knob import AIMS, RESPONSES, Knob, Response
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES, shank_path
from geocontact.view.curves.style import DOUBLE, GREY, LINES, PALETTE, in_style, panels

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

HEIGHT = 0.1
"""Of the drawing [m]."""
HUES = (PALETTE[0], PALETTE[1], PALETTE[3])
"""Blue, orange and pink, of the responses."""


@in_style
def design_figure(
    sweep: Sweep,
    answers: Sequence[AimAnswer],
    ends: Knob,
    shapes: Mapping[Response, tuple[CarriedLoad, ...]],
) -> Figure:
    """One colour for each response of the person; grey the present value, green the interval of the best."""
    figure, axes = panels(2, 3, DOUBLE, HEIGHT)
    factor, bands = SHOWN[sweep.knob.vary][0], sweep.bands
    for k, answer in enumerate(answers):
        panel, measure = axes[k], MEASURES[AIMS[k]]
        for j, response in enumerate(RESPONSES):
            median, lower, upper = bands[:, j, :, k]
            panel.plot(sweep.shown, median, color=HUES[j], ls=LINES[j], label=response)
            panel.fill_between(sweep.shown, lower, upper, color=HUES[j], alpha=0.2, lw=0)
        panel.axvline(factor * sweep.knob.present, color=GREY, lw=0.7)
        if answer.choice.told:
            panel.axvspan(factor * answer.choice.lower, factor * answer.choice.upper, color=PALETTE[2], alpha=0.2, lw=0)
        panel.set_title(measure.words.partition(",")[0], fontsize=7)
        panel.set_ylabel(measure.unit)
        panel.set_xlabel(f"{sweep.knob.vary} [{UNITS[sweep.knob.vary]}]")
    axes[0].legend(fontsize=6, frameon=False)
    _shapes(axes[-1], ends, shapes["angles kept"])
    return figure


def _shapes(panel: Axes, ends: Knob, carried: Sequence[CarriedLoad]) -> None:
    factor, unit = SHOWN[ends.vary]
    for k, (value, found) in enumerate(zip(ends.settings, carried, strict=True)):
        x, y = 1e3 * shank_path(found).T
        label = f"{factor * value:.{DIGITS[ends.vary]}f} {unit}".strip()
        panel.plot(x, y, color=PALETTE[k], ls=LINES[k], label=label)
    panel.set_aspect("equal", adjustable="datalim")
    panel.set_title("roll-over shape in the shank", fontsize=7)
    panel.set_xlabel("forward of the ankle [mm]")
    panel.set_ylabel("above it [mm]")
    panel.legend(fontsize=6, frameon=False)


def stance_share(found: CarriedLoad) -> np.ndarray:
    """Share of the loaded stance, 0 to 1."""
    time = found.task.time
    return np.asarray((time - time[0]) / (time[-1] - time[0]))
