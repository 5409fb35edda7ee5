"""The first sheet of an Excel workbook as the text of a table."""

from __future__ import annotations

import csv
import warnings
from io import StringIO
from os import PathLike, fspath
from pathlib import Path

from geocontact.data.errors import InputError, InputWarning

SHEET = ".xlsx"
LARGEST_SHEET = 64_000_000
"""Bytes; a million rows of ten numbers."""


def is_sheet(path: str | PathLike[str]) -> bool:
    """Whether a file is a workbook by its name."""
    return Path(path).suffix.lower() == SHEET


def sheet_text(path: str | PathLike[str]) -> str:
    """Its cells with commas between them, a line for each row; InputError where it cannot be read.

    Cells hold what the workbook stores, not what it shows: numbers with all their digits.
    """
    file = fspath(path)
    try:
        import openpyxl  # noqa: F401  pandas reads through it
    except ImportError as error:
        remedy = "pip install openpyxl, or save the sheet as .csv"
        raise InputError(file, "", "reading .xlsx needs openpyxl", remedy) from error
    if Path(path).is_file() and Path(path).stat().st_size > LARGEST_SHEET:
        raise InputError(file, "", f"is larger than the {LARGEST_SHEET / 1e6:.0f} MB that are read", "cut it")
    import pandas as pd

    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of styles and validations, which hold no numbers
            sheets = pd.read_excel(path, sheet_name=None, header=None, dtype=object, engine="openpyxl")
    except FileNotFoundError:
        raise InputError(file, "", "there is no such file", "check the path") from None
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
