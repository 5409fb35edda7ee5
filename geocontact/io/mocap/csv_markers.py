"""Markers of a .csv table: `time [s]` and three columns `NAME_x [mm]`, `NAME_y [mm]`, `NAME_z [mm]` for each marker.

`geocontact markers` writes such tables. Every column names its unit. An empty cell is a marker that was not seen.
"""

from __future__ import annotations

from os import PathLike

import numpy as np

from geocontact.data.errors import InputError
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.io.text.tables import read_table
from geocontact.io.text.units import LENGTH, length_unit

AXES = ("x", "y", "z")


def read_csv_markers(path: str | PathLike[str]) -> MarkerTrajectories:
    """Markers of the table in metres; columns that belong to no marker are passed over."""
    table = read_table(path)
    if table.time_unit != "s":
        raise InputError(table.file, "", "time is in per cent of a cycle", "markers need seconds")
    suffixes = tuple(f"_{axis}" for axis in AXES)
    names = tuple(dict.fromkeys(c[:-2] for c in table.channels if c.endswith(suffixes)))
    if not names:
        raise InputError(table.file, "", "holds no marker", "name three columns NAME_x [mm], NAME_y [mm], NAME_z [mm]")
    positions = np.empty((len(table.time), len(names), 3))
    for k, name in enumerate(names):
        for i, axis in enumerate(AXES):
            positions[:, k, i] = _metres(table.file, f"{name}_{axis}", table.channels, table.units) * table.column(
                f"{name}_{axis}"
            )
    endless = np.flatnonzero(np.isinf(positions).any(axis=(1, 2)))
    if len(endless):
        line = f"line {table.lines[endless[0]]}"
        raise InputError(table.file, line, "a place is infinite", "leave missing cells empty")
    return MarkerTrajectories(table.time, positions, names, table.file)


def _metres(file: str, column: str, channels: tuple[str, ...], units: tuple[str, ...]) -> float:
    count = channels.count(column)
    if count != 1:
        what = f"no column '{column}'" if count == 0 else f"column '{column}' occurs {count} times"
        raise InputError(file, "", what, "every marker needs x, y and z once")
    written = units[channels.index(column)]
    unit = length_unit(written)
    if unit is None:
        known = ", ".join(LENGTH)
        raise InputError(file, f"column '{column}'", f"unit is '{written}'", f"write one of {known} in square brackets")
    return LENGTH[unit]
