"""Everything the area analysis writes for one motion."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.analyses import quantities
from geocontact.analyses.area.distance_file import FILE, write_maps
from geocontact.analyses.area.figure import draw_areas
from geocontact.analyses.area.page import write_report
from geocontact.analyses.area.pressure import PressureEvolution
from geocontact.analyses.area.pressure_write import write_pressures
from geocontact.analyses.area.scene import write_paraview, write_stills
from geocontact.analyses.options_table import options_table
from geocontact.analyses.run_record import Record

from geocontact.cli.area import AreaOptions
from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.evolution import Settings
from geocontact.geometry.contact_area.maps import DistanceMaps
from geocontact.geometry.surface import Surface
from geocontact.io.text.results import write_table
from geocontact.view.page.content import Table
from geocontact.view.page.tables import inputs_table

PARAVIEW = "paraview"
"""Folder of the series for ParaView."""


@dataclass(frozen=True)
class Analysis:
    """One motion of two bodies and how it is to be counted."""

    moving: Surface
    fixed: Surface
    motion: Motion
    settings: Settings
    options: AreaOptions
    name: str

    @property
    def title(self) -> str:
        """Heading of figure and page."""
        return f"MOVING {self.moving.name} on FIXED {self.fixed.name}" + (f", {self.name}" if self.name else "")


def write_results(
    record: Record,
    a: Analysis,
    evolution: AreaEvolution,
    maps: DistanceMaps,
    comparison: pd.DataFrame | None,
    pressure: PressureEvolution | None,
    reservations: list[str],
    folder: Path,
) -> None:
    """Table, static figure, page, and what was asked for beside them."""
    shown = None
    if pressure is not None:
        shown = write_pressures(pressure, a.fixed, a.motion, folder, a.options.parquet, a.options.save_map)
    write_table(_with_coordinate(evolution, a.motion, a.options.adduction), folder, a.options.parquet)
    if comparison is not None:
        comparison.to_csv(folder / "comparison.csv", index=False)
    if a.options.save_map:
        write_maps(folder / FILE, a.moving, a.fixed, a.motion, evolution, maps)
    draw_areas(
        evolution, a.fixed.vertices, a.fixed.faces, maps.fixed_at_largest, maps.largest, a.title,
        (folder / "area.png", folder / "area.svg"), a.motion.course,
    )  # fmt: skip
    if a.options.paraview:
        pressures = None if pressure is None else dict(zip(pressure.frames, pressure.pressure, strict=True))
        write_paraview(folder / PARAVIEW, a.moving, a.fixed, a.motion, evolution, maps, pressures)
    if a.options.stills:
        for note in write_stills(folder, a.moving, a.fixed, a.motion, evolution, maps, a.title):
            record.warn(note)
            reservations = [*reservations, note]
    inputs = [i for i in record.inputs if i.get("folder", a.name or ".") == (a.name or ".")]
    tables = [inputs_table(inputs), options_table(record)]
    if comparison is not None:
        tables.insert(0, _comparison_table(comparison))
    write_report(
        folder / "report.html",
        a.moving,
        a.fixed,
        a.motion,
        a.settings,
        evolution,
        maps,
        a.title,
        tables,
        reservations,
        shown,
    )


def _with_coordinate(evolution: AreaEvolution, motion: Motion, adduction: str | None) -> pd.DataFrame:
    """The table, with the angle that a sweep prescribes and the offset of adduction that was asked for."""
    table = evolution.table()
    if motion.coordinate is not None:
        name, angle = motion.coordinate
        table[f"{name} [deg]"] = np.repeat(np.degrees(angle), len(evolution.thresholds))
    if adduction is not None:
        table["adduction offset [deg]"] = np.round(np.degrees(quantities.turn(adduction, "--adduction")[1]), 9)
    return table


def _comparison_table(rows: pd.DataFrame) -> Table:
    texts = rows.map(lambda value: f"{value:.6g}" if isinstance(value, float) else str(value))
    return Table("Beside the measured areas", tuple(map(str, rows.columns)), texts.to_numpy().tolist())
