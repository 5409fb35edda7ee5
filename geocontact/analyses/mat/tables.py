"""Tables of a mat on a body, by the name of their file."""

from __future__ import annotations

import pandas as pd

from geocontact.analyses.mat.findings import MatFindings
from geocontact.analyses.mat.load_table import AXES, load_table
from geocontact.geometry.register.quality import Registration

MM = 1e3


def mat_tables(r: MatFindings) -> dict[str, pd.DataFrame]:
    """`wrench`, `uncertainty`, `cells`, `frames_cells`; and `segments`, `registration`, `agreement` where there are."""
    found = {
        "wrench": _wrench_table(r),
        "uncertainty": _uncertainty_table(r),
        "cells": _cell_table(r),
        "frames_cells": _frames_table(r),
    }
    if r.segments:
        found["segments"] = _segments_table(r)
    if r.registration is not None:
        found["registration"] = _registration_table(r.registration)
    if r.agreement is not None:
        found["agreement"] = r.agreement
    return found


def _wrench_table(r: MatFindings) -> pd.DataFrame:
    """Load of every frame, and how many cells clip: forces are too low then."""
    row, column = r.cells.cell.T
    table = load_table(r.loads, r.frames.time)
    return table.assign(**{"saturated [-]": r.saturated[:, row, column].sum(axis=1)})


def _uncertainty_table(r: MatFindings) -> pd.DataFrame:
    """Standard deviations of force and moment."""
    names = [f"sd_f{axis} [N]" for axis in AXES] + [f"sd_m{axis} [N m]" for axis in AXES]
    deviation = r.deviation
    return pd.DataFrame({"time [s]": r.frames.time, **{name: deviation[:, k] for k, name in enumerate(names)}})


def _cell_table(r: MatFindings) -> pd.DataFrame:
    """Where each cell lies, which way it looks, how its area changed: in the form that gap cases name a layout."""
    row, column = r.cells.cell.T
    normal, beside = r.drape.normal[row, column], r.closest_point
    return pd.DataFrame(
        {
            "id": [f"c{k}" for k in range(len(row))],
            "row": row,
            "column": column,
            **{f"{axis} [m]": r.cells.centre[:, k] for k, axis in enumerate(AXES)},
            **{f"n{axis} [-]": normal[:, k] for k, axis in enumerate(AXES)},
            "area [m^2]": r.cells.area,
            "distortion [-]": r.drape.distortion[row, column],
            **({} if beside is None else {"distortion_projected [-]": beside.distortion[row, column]}),
            "peak [Pa]": r.pressure.max(axis=0, initial=0.0),
            "saturated_frames": r.saturated[:, row, column].sum(axis=0),
        }
    )


def _frames_table(r: MatFindings) -> pd.DataFrame:
    """Pressure of each cell over time, as gap cases hold cell channels."""
    columns = {f"c{k} [Pa]": r.pressure[:, k] for k in range(r.pressure.shape[1])}
    return pd.DataFrame({"time [s]": r.frames.time, **columns})


def _segments_table(r: MatFindings) -> pd.DataFrame:
    """Load of each part, one below the other."""
    tables = [load_table(part, r.frames.time).assign(segment=name) for name, part in r.segments.items()]
    return pd.concat(tables, ignore_index=True).loc[:, ["segment", *tables[0].columns[:-1]]]


def _registration_table(found: Registration) -> pd.DataFrame:
    """The residual map: the points of the scan that were compared, in the body's frame."""
    return pd.DataFrame(
        {
            **{f"{axis} [mm]": found.points[:, k] * MM for k, axis in enumerate(AXES)},
            "residual [mm]": found.residual * MM,
        }
    )
