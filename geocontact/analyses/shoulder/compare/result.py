"""What a comparison finds: errors by channel and phase, figure, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.finished_page import INPUTS, OPTIONS
from geocontact.analyses.motion.figure import curves_figure
from geocontact.analyses.page_frames import thinned
from geocontact.analyses.page_words import NOT_A_DEVICE, headline
from geocontact.analyses.result import REPORT, Result
from geocontact.analyses.shoulder.compare.options import ShoulderCompareOptions
from geocontact.analyses.shoulder.recorded_channels import ELEVATION
from geocontact.identify.signals.agreement import Agreement
from geocontact.view.page.content import Curve, Curves, Page, Words
from geocontact.view.page.tables import frame_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MAT = (
    "The simulated force is the component that lifts the arm; a pressure mat also counts what presses from the sides, "
    "and is loaded by straps, sleeves and a push force on the tool that the simulation does not know."
)


@dataclass(frozen=True, eq=False)
class ComparedChannel:
    """One channel at the simulation's even times [rad or N], and errors by phase."""

    channel: str
    time: Float[np.ndarray, " t"]
    model: Float[np.ndarray, " t"]
    measured: Float[np.ndarray, " t"]
    errors: Mapping[str, Agreement]

    @property
    def shown_in(self) -> tuple[str, float]:
        """Unit of tables, and how many of it one SI unit is."""
        return ("deg", float(np.degrees(1.0))) if self.channel == ELEVATION else ("N", 1.0)


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ShoulderCompareResult(Result):
    """A simulated arm beside a recording."""

    options: ShoulderCompareOptions
    channels: tuple[ComparedChannel, ...]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`comparison`: one row per channel and phase."""
        rows = []
        for one in self.channels:
            unit, factor = one.shown_in
            for phase, a in one.errors.items():
                errors = {"mae": a.mae * factor, "rmsd": a.rmsd * factor, "bias": a.bias * factor}
                told = {"r2 [-]": a.r2, "lag [s]": a.lag, "samples": a.samples}
                rows.append({"channel": one.channel, "phase": phase, "unit": unit, **errors, **told})
        return {"comparison": pd.DataFrame(rows)}

    def figures(self) -> dict[str, Figure]:
        """`comparison`: each channel, recorded and simulated."""
        panels = {}
        for one in self.channels:
            unit, factor = one.shown_in
            both = {"recorded": factor * one.measured, "simulated": factor * one.model}
            panels[f"{one.channel} [{unit.replace('deg', '°')}]"] = pd.DataFrame(both)
        return {"comparison": curves_figure(self.channels[0].time, panels)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Both curves of each channel, and errors by phase."""
        time = self.channels[0].time
        shown = thinned(len(time), [values for one in self.channels for values in (one.measured, one.model)])
        panels = []
        for one in self.channels:
            unit, factor = one.shown_in
            both = (("recorded", one.measured), ("simulated", one.model))
            curves = [Curve(name, factor * values[shown]) for name, values in both]
            panels.append(Curves(one.channel.capitalize(), unit, curves))
        page = Page(
            title=f"Simulated arm beside {self.options.recorded.name}",
            subtitle="Shoulder exoskeleton: elevation of its arm, force in its cuff",
            time=time[shown],
            time_label="time [s]",
            headline=headline(self.sentences, most=2),
            sections=(
                *panels,
                frame_table("Errors by channel and phase", self.table()),
                INPUTS,
                OPTIONS,
                Words("What the numbers do not contain", [MAT, NOT_A_DEVICE]),
            ),
            numbers=shown + 1,
            total=len(time),
        )
        return {REPORT: page}
