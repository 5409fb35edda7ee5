"""What a centre of pressure is found to be: tables, figure, page."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.cop.along_foot import along_foot, stance_table
from geocontact.analyses.cop.figure import LoadCurves, cop_figure
from geocontact.analyses.cop.foot_loads import FootLoads, loads_table
from geocontact.analyses.cop.page import cop_page
from geocontact.analyses.result import REPORT

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from geocontact.view.page.content import Page

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

    def figures(self) -> dict[str, Figure]:
        """`cop`: forces, centre and free moment over time, and the path seen from above."""
        time, c = self.foot.motion.time, self.centre
        ours, theirs = LoadCurves(time, c.wrench.force, c.centre, c.free_moment), None
        if self.plate is not None:
            p = self.plate
            theirs = LoadCurves(time[p.frames], p.force, p.centre, p.free_moment)
        return {
            "cop": cop_figure(ours, theirs, c.normal, f"{self.foot.name} on the ground, {self.options.motion.name}")
        }

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """The path under the foot, the forces along it, and their numbers in every frame."""
        return {REPORT: cop_page(self)}

    def refers_to(self, table: str) -> Mapping[str, object]:
        """The frame, and which centre is meant."""
        if table == "along_foot":
            return {"frame": "foot", "words": FOOT_WORDS}
        return {"frame": FRAME, "words": WORDS, "cop": CENTRES[self.options.point]}

    def _zones_table(self) -> pd.DataFrame:
        """Normal force of every zone."""
        forces = {f"{name} [N]": force for name, force in self.zones.items()}
        return pd.DataFrame({"time [s]": self.foot.motion.time, **forces})
