"""Tables of results to files."""

from __future__ import annotations

from pathlib import Path

import pandas as pd


def write_table(table: pd.DataFrame, folder: Path, name: str = "area") -> None:
    """Write `name`.csv: 12 digits, empty cells for missing values."""
    table.to_csv(folder / f"{name}.csv", index=False, float_format="%.12g", lineterminator="\n")
