"""Comma-separated text before its cells are read: what may not be in it, and the columns that its header names."""

from __future__ import annotations

import csv
import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from io import StringIO, TextIOBase
from os import fspath
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.io.text.file_preflight import BYTE_ORDER_MARK, UNKNOWN, looks_like, read_bytes
from geocontact.io.text.plain_table import is_sheet, open_plain
from geocontact.io.text.storage_header import LONGEST_LINE
from geocontact.io.text.units import DIMENSIONS, si_unit, split_header

MOST_COLUMNS = 1000

LONGEST_NAME = 100
"""Characters of a column's name."""

_QUOTED_COMMA = re.compile(r'"\s*[-+]?\d+,\d+(?:[eE][-+]?\d+)?\s*"')

_FIRST_ROW = re.compile(r"[^\r\n]*[\r\n]\s*(?P<row>[^\r\n]+)")


@dataclass(frozen=True)
class Column:
    """Name and unit in the file, SI unit and how many of it one unit is; units are "" where the header has none."""

    name: str
    unit: str
    si: str
    factor: float

    @property
    def label(self) -> str:
        """With the SI unit: "px [m]"; the name alone where there is no unit."""
        return f"{self.name} [{self.si}]" if self.si else self.name


def text_of(path: Path, most_bytes: int, kind: str = "a CSV table") -> bytes:
    """Content of a file of at most `most_bytes` that is UTF-8 text; the byte order mark is taken off."""
    file = fspath(path)
    data = read_bytes(path, most_bytes, "cut or resample it").removeprefix(BYTE_ORDER_MARK)
    if not data.strip():
        raise InputError(file, "", "the file is empty", "export or copy it again")
    what, _ = looks_like(data)
    if b"\0" in data and what in ("plain text", UNKNOWN[0]):
        what = "binary data"
    if what not in ("plain text", UNKNOWN[0]):
        remedy = "fetch the file itself, or save it as UTF-8 text"
        raise InputError(file, "", f"is not {kind}: it looks like {what}", remedy)
    try:
        data.decode("utf-8")
    except UnicodeDecodeError as error:
        line = data.count(b"\n", 0, error.start) + 1
        raise InputError(
            file, f"line {line}", f"byte 0x{data[error.start]:02x} is not UTF-8", "save it as UTF-8"
        ) from None
    return data


@contextmanager
def open_csv(path: Path, most_bytes: int) -> Iterator[tuple[TextIOBase, tuple[Column, ...], int]]:
    """Text of a CSV file from the line below the header on, its columns, and the number of that line.

    Lines that begin with # above the header are passed over. One header row, a name once; a unit that is there is
    known. Decimal commas between commas, tabs and a missing header are refused with the line that says so.
    """
    file = fspath(path)
    if not is_sheet(path):
        text_of(path, most_bytes)
    with open_plain(path) as plain:
        stream = StringIO(plain.read())
    line, header = 1, stream.readline(LONGEST_LINE)
    while header.startswith("#"):
        line, header = line + 1, stream.readline(LONGEST_LINE)
    if len(header) >= LONGEST_LINE:
        raise InputError(file, f"line {line}", "the header does not end", "one row of `name [unit]` is needed")
    columns = _columns(header, file, line)
    _refuse_decimal_commas(stream.getvalue()[stream.tell() - len(header) :], len(columns), file, line)
    yield stream, columns, line + 1


def _refuse_decimal_commas(text: str, count: int, file: str, first_line: int) -> None:
    """Quoted ones anywhere, and what is likeliest when the first row is longer than the header's `count` cells."""
    if found := _QUOTED_COMMA.search(text):
        line = text.count("\n", 0, found.start()) + first_line
        raise InputError(file, f"line {line}", f"decimal comma in {found[0]}", "write decimal points")
    first = _FIRST_ROW.match(text)
    cells = first["row"].count(",") + 1 if first and '"' not in first["row"] else 0
    if first and cells > count > 1:
        line = text.count("\n", 0, first.start("row")) + first_line
        what = f"{cells} cells where {count} columns are named (decimal commas?)"
        raise InputError(file, f"line {line}", what, "write decimal points, and rows as long as the header")


def split_commas(line: str, _separator: None, most: int) -> list[str]:
    """At most `most` + 1 cells of a line; none of a blank one. For `read_rows`."""
    return line.split(",", most) if line.strip() else []


def _columns(header: str, file: str, line: int) -> tuple[Column, ...]:
    cells = _cells(header, file, line)
    columns = tuple(
        _column(*split_header(cell), f"line {line}, column {number}", file) for number, cell in enumerate(cells, 1)
    )
    require_once([column.name for column in columns], file, f"line {line}")
    return columns


def require_once(names: Sequence[str], file: str | Path, place: str) -> None:
    """InputError for a column that is named twice; those without a name are none."""
    for name in filter(None, names):
        if names.count(name) > 1:
            what = f"column '{name}' occurs {names.count(name)} times"
            raise InputError(file, place, what, "give each column a name of its own")


def dict_rows(path: Path, most_bytes: int, kind: str) -> csv.DictReader[str]:
    """Rows of a table of words by the names of its columns, none of which is there twice; InputError as `text_of`."""
    lines = text_of(path, most_bytes, kind).decode("utf-8").splitlines()
    cells = csv.reader(lines)
    try:
        require_once(next(cells, []), path, "line 1")
        for _ in cells:
            pass
    except csv.Error as error:
        raise InputError(path, f"line {cells.line_num}", str(error), "close every quote") from error
    return csv.DictReader(lines)


def _cells(header: str, file: str, line: int) -> list[str]:
    """Cells of the header row."""
    if not header.strip():
        remedy = "one row of `name [unit]` is needed above the numbers"
        raise InputError(file, f"line {line}", "no column names", remedy)
    if "\t" in header and "," not in header:
        remedy = "save it with commas between columns and decimal points"
        raise InputError(file, f"line {line}", "columns are separated by tabs", remedy)
    if header.count('"') % 2:
        raise InputError(file, f"line {line}", "a quote is left open", "check the quotes of the column names")
    try:
        cells = next(csv.reader([header], skipinitialspace=True))
    except csv.Error as error:
        raise InputError(file, f"line {line}", f"the header cannot be split ({error})", "check its quotes") from error
    if len(cells) > MOST_COLUMNS:
        what = f"{len(cells)} columns are more than the {MOST_COLUMNS} that are read"
        raise InputError(file, f"line {line}", what, "keep the columns that are needed")
    if all(re.fullmatch(r"\s*[-+]?[\d.]+(e[-+]?\d+)?\s*", cell, re.IGNORECASE) for cell in cells):
        raise InputError(
            file, f"line {line}", "numbers where the header should be", "one row of `name [unit]` is needed"
        )
    return cells


def _column(name: str, unit: str, place: str, file: str) -> Column:
    if not name:
        raise InputError(file, place, "has no name", "write `name [unit]`")
    if not name.isprintable() or len(name) > LONGEST_NAME:
        what = f"{name[:40]!r} is not a name of printable characters, at most {LONGEST_NAME}"
        raise InputError(file, place, what, "rename it")
    if not unit:
        return Column(name, "", "", 1.0)
    known = si_unit(unit)
    if known is None:
        remedy = f"write one of {', '.join(unit for units in DIMENSIONS.values() for unit in units)}"
        raise InputError(file, place, f"'{name}' is in {unit[:40]!r}, which is not a unit known here", remedy)
    return Column(name, unit, *known)
