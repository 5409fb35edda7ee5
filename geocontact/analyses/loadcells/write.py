"""Everything that the load cells' analysis writes."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from geocontact.analyses.figure_files import save_both
from geocontact.analyses.loadcells.cycles import SIDES, Cut, cycle_table, ensemble_table, stacked, style_table
from geocontact.analyses.loadcells.figure import ensemble_figure, loadcell_figure
from geocontact.analyses.loadcells.page import CYCLES, STYLES, write_loadcell_report
from geocontact.analyses.options_table import options_table
from geocontact.analyses.run_record import Record
from geocontact.cli.loadcells import LoadcellOptions
from geocontact.data.cell_regression import CellRegression
from geocontact.io.recordings.load_cells import CellRecording
from geocontact.io.text.results import write_table
from geocontact.loads.loadcells import CompartmentForces
from geocontact.view.curves.given import SERIES
from geocontact.view.page.tables import frame_table, inputs_table


def write_ensemble(record: Record, cuts: list[Cut], o: LoadcellOptions, folder: Path) -> bytes | None:
    """Tables and figure of the cycles of all recordings; returns the figure for the pages."""
    if not cuts:
        return None
    write_table(cycle_table(cuts), folder, o.parquet, "cycles")
    write_table(ensemble_table(cuts), folder, o.parquet, "ensemble")
    totals = stacked(cuts, SIDES[0])
    if len(totals) > 1:
        write_table(style_table(cuts), folder, o.parquet, "styles")
    if len(totals) > SERIES:
        record.warn(f"{len(totals)} styles are more than a figure tells apart ({SERIES}); ensemble.csv has them all")
        return None
    along = "cycle" if o.part is None else f"first {o.part} of the cycle"
    figure = ensemble_figure({side: stacked(cuts, side) for side in SIDES[:2]}, along)
    return save_both(figure, folder, "ensemble")


def write_recording(
    record: Record,
    recording: CellRecording,
    forces: CompartmentForces,
    regression: CellRegression,
    cuts: list[Cut],
    ensemble: bytes | None,
    o: LoadcellOptions,
    folder: Path,
    name: str,
) -> None:
    """Table, figure and page of one recording; `name` is that of its sub-folder, empty where there is one recording."""
    columns = {f"{side} [N]": values for side, values in forces.curves.items()}
    write_table(pd.DataFrame({"time [s]": forces.time, **columns}), folder, o.parquet, "forces")
    cells = dict(zip(regression.cells, recording.forces.T, strict=True))
    mine = tuple(cut.span for cut in cuts if cut.recording == Path(recording.file).stem)
    save_both(loadcell_figure(forces.time, cells, forces.curves, mine), folder, "loadcells")
    inputs = [i for i in record.inputs if i.get("folder", name or ".") == (name or ".")]
    tables = [inputs_table(inputs), options_table(record)]
    if cuts:
        tables.append(frame_table(CYCLES, cycle_table(cuts), 5))
    if len(stacked(cuts, SIDES[0])) > 1:
        tables.append(frame_table(STYLES, style_table(cuts), 5))
    title = f"Load cells of {Path(recording.file).name}"
    write_loadcell_report(
        folder / "report.html", title, cells, forces, regression, ensemble, tables, list(record.warnings)
    )
