"""Results to files: tables as CSV and Parquet, distance maps as a compressed array file."""

from __future__ import annotations

from pathlib import Path

import pandas as pd


def write_table(table: pd.DataFrame, folder: Path, parquet: bool, name: str = "area") -> None:
    """Write `name`.csv (12 digits, empty cells for missing values), and `name`.parquet beside it when asked."""
    table.to_csv(folder / f"{name}.csv", index=False, float_format="%.12g", lineterminator="\n")
    if parquet:
        table.to_parquet(folder / f"{name}.parquet", index=False)
