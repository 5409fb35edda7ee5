"""What a centre of pressure is found to be: tables, figure, page."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.cop.along_foot import along_foot, stance_table
from geocontact.analyses.cop.figure import LoadCurves, cop_figure
from geocontact.analyses.cop.foot_loads import FootLoads, loads_table
from geocontact.analyses.cop.page import write_cop_report
from geocontact.analyses.figure_files import save_both
from geocontact.io.text.results import write_table

if TYPE_CHECKING:
    from matplotlib.figure import Figure

FRAME = "ground"
WORDS = "the frame in which the motion gives the foot's pose; forces are those on the foot"
FOOT_WORDS = "distance from the heel along the foot's own axis, and that over the length of the foot"
CENTRES = {"ground": "centre of the ground points", "sphere": "centre of the sphere centres"}


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class CopResult(FootLoads):
    """Loads on a foot over its motion, with tables, figure and page."""

    def tables(self) -> dict[str, pd.DataFrame]:
        """`cop`, `zones`; `comparison` with a plate, `along_foot` with `toe`, `stances` where asked for."""
        found = {"cop": loads_table(self), "zones": self._zones_table()}
        if self.comparison is not None:
            found["comparison"] = self.comparison
        within = along_foot(self)
        if within is not None:
            found["along_foot"] = within
        if self.options.stances:
            found["stances"] = stance_table(self, found["cop"])
        return found

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
            if name == "along_foot":
                told = {"frame": "foot", "words": FOOT_WORDS}
            self.record.tables[f"{name}.csv"] = told
        save_both(self.figure(), folder, "cop")
        write_cop_report(self, folder / "report.html")

    def write_page(self, file: Path) -> None:
        """The path under the foot, the forces along it, and their numbers in every frame."""
        write_cop_report(self, file)

    def _zones_table(self) -> pd.DataFrame:
        """Normal force of every zone."""
        forces = {f"{name} [N]": force for name, force in self.zones.items()}
        return pd.DataFrame({"time [s]": self.foot.motion.time, **forces})
