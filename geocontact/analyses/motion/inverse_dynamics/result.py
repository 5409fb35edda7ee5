"""What inverse dynamics finds: generalised forces for OpenSim, what is left over at the ground, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.json_file import write_json
from geocontact.analyses.motion.figure import curves_figure
from geocontact.analyses.motion.gait_cycles import GaitCycles
from geocontact.analyses.motion.inverse_dynamics.forces import Forces
from geocontact.analyses.motion.inverse_dynamics.options import IdOptions
from geocontact.analyses.motion.inverse_dynamics.page import forces_page
from geocontact.analyses.motion.inverse_dynamics.read import Loaded
from geocontact.analyses.motion.inverse_dynamics.setup import write_setup
from geocontact.analyses.result import REPORT, Result
from geocontact.data.wrench import Wrench
from geocontact.io.opensim.storage_writer import write_storage

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page


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

    elsewhere: ClassVar[frozenset[str]] = frozenset({"forces"})

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

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """Moments and forces over time, and what is left over."""
        title = f"Inverse dynamics of {self.options.coordinates.name}"
        return {
            REPORT: forces_page(title, self.forces, self.coordinates, self.loads, self.cycles, self.sentences),
        }

    def write_files(self, folder: Path) -> None:
        """id.sto for OpenSim, its set-up and id.json besides."""
        f, title = self.forces, "Inverse Dynamics Generalized Forces"
        write_storage(folder / "id.sto", f.time, f.names, f.values, title=title, degrees=False)
        write_json(folder / "id.json", self.summary)
        write_setup(folder, self.options, self.given)
        super().write_files(folder)
