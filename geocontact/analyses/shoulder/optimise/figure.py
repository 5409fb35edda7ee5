"""Torque that shoulders need and torque of the support, one panel for each person and task."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy as np
from jaxtyping import Float

from geocontact.shoulder_exoskeleton.support.outcome import Factors
from geocontact.shoulder_exoskeleton.support.phases import SCREW
from geocontact.shoulder_exoskeleton.support.support_case import SupportCase
from geocontact.view.curves.style import DOUBLE, GREY, PALETTE, in_style, panels

if TYPE_CHECKING:
    from matplotlib.figure import Figure

HEIGHT = 0.045
"""Height of a row of panels [m]."""
COLOURS = {"dominant": PALETTE[0], "other": PALETTE[1]}


@in_style
def profile_figure(
    cases: Sequence[SupportCase], elevations: Mapping[str, Float[np.ndarray, " t"]], factors: Factors
) -> Figure:
    """Dashed what is needed [N m], solid the support, dotted the elevation [°]; grey while the tool runs."""
    tasks = list(dict.fromkeys(case.task for case in cases))
    persons = list(dict.fromkeys(case.person for case in cases))
    figure, axes = panels(len(persons), len(tasks), DOUBLE, HEIGHT * len(persons))
    for k, (person, task) in enumerate((person, task) for person in persons for task in tasks):
        own = [case for case in cases if (case.person, case.task) == (person, task)]
        panel = axes[k]
        angle = panel.twinx()
        for case in own[:2]:
            colour = COLOURS[case.hand]
            panel.plot(case.time, case.needed, color=colour, ls="--", lw=0.9, label=f"needed, {case.hand}")
            panel.plot(case.time, case.support(factors), color=colour, lw=1.3, label=f"support, {case.hand}")
            angle.plot(case.time, np.degrees(elevations[case.name]), color=colour, ls=":", lw=0.8)
            running = case.time[case.phase == SCREW]
            if len(running):
                panel.axvspan(running[0], running[-1], color=GREY, alpha=0.08, lw=0)
        panel.set_title(f"{person}, {task}")
        panel.set_ylabel("torque [N m]")
        angle.set_ylabel("elevation [°]")
        panel.set_xlabel("time [s]")
        if k == 0:
            panel.legend(loc="upper left", fontsize=6, frameon=False)
    return figure
