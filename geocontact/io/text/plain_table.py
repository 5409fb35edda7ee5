"""The text of a table with commas between its cells and decimal points, however it was saved.

Spreadsheets of half the world write semicolons and decimal commas. They are read where nothing else can be meant, and
refused with the cell that leaves a doubt.
"""

from __future__ import annotations

import csv
import re
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from io import StringIO, TextIOBase
from os import PathLike, fspath
from pathlib import Path

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.text.file_preflight import open_file, open_text, regular_file
from geocontact.io.text.storage_header import LONGEST_LINE
from geocontact.io.text.unpacked import refuse_far_cells, refuse_unpacked

SHEET = ".xlsx"
LARGEST_SHEET = 64_000_000
"""Bytes; a million rows of ten numbers."""
MOST_XML = 800_000_000
"""Bytes that a workbook may unpack to: the same million rows have about 40 bytes of XML for each number."""
MOST_CELLS = 20_000_000
"""In a sheet, from A1 to the last row and the last column that hold anything: twice the same."""


def is_sheet(path: str | PathLike[str]) -> bool:
    """Whether a file is a workbook by its name."""
    return Path(path).suffix.lower() == SHEET


def sheet_text(path: str | PathLike[str]) -> str:
    """The cells of a sheet with commas between them, a line for each row; InputError where it cannot be read.

    Cells hold what the workbook stores, not what it shows: numbers with all their digits.
    """
    file = fspath(path)
    try:
        import openpyxl  # noqa: F401  pandas reads through it
    except ModuleNotFoundError as error:
        remedy = "pip install openpyxl, or save the sheet as .csv"
        raise InputError(file, "", "reading .xlsx needs openpyxl", remedy) from error
    regular_file(path, LARGEST_SHEET)
    import pandas as pd

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of styles and validations, which hold no numbers
            refuse_unpacked(path, MOST_XML)
            refuse_far_cells(path, MOST_CELLS)
            sheets = pd.read_excel(path, sheet_name=None, header=None, dtype=object, engine="openpyxl")
    except InputError:
        raise
    except Exception as error:  # whatever openpyxl meets in a damaged file: there is no common base
        raise InputError(file, "", f"cannot be read as a workbook ({error})", "save it again, or as .csv") from error
    filled = {name: sheet for name, sheet in sheets.items() if not sheet.empty}
    if not filled:
        raise InputError(file, "", "holds no cells", "is the right workbook named?")
    first = next(iter(filled))
    if len(filled) > 1:
        others = ", ".join(str(name) for name in filled if name != first)
        warnings.warn(InputWarning(f"{file}: sheet '{first}' is read, not {others}"), stacklevel=3)
    sheet = filled[first].dropna(axis="columns", how="all")
    text = StringIO()
    writer = csv.writer(text, lineterminator="\n")
    for row in sheet.itertuples(index=False):
        cells = ["" if pd.isna(cell) else str(cell) for cell in row]
        if cells[0].startswith("#"):
            text.write(cells[0] + "\n")
        else:
            writer.writerow(cells)
    return text.getvalue()


_COMMA = re.compile(r"\s*[-+]?\d*,\d+(?:[eE][-+]?\d+)?\s*")
_POINT = re.compile(r"\s*[-+]?\d*\.\d+(?:[eE][-+]?\d+)?\s*")
_THOUSANDS = re.compile(r"\s*[-+]?[1-9]\d{0,2},\d{3}\s*")
_BOTH = re.compile(r"\s*[-+]?[\d.,]*\d\s*")
_EMPTY_ROWS = re.compile(r"(?:\r?\n[ \t,]*)+\Z")
_EMPTY_END = re.compile(rb"[\r\n][ \t]*,[,\s]*\Z")
POINTS = "write decimal points throughout"
_TAIL = 1 << 16
_MOST_COMMENTS = 100


@contextmanager
def open_plain(path: str | PathLike[str], errors: str = "strict", encoding: str = "utf-8-sig") -> Iterator[TextIOBase]:
    """A .csv or .xlsx file as text; lines keep their numbers, rows without content at the end are left out.

    Parameters
    ----------
    errors
        What becomes of bytes that the encoding does not have: "strict" or "replace".
    encoding
        Of a .csv file.
    """
    if is_sheet(path):
        yield StringIO(_EMPTY_ROWS.sub("\n", sheet_text(path)))
        return
    with open_text(path, encoding, errors) as stream:
        separated = _separated_by_semicolons(stream)
        stream.seek(0)
        if separated:
            yield StringIO(_EMPTY_ROWS.sub("\n", _with_commas(stream.read(), fspath(path))))
        elif _ends_in_empty_rows(Path(path)):
            yield StringIO(_EMPTY_ROWS.sub("\n", stream.read()))
        else:
            yield stream


def _separated_by_semicolons(stream: TextIOBase) -> bool:
    """Whether the header has semicolons and no comma."""
    for _ in range(_MOST_COMMENTS):
        line = stream.readline(LONGEST_LINE)
        if not line.lstrip().startswith("#"):
            return ";" in line and "," not in line
    return False


def _ends_in_empty_rows(path: Path) -> bool:
    with open_file(path) as raw:
        raw.seek(max(0, path.stat().st_size - _TAIL))
        return _EMPTY_END.search(raw.read()) is not None


def _with_commas(text: str, file: str) -> str:
    """The same cells between commas, with decimal points."""
    lines = text.split("\n")
    rows = [None if line.lstrip().startswith("#") else _cells(line, k, file) for k, line in enumerate(lines, 1)]
    decimal_comma = _has_decimal_commas(rows, file)
    out = StringIO()
    writer = csv.writer(out, lineterminator="\n")
    for line, row in zip(lines, rows, strict=True):
        if not row:
            out.write(line + "\n")
        else:
            writer.writerow([_pointed(cell) for cell in row] if decimal_comma else row)
    return out.getvalue()


def _cells(line: str, number: int, file: str) -> list[str]:
    try:
        return next(csv.reader([line], delimiter=";", skipinitialspace=True), [])
    except csv.Error as error:
        raise InputError(file, f"line {number}", f"cannot be split ({error})", "check its quotes") from error


def _pointed(cell: str) -> str:
    return cell.replace(",", ".") if _COMMA.fullmatch(cell) else cell


def _has_decimal_commas(rows: list[list[str] | None], file: str) -> bool:
    """Whether commas are decimal ones; InputError where they may be something else."""
    comma = point = thousands = None
    for line, row in enumerate(rows, 1):
        for cell in row or ():
            if "," in cell and "." in cell and _BOTH.fullmatch(cell):
                raise InputError(file, f"line {line}", f"'{cell.strip()}' has a comma and a point", POINTS)
            if "," in cell and _COMMA.fullmatch(cell):
                if _THOUSANDS.fullmatch(cell):
                    thousands = thousands or (line, cell)
                else:
                    comma = comma or (line, cell)
            elif "." in cell and _POINT.fullmatch(cell):
                point = point or (line, cell)
    found = comma or thousands
    if found is None:
        return False
    place, cell = f"line {found[0]}", found[1].strip()
    if point is not None:
        what = f"'{cell}' has a comma and '{point[1].strip()}' in line {point[0]} a point"
        raise InputError(file, place, what, POINTS)
    if comma is None:
        what = f"'{cell}' may be thousands or have a decimal comma, as every cell with a comma"
        raise InputError(file, place, what, POINTS)
    return True
