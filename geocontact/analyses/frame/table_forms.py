"""Further forms that the tables of a result are written in, beside those that its command always writes."""

from __future__ import annotations

import csv
from dataclasses import dataclass
from importlib.util import find_spec
from io import StringIO
from pathlib import Path
from typing import TYPE_CHECKING

from geocontact.data.errors import InputError
from geocontact.data.version import VERSION

if TYPE_CHECKING:
    from collections.abc import Mapping

    import pandas as pd

FORMULA = ("=", "+", "-", "@", "\t", "\r")
"""A cell of a table that begins so is a formula to a spreadsheet program."""
INSTALL = "pip install 'geocontact[parquet]'"


def installed(library: str) -> bool:
    """Whether a library can be imported; it is not loaded."""
    return find_spec(library) is not None


@dataclass(frozen=True)
class TableForms:
    """Which forms are asked for.

    Parameters
    ----------
    parquet
        All tables as .parquet, with all their digits.
    netcdf
        Tables over time as .nc, with time and what else numbers their rows as coordinates.
    excel_safe
        Texts in .csv that a spreadsheet program would run as a formula are written with ' in front.
    """

    parquet: bool = False
    netcdf: bool = False
    excel_safe: bool = False

    def __post_init__(self) -> None:
        """Refuse what cannot be written here, before anything is computed."""
        if self.parquet and not installed("pyarrow"):
            raise InputError("", "`parquet`", "needs pyarrow, which is not installed", INSTALL)

    def given(self) -> dict[str, object]:
        """What is asked for, for `run.json`."""
        return {name: True for name in ("parquet", "netcdf", "excel_safe") if getattr(self, name)}

    def write(self, tables: Mapping[str, pd.DataFrame], folder: Path, command: str) -> None:
        """Write the tables, each by its name, into the folder or the sub-folder that the name begins with.

        One without columns has nothing that a file could hold, as in its .csv.
        """
        if self.parquet:
            from geocontact.io.results import write_parquet

            for name, table in tables.items():
                if len(table.columns):
                    write_parquet(table, _file(folder, name, "parquet"))
        if self.netcdf:
            from geocontact.io.results import over_time, write_netcdf

            timed = {name: table for name, table in tables.items() if over_time(table)}
            if not timed:
                raise InputError("", "`netcdf`", f"{command} has no table over time", "leave it out")
            for name, table in timed.items():
                about = {"title": f"{name} of geocontact {command}", "source": f"geocontact {VERSION}"}
                write_netcdf(table, _file(folder, name, "nc"), about)
        if self.excel_safe:
            for file in sorted(folder.rglob("*.csv")):
                quote_formulas(file)


AS_ALWAYS = TableForms()
"""None of them."""


def quote_formulas(file: Path) -> None:
    """Put ' before each text of a table that begins like a formula: =, +, -, @, a tabulator or the end of a line.

    Numbers stay as they are. What a spreadsheet program runs: OWASP, "CSV injection".
    """
    rows = list(csv.reader(StringIO(file.read_text(encoding="utf-8"), newline="")))
    safe = [[f"'{cell}" if cell.startswith(FORMULA) and not _is_number(cell) else cell for cell in row] for row in rows]
    if safe != rows:
        text = StringIO()
        csv.writer(text, lineterminator="\n").writerows(safe)
        file.write_text(text.getvalue(), encoding="utf-8", newline="")


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _file(folder: Path, name: str, ending: str) -> Path:
    file = folder / f"{name}.{ending}"
    file.parent.mkdir(parents=True, exist_ok=True)
    return file
