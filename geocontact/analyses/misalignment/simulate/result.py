"""What a simulation makes: synthetic trials with their true numbers, and surfaces of the displacement."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from geocontact.analyses.figure_files import drawing, save_both
from geocontact.analyses.json_file import write_json
from geocontact.analyses.misalignment.law_numbers import with_units
from geocontact.analyses.misalignment.simulate.displacement_surfaces import Surfaces
from geocontact.analyses.misalignment.simulate.figure import surface_figure
from geocontact.analyses.misalignment.simulate.gap_case import UNITS, gap_case
from geocontact.analyses.misalignment.simulate.loaded_trial import LoadedTrial
from geocontact.analyses.misalignment.simulate.numbers import numbers_table
from geocontact.analyses.misalignment.simulate.options import SimulateOptions
from geocontact.analyses.misalignment.simulate.page import write_simulation_report
from geocontact.analyses.options_table import options_table
from geocontact.analyses.result import Result
from geocontact.axis_misalignment.synthetic import Design
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.io.cases.gap_case_writer import write_gap_case
from geocontact.io.text.results import write_table
from geocontact.view.page.tables import inputs_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

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
    design
        How trials were made; None along recorded angles.
    """

    options: SimulateOptions
    numbers: Mapping[str, float]
    made: tuple[LoadedTrial, ...]
    surfaces: Surfaces
    design: Design | None

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
        """One table per trial, by its name, `surfaces`, and `numbers` with all that ran."""
        own = {each.recording.name: each.table() for each in self.made}
        return {**own, "surfaces": self.surfaces.table(), "numbers": numbers_table(self.made, self.design)}

    def figure(self) -> Figure:
        """Displacement over the angle and each offset."""
        return surface_figure(self.surfaces)

    def write_files(self, folder: Path) -> None:
        """A table per trial that says what it is, truth.json, numbers, surfaces, page; the gap case if asked for."""
        for name, table in self.tables().items():
            write_table(table, folder, name)
        for each in self.trials:
            self.record.tables[f"{each.name}.csv"] = SYNTHETIC
        if self.options.case:
            locked = [each for each in self.trials if each.displacement is None]
            write_gap_case(gap_case(locked, self.numbers), folder / CASE, UNITS)
        write_json(folder / "truth.json", self.truth)
        self._write_page(folder / "report.html", save_both(self.figure(), folder, "surfaces"))

    def write_page(self, file: Path) -> None:
        """The first trial over time, the true numbers, the surfaces."""
        self._write_page(file, drawing(self.figure()))

    def _write_page(self, file: Path, picture: bytes) -> None:
        tables = [inputs_table(self.record.inputs), options_table(self.record)]
        write_simulation_report(file, self.made, self.numbers, picture, tables, self.record)
