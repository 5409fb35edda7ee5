"""What load cells tell: forces of the compartments, the mean over cycles, figures and a page for each recording."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import pandas as pd

from geocontact.analyses.figure_files import drawing, save_both
from geocontact.analyses.loadcells.cycles import SIDES, Cut, stacked
from geocontact.analyses.loadcells.figure import ensemble_figure, loadcell_figure
from geocontact.analyses.loadcells.options import LoadcellOptions
from geocontact.analyses.loadcells.page import CYCLES, NEWTON, SHIFTS, STYLES, ForceUnit, loadcell_page
from geocontact.analyses.loadcells.recorded import RecordedCells
from geocontact.analyses.loadcells.tables import cycle_table, ensemble_table, shift_table, style_table
from geocontact.analyses.options_table import options_table
from geocontact.analyses.plain_page import write_plain_page
from geocontact.analyses.result import Result
from geocontact.data.cell_regression import CellRegression
from geocontact.io.text.results import write_table
from geocontact.view.curves.given import SERIES
from geocontact.view.page.tables import frame_table, inputs_table
from geocontact.view.page.write import write_page

ROWS = 100  # cycles that the page lists; cycles.csv has all

if TYPE_CHECKING:
    from matplotlib.figure import Figure


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
    def folders(self) -> tuple[str, ...]:
        """A sub-folder for each of several recordings."""
        return tuple(each.folder for each in self.recordings)

    def tables(self) -> dict[str, pd.DataFrame]:
        """`forces`, of several recordings `NAME/forces` each; with cycles `cycles`, `ensemble`, and
        of several styles `styles` and `shifts`.
        """
        found = {(Path(each.folder) / "forces").as_posix(): each.table() for each in self.recordings}
        return {**found, **self._over_cycles()}

    def figure(self) -> Figure:
        """The mean over the cycle, where cycles are asked for; else cells and compartments of the first recording."""
        return self._ensemble() or self._over_time(self.recordings[0])

    def write_files(self, folder: Path) -> None:
        """Cycles of all recordings; forces, figure and page of each."""
        for name, table in self._over_cycles().items():
            write_table(table, folder, name)
        figure = self._ensemble()
        if figure is not None:
            save_both(figure, folder, "ensemble")
        for each in self.recordings:
            own = folder / each.folder
            own.mkdir(exist_ok=True)
            write_table(each.table(), own, "forces")
            save_both(self._over_time(each), own, "loadcells")
            self._write_report(own / "report.html", each)

    def write_page(self, file: Path) -> None:
        """The page of the recording; of several all their tables."""
        if len(self.recordings) > 1:
            write_plain_page(self, f"Load cells of {len(self.recordings)} recordings", file)
            return
        self._write_report(file, self.recordings[0])

    def _over_cycles(self) -> dict[str, pd.DataFrame]:
        if not self.cuts:
            return {}
        found = {"cycles": cycle_table(self.cuts), "ensemble": ensemble_table(self.cuts)}
        if len(stacked(self.cuts, SIDES[0])) < 2:
            return found
        return {**found, "styles": style_table(self.cuts), "shifts": shift_table(self.cuts)}

    def _ensemble(self, unit: ForceUnit = NEWTON) -> Figure | None:
        """Mean over the cycle; None without cycles, and where there are more styles than a figure tells apart."""
        sides = {side: stacked(self.cuts, side) for side in SIDES[:2]}
        if not 0 < len(sides[SIDES[0]]) <= SERIES:
            return None
        part = self.options.part
        along = "cycle" if part is None else f"first {100.0 * part:g}% of the cycle"
        return ensemble_figure(sides, along, unit.name, unit.per_newton)

    def _drawn(self, unit: ForceUnit) -> bytes | None:
        figure = self._ensemble(unit)
        return None if figure is None else drawing(figure)

    def _over_time(self, each: RecordedCells) -> Figure:
        mine = tuple(cut.span for cut in self.cuts if cut.recording == each.file.stem)
        return loadcell_figure(each.forces.time, each.by_cell(self.regression), each.forces.curves, mine)

    def _write_report(self, file: Path, each: RecordedCells) -> None:
        found, titles = self._over_cycles(), {"cycles": CYCLES, "styles": STYLES, "shifts": SHIFTS}
        shown = [frame_table(title, found[name], 5, ROWS) for name, title in titles.items() if name in found]
        own = each.folder or "."
        inputs = [entry for entry in self.record.inputs if entry.get("folder", own) == own]
        provenance = [inputs_table(inputs), options_table(self.record)]
        page = loadcell_page(
            each,
            self.regression,
            self.cuts,
            self._drawn,
            self.options.body_weight,
            shown,
            provenance,
            self.warnings,
        )
        write_page(page, file)
