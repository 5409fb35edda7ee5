"""A table of numbers and words: contact spheres, a support curve, the layout of a mat, results over time."""

from __future__ import annotations

import csv
import math
from array import array
from collections.abc import Iterable, Iterator
from io import TextIOBase
from os import fspath
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.data.errors import InputError
from geocontact.data.plausible import LARGEST_MEANT
from geocontact.io.text.csv_text import Column, open_csv
from geocontact.io.text.results import named

LARGEST_TABLE = 8_000_000
"""Bytes; a layout of 100 000 cells."""
LARGEST_RESULT = 128_000_000
"""Bytes of results over time; an hour of an arm's at 250 Hz."""


def read_side_table(path: Path, wanted: Iterable[str] = (), most_bytes: int = LARGEST_TABLE) -> pd.DataFrame:
    """Table with SI units in the names of its columns: `px [m]`, `torque [N m]`, `zone`.

    Columns with a unit hold numbers ([-] for pure ones), columns without hold words, and digits there are words too.
    No cell may be empty. Columns in `wanted` are named so where the file has other upper and lower case.
    """
    file = fspath(path)
    with open_csv(path, most_bytes) as (stream, columns, first):
        cells: list[array[float] | list[str]] = [array("d") if column.unit else [] for column in columns]
        for row, place in _rows(stream, file, first - 1):
            _append(row, cells, columns, file, place)
    if not cells[0]:
        raise InputError(file, f"line {first}", "no rows below the column names", "is the file complete?")
    data = {
        column.label: np.array(values) if column.unit else values for column, values in zip(columns, cells, strict=True)
    }
    return named(pd.DataFrame(data), wanted)


def _rows(stream: TextIOBase, file: str, above: int) -> Iterator[tuple[list[str], str]]:
    """Cells of each row that has any, and the line it ends in."""
    reader = csv.reader(stream, skipinitialspace=True)
    try:
        for row in reader:
            if any(cell.strip() for cell in row):
                yield row, f"line {reader.line_num + above}"
    except csv.Error as error:
        place = f"line {reader.line_num + above}"
        raise InputError(file, place, f"cannot be split ({error})", "check its quotes") from error


def _append(
    row: list[str], cells: list[array[float] | list[str]], columns: tuple[Column, ...], file: str, place: str
) -> None:
    if len(row) != len(columns):
        what = f"{len(row)} cells where {len(columns)} columns are named"
        raise InputError(file, place, what, "write decimal points, not commas, and rows as long as the header")
    for text, column, values in zip(row, columns, cells, strict=True):
        if isinstance(values, array):
            values.append(_number(text, column, file, place))
        else:
            values.append(_word(text, column, file, place))


def _number(text: str, column: Column, file: str, place: str) -> float:
    try:
        value = float(text) if text.isascii() and "_" not in text else math.nan
    except ValueError:
        value = math.nan
    if not abs(value * column.factor) <= LARGEST_MEANT:
        what = f"{text.strip()[:40]!r} in column '{column.name}' is not a finite number"
        raise InputError(file, place, what, "write decimal points and leave no cell empty")
    return value * column.factor


def _word(text: str, column: Column, file: str, place: str) -> str:
    word = text.strip(" \t")
    if not word or not word.isprintable():
        what = f"{word[:40]!r} in column '{column.name}' is not a word of printable characters"
        raise InputError(file, place, what, "leave no cell empty and no quote open")
    return word
