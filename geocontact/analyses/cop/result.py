"""What a centre of pressure is found to be: tables, figure, page."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd

from geocontact.analyses.cop.figure import LoadCurves, cop_figure
from geocontact.analyses.cop.foot_loads import FootLoads
from geocontact.analyses.cop.page import write_cop_report
from geocontact.analyses.figure_files import save_both
from geocontact.io.text.results import write_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FRAME = "ground"
WORDS = "the frame in which the motion gives the foot's pose; forces are those on the foot"
CENTRES = {"ground": "centre of the ground points", "sphere": "centre of the sphere centres"}


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class CopResult(FootLoads):
    """Loads on a foot over its motion, with tables, figure and page."""

    def tables(self) -> dict[str, pd.DataFrame]:
        """`cop`, `zones`, and `comparison` with a plate."""
        found = {"cop": self._loads_table(), "zones": self._zones_table()}
        return found if self.comparison is None else {**found, "comparison": self.comparison}

    def figure(self) -> Figure:
        """Forces, centre and free moment over time, and the path seen from above."""
        time, c = self.foot.motion.time, self.centre
        ours, theirs = LoadCurves(time, c.wrench.force, c.centre, c.free_moment), None
        if self.plate is not None:
            p = self.plate
            theirs = LoadCurves(time[p.frames], p.force, p.centre, p.free_moment)
        return cop_figure(ours, theirs, c.normal, f"{self.foot.name} on the ground, {self.options.motion.name}")

    def write_files(self, folder: Path) -> None:
        """Tables, figure and page."""
        for name, table in self.tables().items():
            write_table(table, folder, name)
            told = {"frame": FRAME, "words": WORDS, "cop": CENTRES[self.options.point]}
            self.record.tables[f"{name}.csv"] = told
        save_both(self.figure(), folder, "cop")
        write_cop_report(self, folder / "report.html")

    def write_page(self, file: Path) -> None:
        """The path under the foot, the forces along it, and their numbers in every frame."""
        write_cop_report(self, file)

    def _loads_table(self) -> pd.DataFrame:
        """Force, centre and free moment of every frame; centre and free moment are empty below the gate."""
        c = self.centre
        vectors = {
            f"{name}_{axis} [{unit}]": values[:, k]
            for name, unit, values in (("force", "N", c.wrench.force), ("cop", "m", c.centre))
            for k, axis in enumerate("xyz")
        }
        return pd.DataFrame(
            {
                "time [s]": self.foot.motion.time,
                **vectors,
                "free_moment [N m]": c.free_moment,
                "normal [N]": c.pressing,
                "spheres [-]": np.count_nonzero(self.loads.depth > 0.0, axis=1),
                "max_depth [m]": np.maximum(self.loads.depth.max(axis=1), 0.0),
            }
        )

    def _zones_table(self) -> pd.DataFrame:
        """Normal force of every zone."""
        zones = self.foot.sole.zones.items()
        forces = {f"{name} [N]": self.loads.pressing[:, which].sum(axis=1) for name, which in zones}
        return pd.DataFrame({"time [s]": self.foot.motion.time, **forces})
