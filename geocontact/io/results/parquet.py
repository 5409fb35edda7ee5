"""A table as Parquet, with all its digits."""

from __future__ import annotations

from pathlib import Path

import pandas as pd


def write_parquet(table: pd.DataFrame, file: Path) -> None:
    """Write it; columns keep their names, units included."""
    table.to_parquet(file, index=False)
