"""Tables of many trials in one netCDF file, one trial after the other: a contiguous ragged array.

The variable `rows` counts the rows of each trial and says so by its attribute `sample_dimension` (CF conventions 1.11,
sec. 9.3.3). Every column is a variable over `row`, what trials differ in is a variable over `trial`. Columns are kept
in files until they are written, so that memory holds one of them at a time.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from geocontact.data.version import VERSION
from geocontact.io.results.netcdf import UNITS, text_of_cell, variable_names
from geocontact.io.text.units import split_header

Column = tuple[str, bool, Iterator[Any]]


@dataclass(frozen=True)
class RaggedTable:
    """Name of the table, what tells its trials apart, and the rows of each."""

    name: str
    labels: Sequence[Mapping[str, str]]
    rows: Sequence[int]


def write_ragged(table: RaggedTable, columns: Iterable[Column], file: Path) -> None:
    """Write it; the classic format with 64-bit offsets, without a time of its making."""
    from scipy.io import netcdf_file

    with TemporaryDirectory(dir=file.parent) as scratch, netcdf_file(str(file), "w", mmap=False, version=2) as out:
        about = {"Conventions": "CF-1.11", "title": f"{table.name} of all trials", "source": f"geocontact {VERSION}"}
        for key, value in about.items():
            setattr(out, key, value)
        out.createDimension("trial", len(table.rows))
        out.createDimension("row", sum(table.rows))
        counts: Any = out.createVariable("rows", "i", ("trial",))
        counts[:] = np.asarray(table.rows)
        counts.long_name, counts.sample_dimension = "rows of each trial", "row"
        for label in dict.fromkeys(name for each in table.labels for name in each):
            _write_text(out, label, [each.get(label, "").encode() for each in table.labels], ("trial",))
        given = list(columns)
        names = variable_names([name for name, _, _ in given])
        for k, (column, text, values) in enumerate(given):
            name = names[column]
            if name in out.variables or name in out.dimensions:
                name = f"{name}_of_row"
            if text:
                _write_text(out, name, [text_of_cell(v).encode() for part in values for v in part], ("row",), column)
            else:
                _write_numbers(out, name, column, values, Path(scratch) / f"{k}.bin")


def _write_text(out: Any, name: str, cells: list[bytes], over: tuple[str], column: str = "") -> None:
    width = max([1, *map(len, cells)])
    out.createDimension(f"{name}_characters", width)
    variable = out.createVariable(name, "c", (*over, f"{name}_characters"))
    variable[:] = np.array(cells, f"S{width}").view("S1").reshape(len(cells), width)
    variable.long_name = column or name


def _write_numbers(out: Any, name: str, column: str, values: Iterator[Any], scratch: Path) -> None:
    """A variable whose values lie in a file until they are written."""
    count = out.dimensions["row"]
    variable = out.createVariable(name, "d", ("row",))
    if count:
        variable.data = np.memmap(scratch, ">f8", "w+", shape=(count,))
    start = 0
    for part in values:
        variable.data[start : start + len(part)] = part
        start += len(part)
    unit = split_header(column)[1]
    variable.long_name = column
    if unit:
        variable.units = UNITS.get(unit, unit)
