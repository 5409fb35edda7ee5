"""Contact forces from the load cells of an implant: `geocontact loadcells`, `gc.load_cells`.

>>> import geocontact as gc, numpy as np, pandas as pd
>>> time = np.linspace(0.0, 1.0, 101)
>>> largest = {"PM [N]": 400.0, "AM [N]": 300.0, "AL [N]": 200.0, "PL [N]": 250.0}
>>> cells = {name: force * np.sin(np.pi * time) for name, force in largest.items()}
>>> pd.DataFrame({"time [s]": time} | cells).to_csv("cells.csv", index=False)
>>> result = gc.load_cells("cells.csv")
>>> print(result)
largest forces: medial 696.5 N, lateral 453.5 N, total 1150.0 N (total at 0.5 s)
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.frame.job import Job
from geocontact.analyses.frame.result import Result
from geocontact.analyses.loadcells.cycles import (
    SIDES,
    Cut,
    cuts_asked_for,
    cycle_table,
    ensemble_table,
    say_cycles,
    shift_table,
    stacked,
    style_table,
)
from geocontact.analyses.loadcells.forces import LoadCellInputs, RecordedCells, doubt_drift, read, recorded_forces
from geocontact.analyses.loadcells.options import STANCE, LoadcellOptions
from geocontact.analyses.loadcells.show import (
    CYCLES,
    NEWTON,
    SHIFTS,
    STYLES,
    ForceUnit,
    ensemble_curves,
    loadcell_curves,
    loadcell_page,
)
from geocontact.data.cell_regression import CellRegression
from geocontact.view.curves.quantity import SERIES
from geocontact.view.page.tables import frame_table

ROWS = 100  # cycles that the page lists; cycles.csv has all

if TYPE_CHECKING:
    from geocontact.view.curves.declared import CurveSheet
    from geocontact.view.page.content import Page


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class LoadcellResult(Result):
    """Contact forces of a tibial tray over time and over cycles.

    Parameters
    ----------
    regression
        Weights of the cells in the two compartments.
    recordings
        Each with its forces.
    cuts
        Cycles of all recordings; empty where none are asked for.
    """

    options: LoadcellOptions
    regression: CellRegression
    recordings: tuple[RecordedCells, ...]
    cuts: list[Cut]

    @property
    def force(self) -> dict[str, dict[str, Float[np.ndarray, " t"]]]:
        """Force of "medial", "lateral" and "total" over time [N], by the name of the recording."""
        return {each.file.stem: each.forces.curves for each in self.recordings}

    @property
    def peak(self) -> dict[str, dict[str, float]]:
        """Largest force of "medial", "lateral" and "total" [N], by the name of the recording."""
        return {name: {side: float(f.max()) for side, f in sides.items()} for name, sides in self.force.items()}

    @property
    def folders(self) -> tuple[str, ...]:
        """A sub-folder for each of several recordings."""
        return tuple(each.folder for each in self.recordings)

    @property
    def title(self) -> str:
        """How many recordings there are."""
        return f"Load cells of {len(self.recordings)} recordings"

    def tables(self) -> dict[str, pd.DataFrame]:
        """`forces`, of several recordings `NAME/forces` each; with cycles `cycles`, `ensemble`, and
        of several styles `styles` and `shifts`.
        """
        found = {_named(each, "forces"): each.table() for each in self.recordings}
        return {**found, **self._over_cycles()}

    def curves(self) -> dict[str, CurveSheet]:
        """`ensemble`, the mean over the cycle, where cycles are asked for; `loadcells` of each recording over time."""
        mean = self._ensemble()
        each = {_named(one, "loadcells"): loadcell_curves(one, self.regression, self.cuts) for one in self.recordings}
        return each if mean is None else {"ensemble": mean, **each}

    def pages(self, drawings: Mapping[str, bytes]) -> dict[str, Page]:
        """One for each recording."""
        found, titles = self._over_cycles(), {"cycles": CYCLES, "styles": STYLES, "shifts": SHIFTS}
        tables = [frame_table(title, found[name], 5, ROWS) for name, title in titles.items() if name in found]

        return {
            _named(one, "report.html"): loadcell_page(
                one, self.regression, self.cuts, self._ensemble, self.options.body_weight, tables
            )
            for one in self.recordings
        }

    def _over_cycles(self) -> dict[str, pd.DataFrame]:
        if not self.cuts:
            return {}
        found = {"cycles": cycle_table(self.cuts), "ensemble": ensemble_table(self.cuts)}
        if len(stacked(self.cuts, SIDES[0])) < 2:
            return found
        return {**found, "styles": style_table(self.cuts), "shifts": shift_table(self.cuts)}

    def _ensemble(self, unit: ForceUnit = NEWTON) -> CurveSheet | None:
        """Mean over the cycle; None without cycles, and where there are more styles than a figure tells apart."""
        sides = {side: stacked(self.cuts, side) for side in SIDES[:2]}
        if not 0 < len(sides[SIDES[0]]) <= SERIES:
            return None
        part = self.options.part
        along = "cycle" if part is None else STANCE
        if isinstance(part, float):
            along = f"first {100.0 * part:g}% of the cycle"
        return ensemble_curves(sides, along, unit.name, unit.per_newton)


def _named(one: RecordedCells, file: str) -> str:
    """A file of one recording, in the sub-folder that it has among several."""
    return (Path(one.folder) / file).as_posix()


def run(given: LoadCellInputs, o: LoadcellOptions) -> LoadcellResult:
    """Forces of every recording, and the cycles of all of them."""
    recordings = recorded_forces(given, o)
    cuts = cuts_asked_for({each.file: each.forces for each in recordings}, given.cycles, o)
    for each in recordings:
        doubt_drift(each, given.regression, cuts)
    say_cycles(cuts)
    return LoadcellResult(options=o, regression=given.regression, recordings=recordings, cuts=cuts)


load_cells = Job("loadcells", LoadcellOptions, read, run)
