"""What a simulation makes: synthetic trials with their true numbers, and surfaces of the displacement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from geocontact.analyses.json_file import write_json
from geocontact.analyses.misalignment.law_numbers import with_units
from geocontact.analyses.misalignment.simulate.displacement_surfaces import Surfaces
from geocontact.analyses.misalignment.simulate.figure import surface_figure
from geocontact.analyses.misalignment.simulate.gap_case import UNITS, gap_case
from geocontact.analyses.misalignment.simulate.loaded_trial import LoadedTrial
from geocontact.analyses.misalignment.simulate.options import SimulateOptions
from geocontact.analyses.misalignment.simulate.page import simulation_page
from geocontact.analyses.result import REPORT, Result
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.io.cases.gap_case_writer import write_gap_case

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page

CASE = "case"
SYNTHETIC = {"synthetic": True, "words": "made by geocontact elbow simulate; nobody was measured"}


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class SimulateResult(Result):
    """Synthetic trials; nobody was measured.

    Parameters
    ----------
    numbers
        True numbers of the law, in SI.
    made
        Each trial with the moment on the cuff and what becomes of the actuator's torque.
    surfaces
        Displacement over the angle and each offset, with the same link.
    """

    options: SimulateOptions
    numbers: Mapping[str, float]
    made: tuple[LoadedTrial, ...]
    surfaces: Surfaces

    @property
    def trials(self) -> tuple[ElbowRecording, ...]:
        """Angle, force and what else a recording has."""
        return tuple(each.recording for each in self.made)

    @property
    def truth(self) -> dict[str, Any]:
        """True numbers with their units in the keys."""
        told: dict[str, Any] = {"synthetic": True, "numbers": with_units(self.numbers)}
        stroke = self.options.stroke
        return told if stroke is None else {**told, "stroke_mm": [end * 1e3 for end in stroke]}

    def tables(self) -> dict[str, pd.DataFrame]:
        """One table per trial, by its name, and `surfaces`."""
        return {**{each.recording.name: each.table() for each in self.made}, "surfaces": self.surfaces.table()}

    def figures(self) -> dict[str, Figure]:
        """`surfaces`: displacement over the angle and each offset."""
        return {"surfaces": surface_figure(self.surfaces)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The first trial over time, the true numbers, the surfaces."""
        return {REPORT: simulation_page(self.made, self.numbers, drawings["surfaces"], self.record)}

    def refers_to(self, table: str) -> Mapping[str, object] | None:
        """What a trial is: nobody was measured."""
        return SYNTHETIC if table in {each.name for each in self.trials} else None

    def write_files(self, folder: Path) -> None:
        """truth.json besides; the gap case where it is asked for."""
        if self.options.case:
            locked = [each for each in self.trials if each.displacement is None]
            write_gap_case(gap_case(locked, self.numbers), folder / CASE, UNITS)
        write_json(folder / "truth.json", self.truth)
        super().write_files(folder)
