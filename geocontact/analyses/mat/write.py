"""Everything the mat writes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from geocontact.analyses.figure_files import save_both
from geocontact.analyses.mat.figure import mat_figure
from geocontact.analyses.mat.page import MatStory, write_mat_report
from geocontact.analyses.mat.recording import Recording
from geocontact.analyses.mat.registration import registration_table
from geocontact.analyses.options_table import options_table
from geocontact.analyses.run_record import Record
from geocontact.cli.mat import MatOptions
from geocontact.data.errors import InputError
from geocontact.data.version import VERSION
from geocontact.geometry.drape.cells import Drape
from geocontact.geometry.register.quality import Registration
from geocontact.geometry.surface import Surface
from geocontact.io.recordings.mat_landmarks import MatLandmarks
from geocontact.io.text.results import write_table
from geocontact.loads.mat.errors import MatErrors
from geocontact.loads.mat.load import MatLoad
from geocontact.loads.mat.map import MatMap
from geocontact.view.page.content import Table
from geocontact.view.surfaces.mat_vtp import write_mat_vtp

MM, MM2 = 1e3, 1e6
AXES = "xyz"


@dataclass(frozen=True, eq=False)
class Result:
    """What was found.

    Parameters
    ----------
    pressure
        Of the cells of the map [Pa].
    covariance
        Of force and moment, frame by frame.
    home
        Name of the frame that surface, cells and pictures are in; with --motion the loads are in another.
    """

    surface: Surface
    laid: Drape
    map: MatMap
    marks: MatLandmarks
    seen: Recording
    pressure: Float[np.ndarray, "t n"]
    whole: MatLoad
    parts: Mapping[str, MatLoad]
    covariance: Float[np.ndarray, "t six six"]
    errors: MatErrors
    registration: Registration | None
    home: str


@dataclass(frozen=True, eq=False)
class Beside:
    """The same mat as the closest points would have laid it.

    Parameters
    ----------
    distortion
        Area of each cell of the grid over that of the flat cell, minus 1; so -1 where it is not on the scan.
    table
        The two ways beside each other, for the page.
    """

    distortion: Float[np.ndarray, "r c"]
    table: Table


def write_results(
    record: Record, r: Result, agreed: pd.DataFrame | None, beside: Beside | None, o: MatOptions, folder: Path
) -> None:
    """Tables with point and frame in their first lines, the surface for ParaView, figure and page."""
    time = r.seen.frames.time
    _write(load_table(r.whole, time).assign(**_saturated(r)), folder, "wrench", r, o)
    _write(uncertainty_table(r), folder, "uncertainty", r, o)
    write_table(cell_table(r, beside), folder, o.parquet, "cells")
    write_table(frames_table(r), folder, o.parquet, "frames_cells")
    if r.parts:
        tables = [load_table(part, time).assign(segment=name) for name, part in r.parts.items()]
        _write(pd.concat(tables).loc[:, ["segment", *tables[0].columns[:-1]]], folder, "segments", r, o)
    if r.registration is not None:
        write_table(registration_table(r.registration), folder, o.parquet, "registration")
    if agreed is not None:
        write_table(agreed, folder, o.parquet, "agreement")
    heaviest = int(np.argmax(r.whole.pressing))
    chosen = {"peak over time": r.pressure.max(axis=0), "mean over time": r.pressure.mean(axis=0)}
    chosen[f"frame {heaviest + 1}, {time[heaviest]:g} s"] = r.pressure[heaviest]
    faces = {
        f"pressure, {name} [Pa]": r.map.face_pressure(values[None], r.surface.face_area)[0]
        for name, values in chosen.items()
    }
    try:
        write_mat_vtp(folder / "mat_on_surface.vtp", r.surface, faces, f"geocontact {VERSION}")
    except InputError as error:
        record.warn(str(error))
    drawing = save_both(mat_figure(time, r.whole, r.laid, r.pressure, r.map), folder, "mat")
    story = MatStory(
        r.surface, r.seen.frames, r.map, r.laid, r.pressure, r.whole, r.parts, r.covariance, drawing, r.home
    )
    write_mat_report(
        folder / "report.html",
        f"{r.seen.frames.name} on {r.surface.name}",
        story,
        (*(() if beside is None else (beside.table,)), options_table(record)),
        record.warnings,
    )


def load_table(load: MatLoad, time: Float[np.ndarray, " t"]) -> pd.DataFrame:
    """Wrench, pressing, area, pressures and centre of every frame; the centre is empty below the gate."""
    force, moment, centre = load.wrench.force, load.wrench.moment, load.centre * MM
    return pd.DataFrame(
        {
            "time [s]": time,
            **{f"f{axis} [N]": force[:, k] for k, axis in enumerate(AXES)},
            **{f"m{axis} [N m]": moment[:, k] for k, axis in enumerate(AXES)},
            "normal [N]": load.pressing,
            "perpendicular [N]": load.perpendicular,
            "area [mm^2]": load.area * MM2,
            "peak [Pa]": load.peak,
            "mean [Pa]": load.mean,
            **{f"cop_{axis} [mm]": centre[:, k] for k, axis in enumerate(AXES)},
        }
    )


def uncertainty_table(r: Result) -> pd.DataFrame:
    """Standard deviations of force and moment."""
    sd = np.sqrt(np.maximum(np.diagonal(r.covariance, axis1=1, axis2=2), 0.0))
    names = [f"sd_f{axis} [N]" for axis in AXES] + [f"sd_m{axis} [N m]" for axis in AXES]
    return pd.DataFrame({"time [s]": r.seen.frames.time, **{name: sd[:, k] for k, name in enumerate(names)}})


def cell_table(r: Result, beside: Beside | None) -> pd.DataFrame:
    """Where each cell lies, which way it looks, how its area changed: in the form that gap cases name a layout."""
    row, column = r.map.cell.T
    normal = r.laid.normal[row, column]
    return pd.DataFrame(
        {
            "id": [f"c{k}" for k in range(len(row))],
            "row": row,
            "column": column,
            **{f"{axis} [m]": r.map.centre[:, k] for k, axis in enumerate(AXES)},
            **{f"n{axis} [-]": normal[:, k] for k, axis in enumerate(AXES)},
            "area [m^2]": r.map.area,
            "distortion [-]": r.laid.distortion[row, column],
            **({} if beside is None else {"distortion_projected [-]": beside.distortion[row, column]}),
            "peak [Pa]": r.pressure.max(axis=0, initial=0.0),
            "saturated_frames": r.seen.saturated[:, row, column].sum(axis=0),
        }
    )


def frames_table(r: Result) -> pd.DataFrame:
    """Pressure of each cell over time, as gap cases hold cell channels."""
    columns = {f"c{k} [Pa]": r.pressure[:, k] for k in range(r.pressure.shape[1])}
    return pd.DataFrame({"time [s]": r.seen.frames.time, **columns})


def _saturated(r: Result) -> dict[str, Int[np.ndarray, " t"]]:
    """How many cells clip in each frame: forces are too low then."""
    row, column = r.map.cell.T
    return {"saturated [-]": r.seen.saturated[:, row, column].sum(axis=1)}


def _write(table: pd.DataFrame, folder: Path, name: str, r: Result, o: MatOptions) -> None:
    write_table(table, folder, o.parquet, name)
    file = folder / f"{name}.csv"
    point = ", ".join(f"{value * MM:.12g}" for value in r.whole.wrench.origin[0])
    head = f"# point_mm = {point}\n# frame = {r.whole.wrench.frame}; forces are those of the mat on the body\n"
    file.write_text(head + file.read_text(encoding="utf-8"), encoding="utf-8", newline="\n")
