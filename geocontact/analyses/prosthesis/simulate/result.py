"""What a simulation finds: tables, files for OpenSim and ParaView, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.motion.figure import curves_figure
from geocontact.analyses.prosthesis.simulate.exports import write_coordinates, write_loads, write_spheres
from geocontact.analyses.prosthesis.simulate.options import ProsthesisSimulateOptions
from geocontact.analyses.prosthesis.simulate.page import stance_page
from geocontact.analyses.prosthesis.simulate.plane_files import write_plane
from geocontact.analyses.prosthesis.simulate.read import Walk
from geocontact.analyses.prosthesis.simulate.tables import curves_table, errors_table, numbers_table, stance_table
from geocontact.analyses.result import REPORT, Result
from geocontact.below_knee_prosthesis.model.leg_tree import GRAVITY
from geocontact.below_knee_prosthesis.model.stance_model import FLOOR
from geocontact.below_knee_prosthesis.simulate import Stance
from geocontact.below_knee_prosthesis.stance_errors import StanceErrors, at_times
from geocontact.data.sourced_number import Number

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


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

    def figures(self) -> dict[str, Figure]:
        """`stance`: ground reaction and centre of pressure over time, beside the plate's."""
        s, plate = self.stance, self.walk.plate
        weight = s.motion.leg.person.mass * GRAVITY
        force = {"vertical": s.force[:, 1] / weight, "fore and aft": s.force[:, 0] / weight}
        if plate is not None:
            seen = at_times(s.time, plate.time, plate.force) / weight
            force |= {"vertical, plate": seen[:, 1], "fore and aft, plate": seen[:, 0]}
        along = {name: 1e2 * s.along_foot(name) for name in ("ground", "sphere")}
        panels = {"force [BW]": pd.DataFrame(force), "centre of pressure [% of the foot]": pd.DataFrame(along)}
        return {"stance": curves_figure(s.time, panels)}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The moving foot with its forces and the path of the centre of pressure, curves, tables."""
        page = stance_page(self.options, self.stance, self.walk.plate, self.tables(), self.sentences)
        return {REPORT: page}

    def write_files(self, folder: Path) -> None:
        """Coordinates and external loads for OpenSim, spheres for ParaView besides; a gap case if on a floor."""
        write_coordinates(folder, self.stance, self.options.side)
        write_loads(folder, self.stance, self.options.side)
        write_spheres(folder / "paraview", self.stance, self.options.side)
        if self.stance.ground == FLOOR:
            seen = self.walk.cluster
            write_plane(folder / "plane", seen.time, seen.poses, self.walk.plate, self.stance)
        super().write_files(folder)
