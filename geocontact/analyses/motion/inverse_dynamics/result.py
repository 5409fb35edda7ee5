"""What inverse dynamics finds: generalised forces for OpenSim, what is left over at the ground, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.json_file import write_json
from geocontact.analyses.motion.figure import curves_figure
from geocontact.analyses.motion.gait_cycles import GaitCycles
from geocontact.analyses.motion.inverse_dynamics.forces import Forces
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.inverse_dynamics.page import write_forces_report
from geocontact.analyses.motion.inverse_dynamics.read import Loaded
from geocontact.analyses.motion.inverse_dynamics.setup import write_setup
from geocontact.analyses.options_table import options_table
from geocontact.analyses.result import Result
from geocontact.data.wrench import Wrench
from geocontact.io.opensim.storage_writer import write_storage
from geocontact.io.text.results import write_table
from geocontact.view.page.tables import inputs_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class IdResult(Result):
    """Moments and forces along the coordinates of a model.

    Parameters
    ----------
    forces
        Over time [N m, N].
    given
        Model, recording and loads.
    coordinates
        At the same times, filtered [rad, m].
    loads
        Measured ones by body, about the ground's origin.
    cycles
        Moments and forces by mass [N m/kg, N/kg] over the gait cycle, where there are heel strikes.
    summary
        Numbers of the whole motion, with units in their names.
    """

    options: IdOptions
    forces: Forces
    given: Loaded
    coordinates: Float[np.ndarray, "t n"]
    loads: Mapping[str, Wrench]
    cycles: GaitCycles
    summary: dict[str, Any]

    def tables(self) -> dict[str, pd.DataFrame]:
        """`forces`: a column for each coordinate, as OpenSim calls it, with its unit; `cycles` where there are some."""
        f = self.forces
        units = ["N m" if name.endswith("_moment") else "N" for name in f.names]
        columns = {f"{n} [{unit}]": v for n, unit, v in zip(f.names, units, np.asarray(f.values).T, strict=True)}
        found = {"forces": pd.DataFrame({"time [s]": f.time, **columns})}
        return {**found, "cycles": self.cycles.table()} if self.cycles else found

    def figure(self) -> Figure:
        """Moments and forces over time, without those at the ground."""
        table = self.table().iloc[:, 1:].loc[:, ~self.forces.at_ground]
        return curves_figure(
            self.forces.time,
            {"moment [N m]": table.filter(like="_moment ["), "force [N]": table.filter(like="_force [")},
        )

    def write_files(self, folder: Path) -> None:
        """id.sto for OpenSim, its set-up, the table of gait cycles, id.json, page."""
        f, title = self.forces, "Inverse Dynamics Generalized Forces"
        write_storage(folder / "id.sto", f.time, f.names, f.values, title=title, degrees=False)
        if self.cycles:
            write_table(self.table("cycles"), folder, "cycles")
        write_json(folder / "id.json", self.summary)
        write_setup(folder, self.options, self.given)
        self.write_page(folder / "report.html")

    def write_page(self, file: Path) -> None:
        """Moments and forces over time, and what is left over."""
        tables = [inputs_table(self.record.inputs), options_table(self.record)]
        title = f"Inverse dynamics of {self.options.coordinates.name}"
        write_forces_report(
            file,
            title,
            self.forces,
            self.coordinates,
            self.loads,
            self.cycles,
            tables,
            self.warnings,
            self.sentences,
        )
