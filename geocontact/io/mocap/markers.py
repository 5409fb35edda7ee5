"""One way in for every kind of marker file, tables among them, and which marker is which of a model.

`geocontact markers` writes such tables. Every column names its unit. An empty cell is a marker that was not seen.
"""

from __future__ import annotations

from os import PathLike, fspath
from pathlib import Path

import numpy as np

from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.io.mocap.c3d_markers import read_c3d_markers
from geocontact.io.mocap.trc import read_trc
from geocontact.io.text.file_preflight import read_text_bytes
from geocontact.io.text.tables import read_table
from geocontact.io.text.units import LENGTH, length_unit

EXAMPLE = "RHEE=R.Heel"
LARGEST_MAP = 1_000_000
"""Bytes."""
HEAD = ("recorded", "lab", "label")
"""First cells that begin a head of two columns."""


def read_marker_map(path: str | PathLike[str]) -> dict[str, str]:
    """Names of the model by those of the recording, a pair in each line: `RHEE=R.Heel` or `RHEE,R.Heel`.

    Empty lines and those that begin with # are passed over, and so is a head of the columns recorded and model.
    """
    file = fspath(path)
    found: dict[str, str] = {}
    for number, line in enumerate(_text(path).splitlines(), 1):
        text = line.strip().rstrip(",;")
        if not text or text.startswith("#"):
            continue
        for mark in ("=", "\t", ";", ","):
            if mark in text:
                break
        cells = [cell.strip().strip('"') for cell in text.split(mark)]
        if cells[0].lower() in HEAD and not found:
            continue
        _add(found, cells, file, f"line {number}")
    if not found:
        raise InputError(file, "", "holds no pair of markers", f"write {EXAMPLE} in each line")
    return found


def _text(path: str | PathLike[str]) -> str:
    return read_text_bytes(path, LARGEST_MAP, "is it a map of names?").decode("utf-8-sig", errors="replace")


def marker_map_typed(text: str, option: str) -> dict[str, str]:
    """The same from one text, pairs between commas."""
    found: dict[str, str] = {}
    for part in text.split(","):
        _add(found, [cell.strip() for cell in part.split("=")], "", option)
    return found


def _add(found: dict[str, str], cells: list[str], file: str, place: str) -> None:
    if len(cells) != 2 or not all(cells):
        what = f"'{'='.join(cells)[:60]}' is not a recorded marker and one of the model"
        raise InputError(file, place, what, f"write for example {EXAMPLE}")
    recorded, name = cells
    if recorded in found or name in found.values():
        twice = recorded if recorded in found else name
        raise InputError(file, place, f"'{twice[:60]}' is named twice", "name each marker once")
    found[recorded] = name


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
        raise InputError(table.file, line, "a coordinate is infinite", "leave missing cells empty")
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


def read_markers(path: str | PathLike[str], c3d_unit: str | None = None) -> MarkerTrajectories:
    """Marker trajectories of a .trc, .c3d or .csv file in metres, in the file's own axes.

    `c3d_unit` is that of a .c3d file whose own is empty.
    """
    suffix = Path(fspath(path)).suffix.lower()
    if suffix == ".trc":
        return read_trc(path)
    if suffix == ".c3d":
        return read_c3d_markers(path, c3d_unit)
    if suffix == ".csv":
        return read_csv_markers(path)
    raise InputError(path, "", f"'{suffix}' is not a file of markers", "give a .trc, .c3d or .csv file")
