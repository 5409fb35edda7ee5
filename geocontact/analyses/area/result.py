"""What an area analysis finds: areas, pressures and comparisons of every motion, with figure and page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.area.motion_result import MotionResult
from geocontact.analyses.area.options import AreaOptions, PressureOptions
from geocontact.analyses.area.read import Bodies
from geocontact.analyses.area.tables import tables_of
from geocontact.analyses.area.write import figure_of, page_of, pressure_figure_of, write_further
from geocontact.analyses.finished_page import Thinned
from geocontact.analyses.result import REPORT, Result

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class AreaResult(Result):
    """Contact of two bodies over one motion or several.

    Parameters
    ----------
    bodies
        The bodies and how their contact was counted.
    motions
        What was found over each motion.
    notes
        What is to be said of the pictures of a motion, by its name, once they are drawn.
    """

    options: AreaOptions
    bodies: Bodies
    motions: tuple[MotionResult, ...]
    notes: dict[str, list[str]] = field(default_factory=dict)

    @property
    def accepted(self) -> bool:
        """False where a difference to measured areas is beyond the tolerance."""
        reference = self.bodies.reference
        return reference is None or all(
            reference.accepts(one.comparison) for one in self.motions if one.comparison is not None
        )

    @property
    def folders(self) -> tuple[str, ...]:
        """The folder itself, and one for each of several motions."""
        return ("", *(one.name for one in self.motions if one.name))

    @property
    def title(self) -> str:
        """The bodies."""
        return self.bodies.title

    def tables(self) -> dict[str, pd.DataFrame]:
        """`area`, `pressure` and `comparison`; of several motions "name/area" and so on.

        The main table is `pressure` where the analysis was called for that.
        """
        found = {
            _named(one, name): table for one in self.motions for name, table in tables_of(one, self.options).items()
        }
        if not isinstance(self.options, PressureOptions):
            return found
        return dict(sorted(found.items(), key=lambda item: not item[0].endswith("pressure")))

    def figure(self) -> Figure:
        """Areas and separation, or force and pressure where the analysis was called for that; of the first motion."""
        one = self.motions[0]
        if one.pressure is not None and isinstance(self.options, PressureOptions):
            return pressure_figure_of(self.bodies, one, one.pressure)
        return figure_of(self.bodies, one)

    def figures(self) -> dict[str, Figure]:
        """`area` of each motion, and `pressure` where it was asked for."""
        found = {}
        for one in self.motions:
            found[_named(one, "area")] = figure_of(self.bodies, one)
            if one.pressure is not None:
                found[_named(one, "pressure")] = pressure_figure_of(self.bodies, one, one.pressure)
        return found

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Thinned]:
        """Bodies, curves and numbers of each motion over time."""
        return {_named(one, REPORT): page_of(self.bodies, one) for one in self.motions}

    def reservations(self, folder: str) -> tuple[str, ...]:
        """Those of one motion, and what is to be said of its pictures."""
        own = {one.name: one.reservations for one in self.motions}
        return (*own[folder], *self.notes.get(folder, ()))

    def write_files(self, folder: Path) -> None:
        """Maps, series for ParaView, stills and loads for OpenSim besides, as asked for."""
        for one in self.motions:
            self.notes[one.name] = write_further(self.options, self.bodies, one, folder / one.name)
            for note in self.notes[one.name]:
                self.record.warn(note)
        super().write_files(folder)


def _named(one: MotionResult, file: str) -> str:
    """A file of one motion, in the sub-folder that it has among several."""
    return f"{one.name}/{file}" if one.name else file
