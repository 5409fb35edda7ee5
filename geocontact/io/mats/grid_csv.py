"""A plain grid: one row per frame, the time first and then one column per cell.

A layout file places the cells. Columns are `time [s]` (or
[ms]; without it the layout has `rate_Hz`) and one for each cell, whose name ends with the cell's id, `1`, `cell_17`, or
is its row and column from 0, `r0c0`. Their unit is in brackets, `17 [kPa]`, or in the layout. Lines before the header
that begin with `#` are skipped.
"""

from __future__ import annotations

import re
from array import array

import numpy as np

from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import Growing
from geocontact.data.pressure_frames import PressureFrames
from geocontact.io.mats.cells import MatRecording, frames_of
from geocontact.io.mats.layout import MatLayout, pressure_unit
from geocontact.io.mats.text import MatText, Notation, notation_of, shown
from geocontact.io.text.csv_text import LONGEST_NAME
from geocontact.io.text.units import split_header

KIND = "grid"

_TIME = re.compile(r"time\s*(?:\(?\s*(?P<unit>\w+)\s*\)?)?", re.IGNORECASE)
_SECONDS = {"": 1.0, "s": 1.0, "sec": 1.0, "secs": 1.0, "ms": 1e-3}
_ID = re.compile(r"[^\d]*(?P<id>\d{1,6})")
_PLACE = re.compile(r"r(?P<row>\d{1,4})c(?P<column>\d{1,4})")


def is_grid(text: MatText) -> bool:
    """Whether the first line that is no comment names columns, the last of them with an id."""
    header = next((line for line in text.head if line and not line.startswith("#")), "")
    names = [name for name, _ in _names(header, notation_of([header], None, ""))]
    return len(names) > 1 and all(_ID.fullmatch(name) or _PLACE.fullmatch(name) for name in names[1:])


def read_grid(text: MatText, layout: MatLayout | None, *, signed: bool = False) -> tuple[PressureFrames, ...]:
    """Frames of one mat, whose rows, columns and pitch the layout declares; `signed` ones hold shear stresses."""
    if layout is None or layout.rows is None or layout.columns is None:
        remedy = "give a layout file with rows, columns and pitch_mm"
        raise InputError(text.file, "", "a grid of cells does not say how they lie", remedy)
    rows = text.lines()
    header = next((found for found in rows if not found[1].startswith("#")), None)
    if header is None:
        raise InputError(text.file, "", "no header", "one row `time [s], 1, 2, ...` is needed")
    notation = notation_of([row for row in text.head[header[0] :] if row] or [header[1]], layout, text.file)
    time_scale, ids, unit = _columns(header, notation, layout, text.file)
    time, lines, values = array("d"), array("q"), Growing()
    width = len(ids) + (time_scale is not None)
    for number, line in rows:
        cells = notation.cells(line)
        if len(cells) != width:
            what = f"{len(cells)} cells where {width} columns are named"
            remedy = f"is the row cut off, or delimiter and decimal other than read here ({notation.words})?"
            raise InputError(text.file, f"line {number}", what, remedy)
        if time_scale is not None:
            time.append(_time(cells.pop(0), notation, text.file, number) * time_scale)
        notation.add(cells, values, text.file, number)
        lines.append(number)
    if not lines:
        raise InputError(text.file, f"line {header[0]}", "no rows below the header", "is the export complete?")
    complete = None if ids == list(range(layout.rows * layout.columns)) else ids
    found = MatRecording(text.file, "mat", time if time_scale is not None else None, lines, values, unit, complete)
    return (frames_of(found, layout, signed=signed),)


def _time(cell: str, notation: Notation, file: str, line: int) -> float:
    try:
        value = notation.number(cell.strip().strip('"'))
    except ValueError:
        value = float("nan")
    if not np.isfinite(value):
        raise InputError(
            file, f"line {line}", f"time is '{shown(cell.strip())}'", "every frame needs its time in seconds"
        )
    return value


def _columns(
    header: tuple[int, str], notation: Notation, layout: MatLayout, file: str
) -> tuple[float | None, list[int], float | None]:
    """Seconds per unit of time (None without such a column), ids from 0, Pascals per unit of the cells."""
    place = f"line {header[0]}"
    names = _names(header[1], notation)
    scale = None
    if match := _TIME.fullmatch(names[0][0]):
        unit = names.pop(0)[1] or match["unit"] or ""
        if unit not in _SECONDS:
            raise InputError(file, place, f"time is in '{shown(unit)}'", "write `time [s]` or [ms]")
        scale = _SECONDS[unit]
    ids = []
    for name, _ in names:
        place_of = _PLACE.fullmatch(name)
        if place_of is not None:
            ids.append(_placed_id(int(place_of["row"]), int(place_of["column"]), layout, file, place))
            continue
        found = _ID.fullmatch(name)
        if found is None:
            what = f"column '{shown(name)}' is neither time nor a cell with an id"
            raise InputError(file, place, what, "one row `time [s], 1, 2, ...` is needed above the frames")
        ids.append(int(found["id"]) - layout.first_id)
    if not ids:
        raise InputError(file, place, "names no cell", "one row `time [s], 1, 2, ...` is needed above the frames")
    if scale is None and ids != sorted(ids):
        raise InputError(file, place, "no column `time` and no ids in order", "is the header missing?")
    if min(ids) < 0:
        raise InputError(file, place, "there is a cell 0", "say first_id = 0 in the layout")
    if len(set(ids)) < len(ids):
        twice = sorted(ids)[int(np.flatnonzero(np.diff(sorted(ids)) == 0)[0])] + layout.first_id
        raise InputError(file, place, f"cell {twice} occurs twice", "each cell has one column")
    return scale, ids, _unit({unit for _, unit in names}, file, place)


def _placed_id(row: int, column: int, layout: MatLayout, file: str, place: str) -> int:
    """Number from 0, in the order of the layout, of the cell in a row and column of the file's own drawing."""
    rows, columns = layout.rows or 0, layout.columns or 0
    if row >= rows or column >= columns:
        raise InputError(
            file, place, f"cell r{row}c{column} is not on a mat of {rows} x {columns}", "both count from 0"
        )
    outer, inner, count = (row, column, columns) if layout.order == "row" else (column, row, rows)
    return outer * count + (count - 1 - inner if layout.serpentine and outer % 2 else inner)


def _names(header: str, notation: Notation) -> list[tuple[str, str]]:
    """Name and unit of each column."""
    parts = [split_header(cell[:LONGEST_NAME]) for cell in notation.cells(header)]
    return [(name.strip(), unit) for name, unit in parts]


def _unit(units: set[str], file: str, place: str) -> float | None:
    """Unit of all cells; None where their columns name none."""
    if units == {""}:
        return None
    known = {pressure_unit(unit) for unit in units}
    if len(known) > 1 or None in known:
        said = ", ".join(sorted(f"'{shown(unit)}'" for unit in units))
        raise InputError(file, place, f"cells are in {said}", "one unit of pressure for all of them is needed")
    return known.pop()
