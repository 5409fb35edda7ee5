"""What an area analysis finds: areas, pressures and comparisons of every motion, with figure and page."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.area.motion_result import MotionResult
from geocontact.analyses.area.options import AreaOptions, PressureOptions
from geocontact.analyses.area.read import Bodies
from geocontact.analyses.area.tables import tables_of
from geocontact.analyses.area.write import figure_of, pressure_figure_of, write_motion, write_page_of
from geocontact.analyses.result import Result

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
    """

    options: AreaOptions
    bodies: Bodies
    motions: tuple[MotionResult, ...]

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
            f"{one.name}/{name}" if one.name else name: table
            for one in self.motions
            for name, table in tables_of(one, self.options).items()
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

    def write_files(self, folder: Path) -> None:
        """Everything of each motion; several have a sub-folder each."""
        for one in self.motions:
            write_motion(self.record, self.options, self.bodies, one, folder / one.name)

    def write_page(self, file: Path) -> None:
        """Bodies, curves and numbers of a motion over time; of several motions figure and numbers only."""
        if len(self.motions) == 1:
            write_page_of(self.record, self.bodies, self.motions[0], file)
        else:
            super().write_page(file)
