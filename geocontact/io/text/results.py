"""Results to files: tables as CSV and Parquet."""

from __future__ import annotations

from pathlib import Path

import pandas as pd

from geocontact.io.text.late_times import with_microseconds

DIGITS = 12


def write_table(table: pd.DataFrame, folder: Path, parquet: bool, name: str = "area") -> None:
    """Write `name`.csv (12 digits, empty cells for missing values), and `name`.parquet beside it when asked.

    Columns in seconds have microseconds however late their clock is. Nothing but the header stands above the rows:
    what a table refers to is told in run.json.
    """
    shown = with_microseconds(table, DIGITS)
    shown.to_csv(folder / f"{name}.csv", index=False, float_format=f"%.{DIGITS}g", lineterminator="\n")
    if parquet:
        table.to_parquet(folder / f"{name}.parquet", index=False)
