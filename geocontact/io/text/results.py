"""Tables of results as data frames and files, their columns named and in the units that are written."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterable, Mapping
from io import StringIO
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pandas as pd
from pandas.api.types import is_float_dtype

from geocontact.data import frame_blocks
from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import blocks, release, room
from geocontact.data.magnitude import too_large
from geocontact.data.plausible import TOO_LARGE
from geocontact.data.text import is_late, seconds
from geocontact.io.text.column_names import spelled_as
from geocontact.io.text.csv_text import require_once
from geocontact.io.text.plain_table import open_plain
from geocontact.io.text.units import si_unit, split_header

MOST_CELLS = 10_000
"""In a row; pandas takes hundreds of bytes for each column."""


def read_frame(path: Path, wanted: Iterable[str], remedy: str) -> pd.DataFrame:
    """Table below a row of names; lines that begin with # are passed over.

    Parameters
    ----------
    wanted
        Names that columns get which are written with other upper and lower case.
    remedy
        What to give instead of a file that is no table.
    """
    try:
        with open_plain(path) as stream:
            text = stream.read()
        wide = next((number for number, line in enumerate(text.split("\n"), 1) if line.count(",") > MOST_CELLS), 0)
        if wide:
            raise InputError(path, f"line {wide}", f"more than {MOST_CELLS} cells", remedy)
        names = next((told for line in text.split("\n") if (told := line.partition("#")[0]).strip()), "")
        require_once([name.strip() for name in next(csv.reader([names]), [])], path, "")
        table = pd.read_csv(StringIO(text), comment="#")
    except InputError:
        raise
    except (OSError, ValueError, csv.Error, pd.errors.ParserError) as error:
        raise InputError(path, "", f"cannot be read as a table ({error})", remedy) from error
    table.columns = [str(name).strip() for name in table.columns]
    for k, name in enumerate(table.columns):
        odd = np.flatnonzero(too_large(pd.to_numeric(table.iloc[:, k], errors="coerce").to_numpy(float)))
        if len(odd):
            what = f"'{name}' is {str(table.iloc[odd[0], k])[:40]}, which {TOO_LARGE}"
            raise InputError(path, f"row {odd[0] + 1}", what, remedy)
    return named(table, wanted)


def named(table: pd.DataFrame, wanted: Iterable[str]) -> pd.DataFrame:
    """The table with the columns that are wanted named so, where only upper and lower case differ."""
    return table.rename(columns=dict(spelled_as(wanted, table.columns)))


def frame_of(columns: Mapping[str, np.ndarray]) -> pd.DataFrame:
    """A data frame of columns of the same length; numbers of a long one lie in a file (`data.frame_blocks`)."""
    floats = [name for name, values in columns.items() if values.dtype == np.float64]
    count = len(columns[floats[0]]) if floats else 0
    if count * len(floats) <= frame_blocks.AT_ONCE:
        return pd.DataFrame(columns)
    values = room((len(floats), count))
    for row, name in zip(values, floats, strict=True):
        for some in blocks(count, 1):
            row[some] = columns[name][some]
            release()
    frame = pd.DataFrame(values.T, columns=pd.Index(floats), copy=False)
    for place, name in enumerate(columns):
        if name not in floats:
            frame.insert(place, name, columns[name])
    return frame


RESULTS: Mapping[str, str] = MappingProxyType(
    {
        "s": "s",
        "rad": "deg",
        "m": "mm",
        "m^2": "mm^2",
        "N": "N",
        "N m": "N m",
        "N/m": "N/m",
        "N s/m": "N s/m",
        "Pa": "Pa",
        "-": "-",
    }
)
"""Unit of tables for people, by the SI unit of the same dimension."""

CASES: Mapping[str, str] = MappingProxyType({si: si for si in RESULTS})
"""Unit of tables that gap cases are made of, and of what is written about a case: SI."""

BESIDE = (r"cycle \[%\]", r"(peak_)?later(_lower|_upper)? \[%\]", r"pressure \[mmHg\]")
"""A place in a cycle, how much later in it something is, and a cuff's pressure as its gauge shows it."""

KEPT = (r"(plate_|difference_)?cop_[xyz] \[m\]", r"max_depth \[m\]", r"peak\S* \[MPa\]")
"""Columns of cop.csv, its comparison.csv and pressure.csv that had another unit before there was one for each kind."""


def misfits(columns: Iterable[object], convention: Mapping[str, str]) -> list[str]:
    """Columns that are in another unit than the convention has for their kind; units of no kind known here are left."""
    return [str(column) for column in columns if not _fits(str(column), convention)]


def _fits(column: str, convention: Mapping[str, str]) -> bool:
    _, unit = split_header(column)
    known = si_unit(unit) if unit else None
    if known is None or convention.get(known[0], unit) == unit:
        return True
    return any(re.fullmatch(each, column) for each in (*BESIDE, *KEPT))


DIGITS = 12


ROWS = 1 << 15
"""Rows that are written at a time: texts of all of a long recording would take more than its numbers."""


def with_microseconds(table: pd.DataFrame, digits: int) -> pd.DataFrame:
    """The table with its columns in seconds as text, as far as so many digits would lose microseconds."""
    return _with_texts(table, _late_columns(table, digits), digits)


def _late_columns(table: pd.DataFrame, digits: int) -> list[str]:
    return [
        str(name)
        for name in table.columns
        if str(name).endswith("[s]") and is_float_dtype(table[name]) and is_late(table[name].abs().max(), digits)
    ]


def _with_texts(table: pd.DataFrame, columns: Iterable[str], digits: int) -> pd.DataFrame:
    texts = {name: ["" if pd.isna(each) else seconds(each, digits) for each in table[name]] for name in columns}
    return table.assign(**texts) if texts else table


def write_table(table: pd.DataFrame, folder: Path, name: str = "area", units: Mapping[str, str] = RESULTS) -> None:
    """Write `name`.csv: 12 digits, empty cells for missing values.

    Columns in seconds have microseconds however late their clock is. Nothing but the header stands above the rows:
    what a table refers to is stated in run.json. ValueError where a column is in another unit than `units` has for its
    kind: every table of every command goes through here.
    """
    if odd := misfits(table.columns, units):
        raise ValueError(f"{name}: {', '.join(odd)}: not the unit that tables have for this kind of quantity")
    late = _late_columns(table, DIGITS)
    with (folder / f"{name}.csv").open("w", encoding="utf-8", newline="") as file:
        for start in range(0, max(1, len(table)), ROWS):
            shown = _with_texts(table.iloc[start : start + ROWS], late, DIGITS)
            shown.to_csv(file, index=False, header=not start, float_format=f"%.{DIGITS}g", lineterminator="\n")
            release()
