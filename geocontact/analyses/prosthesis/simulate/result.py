"""What a simulation finds: tables, files for OpenSim and ParaView, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.figure_files import save_both
from geocontact.analyses.motion.figure import curves_figure
from geocontact.analyses.prosthesis.simulate.exports import write_coordinates, write_loads, write_spheres
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.page import write_stance_page
from geocontact.analyses.prosthesis.simulate.plane_files import write_plane
from geocontact.analyses.prosthesis.simulate.read import Walk
from geocontact.analyses.prosthesis.simulate.tables import curves_table, errors_table, numbers_table, stance_table
from geocontact.analyses.result import Result
from geocontact.below_knee_prosthesis.model.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.model.stance_model import FLOOR
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.below_knee_prosthesis.stance_errors import StanceErrors, at_times
from geocontact.data.sourced_number import Number
from geocontact.io.text.results import write_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class ProsthesisSimulateResult(Result):
    """A stance of the prosthetic side.

    Parameters
    ----------
    errors
        Beside the plate; None where none was named.
    """

    options: ProsthesisSimulateOptions
    walk: Walk
    stance: Stance
    errors: StanceErrors | None
    numbers: Mapping[str, Number]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`stance` over time, `numbers`, and `errors` and `curves` where a plate was named."""
        told = {"stance": stance_table(self.stance, self.options.side), "numbers": numbers_table(self.numbers)}
        if self.errors is not None:
            told |= {"errors": errors_table(self.errors), "curves": curves_table(self.errors)}
        return told

    def figure(self) -> Figure:
        """Ground reaction and centre of pressure over time, beside the plate's."""
        s, plate = self.stance, self.walk.plate
        weight = s.motion.leg.person.mass * GRAVITY
        force = {"vertical": s.force[:, 1] / weight, "fore and aft": s.force[:, 0] / weight}
        if plate is not None:
            seen = at_times(s.time, plate.time, plate.force) / weight
            force |= {"vertical, plate": seen[:, 1], "fore and aft, plate": seen[:, 0]}
        along = {name: 1e2 * s.along_foot(name) for name in ("ground", "sphere")}
        panels = {"force [BW]": pd.DataFrame(force), "centre of pressure [% of the foot]": pd.DataFrame(along)}
        return curves_figure(s.time, panels)

    def write_files(self, folder: Path) -> None:
        """Tables, coordinates and external loads for OpenSim, spheres for ParaView, page; a gap case if on a floor."""
        for name, table in self.tables().items():
            write_table(table, folder, name)
        write_coordinates(folder, self.stance, self.options.side)
        write_loads(folder, self.stance, self.options.side)
        write_spheres(folder / "paraview", self.stance, self.options.side)
        if self.stance.ground == FLOOR:
            write_plane(folder / "plane", self.walk, self.stance)
        save_both(self.figure(), folder, "stance")
        self.write_page(folder / "report.html")

    def write_page(self, file: Path) -> None:
        """Moving foot with its forces and the path of the centre of pressure, curves, tables."""
        write_stance_page(file, self.record, self.options, self.stance, self.walk.plate, self.tables())
