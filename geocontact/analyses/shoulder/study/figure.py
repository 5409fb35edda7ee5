"""Every arm of a study in two panels: elevation of the exoskeleton's arm and supporting force."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.analyses.shoulder.recorded_channels import ELEVATION, FORCE
from geocontact.analyses.shoulder.simulate.simulated_arm import SimulatedArm
from geocontact.analyses.shoulder.study.case import StudyCase
from geocontact.view.curves.sheet import sheet
from geocontact.view.curves.style import PALETTE, in_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDE, HIGH = 3.2, 1.35
"""Size of a panel [inch]."""
MOST = 24
"""Arms that are drawn."""
LABELS = {ELEVATION: "elevation [°]", FORCE: "force [N]"}


@in_style
def study_figure(cases: Sequence[StudyCase]) -> Figure:
    """A row for each arm in its trial, the first 24: what was recorded, and what was simulated along both motions."""
    shown = cases[:MOST]
    figure = sheet(2 * WIDE, HIGH * len(shown) + 0.6)
    rows = figure.subplots(len(shown), 2, sharex="row", squeeze=False)
    for case, row in zip(shown, rows, strict=True):
        for axes, channel in zip(row, (ELEVATION, FORCE), strict=True):
            _panel(axes, case, channel)
        row[0].set_title(case.name, loc="left", fontsize="small")
    for axes in rows[-1]:
        axes.set_xlabel("time [s]")
    lines, names = rows[0, 0].get_legend_handles_labels()
    figure.legend(lines, names, loc="outside upper center", ncols=3, fontsize="small")
    return figure


def _panel(axes: Axes, case: StudyCase, channel: str) -> None:
    factor = float(np.degrees(1.0)) if channel == ELEVATION else 1.0
    if case.recorded is not None and channel in case.recorded.values:
        axes.plot(case.recorded.time, factor * case.recorded.values[channel], color="0.45", label="recorded")
    arms = (("motion in the device", case.within), ("motion without it", case.without))
    for (name, arm), color, line in zip(arms, PALETTE, ("-", "--"), strict=False):
        if arm is not None:
            axes.plot(arm.simulation.motion.time, factor * _curve(arm, channel), color=color, ls=line, label=name)
    axes.set_ylabel(LABELS[channel], fontsize="small")


def _curve(arm: SimulatedArm, channel: str) -> Float[np.ndarray, " t"]:
    return arm.simulation.elevation if channel == ELEVATION else arm.simulation.supporting
