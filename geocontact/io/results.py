"""Tables of results as netCDF and Parquet: over time with coordinates and units, or of many trials one after the
other.

Classic format with 64-bit offsets, which every netCDF library reads; it knows no text of variable length and no
integers of 64 bits. Names of attributes follow the CF conventions 1.11 (https://cfconventions.org).

The variable `rows` counts the rows of each trial and says so by its attribute `sample_dimension` (CF conventions 1.11,
sec. 9.3.3). Every column is a variable over `row`, what trials differ in is a variable over `trial`. Columns are kept
in files until they are written, so that memory holds one of them at a time.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pandas as pd

from geocontact.data.frame_blocks import blocks, release, room
from geocontact.data.version import VERSION
from geocontact.io.text.units import split_header


def write_parquet(table: pd.DataFrame, file: Path) -> None:
    """Write it, some rows at a time; columns keep their names, units included."""
    import pyarrow as pa
    from pyarrow.parquet import ParquetWriter

    schema = pa.Schema.from_pandas(table, preserve_index=False)
    with ParquetWriter(file, schema) as out:
        for some in blocks(len(table), table.shape[1]):
            out.write_table(pa.Table.from_pandas(table.iloc[some], schema, preserve_index=False))
            release()


TIME = "time ["
ROW = "row"
UNITS = {"-": "1", "deg": "degree"}
"""Units that CF writes otherwise."""

_NOT_IN_A_NAME = re.compile(r"[^\w.+@-]")


def over_time(table: pd.DataFrame) -> bool:
    """Whether a table has a column of times."""
    return any(str(name).startswith(TIME) for name in table.columns)


def coordinates_of(table: pd.DataFrame) -> tuple[str, ...]:
    """Columns whose values number the rows of a full grid, the outer one first: time, or time and threshold.

    These are the fewest columns from the left on, time among them, that tell every row from the others. Empty where
    there are none, or rows are missing from the grid.
    """
    names = list(map(str, table.columns))
    first = next(k for k, name in enumerate(names) if name.startswith(TIME))
    for count in range(first + 1, len(names)):
        key = names[:count]
        if not table.duplicated(key).any():
            values = [table[name].unique() for name in key]
            grid = pd.MultiIndex.from_product(values, names=key)
            return tuple(key) if grid.equals(pd.MultiIndex.from_frame(table[key])) else ()
    return ()


def write_netcdf(table: pd.DataFrame, file: Path, about: Mapping[str, str]) -> None:
    """Write a table over time: a variable for each column, with its unit; `about` are attributes of the file.

    Where the rows are no full grid over time the dimension is `row`, and time is a variable like the others.
    """
    from scipy.io import netcdf_file

    names = variable_names(table.columns)
    axes = coordinates_of(table)
    with netcdf_file(str(file), "w", mmap=False, version=2) as out:
        for key, value in {"Conventions": "CF-1.11", **about}.items():
            setattr(out, key, value)
        if not axes:
            out.createDimension(ROW, len(table))
        for axis in axes:
            values = table[axis].unique()
            out.createDimension(names[axis], len(values))
            _write(out, names[axis], axis, np.asarray(values), (names[axis],))
        dimensions = tuple(names[axis] for axis in axes) or (ROW,)
        shape = tuple(table[axis].nunique() for axis in axes) or (len(table),)
        kinds = {str(name): _kind(table[name].to_numpy()) for name in table.columns if str(name) not in axes}
        places = _side_by_side([np.dtype(each).itemsize * len(table) for each in kinds.values() if each != TEXT])
        for column, kind in kinds.items():
            values = table[column].to_numpy().reshape(shape)
            place = next(places) if kind != TEXT and len(table) else None
            _write(out, names[column], column, values, dimensions, place, each=table.shape[1])


def _side_by_side(sizes: Sequence[int]) -> Iterator[np.ndarray]:
    """Room of so many bytes each, in one file: as many files as columns could not be open at once."""
    whole = [-(-size // 8) * 8 for size in sizes]  # a number of 8 bytes begins at a multiple of 8
    space, start = room((sum(whole),), np.uint8), 0
    for size, taken in zip(sizes, whole, strict=True):
        yield space[start : start + size]
        start += taken


def variable_names(columns: Iterable[object]) -> dict[str, str]:
    """Names of variables by column: without the unit, but for columns that only the unit tells apart."""
    plain = {str(column): _NOT_IN_A_NAME.sub("_", split_header(str(column))[0]) for column in columns}
    count = pd.Series(list(plain.values())).value_counts()
    return {
        column: name if count[name] == 1 and name != ROW else _NOT_IN_A_NAME.sub("_", column)
        for column, name in plain.items()
    }


TEXT = "c"


def _kind(values: np.ndarray) -> str:
    """Type of a variable in the file: text as characters, truth as 0 and 1."""
    if values.dtype.kind not in "fiub":
        return TEXT
    return "b" if values.dtype.kind == "b" else "d" if _needs_double(values) else "i"


def _write(
    out: Any,
    name: str,
    column: str,
    values: np.ndarray,
    dimensions: tuple[str, ...],
    place: np.ndarray | None = None,
    each: int = 1,
) -> None:
    """A variable with its unit, in bytes of `place` until it is written. Rows of `each` values lie in memory, or in a
    file, beside each other.
    """
    kind = _kind(values)
    if kind == TEXT:
        values = np.char.encode(np.array([text_of_cell(value) for value in values.ravel()]), "utf-8").reshape(
            values.shape
        )
        width = max(values.dtype.itemsize, 1)
        length = f"{name}_characters"
        out.createDimension(length, width)
        variable = out.createVariable(name, "c", (*dimensions, length))
        variable[:] = values.astype(f"S{width}").view("S1").reshape(*values.shape, width)
    else:
        variable = out.createVariable(name, kind, dimensions)
        if place is not None:
            variable.data = place.view(variable.data.dtype).reshape(values.shape)
        for some in blocks(len(values), each * values[:1].size):
            variable.data[some] = values[some]
            release()
    unit = split_header(column)[1]
    variable.long_name = column
    if unit:
        variable.units = UNITS.get(unit, unit)


def text_of_cell(value: object) -> str:
    """A cell as text, "" where it is empty."""
    return value if isinstance(value, str) else "" if pd.isna(value) else str(value)  # type: ignore[call-overload]


def _needs_double(values: np.ndarray) -> bool:
    return values.dtype.kind == "f" or (values.size > 0 and bool(np.abs(values).max() >= 2**31))


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
        count, numbers = sum(table.rows), sum(not text for _, text, _ in given)
        kept = np.memmap(Path(scratch) / "numbers", ">f8", "w+", shape=(numbers, count)) if numbers * count else None
        rows = iter(np.zeros((numbers, 0)) if kept is None else kept)
        for column, text, values in given:
            name = names[column]
            if name in out.variables or name in out.dimensions:
                name = f"{name}_of_row"
            if text:
                _write_text(out, name, [text_of_cell(v).encode() for part in values for v in part], ("row",), column)
            else:
                _write_numbers(out, name, column, values, next(rows))


def _write_text(out: Any, name: str, cells: list[bytes], over: tuple[str], column: str = "") -> None:
    width = max([1, *map(len, cells)])
    out.createDimension(f"{name}_characters", width)
    variable = out.createVariable(name, "c", (*over, f"{name}_characters"))
    variable[:] = np.array(cells, f"S{width}").view("S1").reshape(len(cells), width)
    variable.long_name = column or name


def _write_numbers(out: Any, name: str, column: str, values: Iterator[Any], place: np.ndarray) -> None:
    """A variable whose values lie in `place`, part of a file, until they are written."""
    variable = out.createVariable(name, "d", ("row",))
    if len(place):
        variable.data = place
    start = 0
    for part in values:
        variable.data[start : start + len(part)] = part
        start += len(part)
    unit = split_header(column)[1]
    variable.long_name = column
    if unit:
        variable.units = UNITS.get(unit, unit)
