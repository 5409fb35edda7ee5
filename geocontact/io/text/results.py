"""Tables of results to files."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pandas as pd
from pandas.api.types import is_float_dtype

from geocontact.data.seconds import is_late, seconds
from geocontact.io.text.written_units import RESULTS, misfits

DIGITS = 12


def with_microseconds(table: pd.DataFrame, digits: int) -> pd.DataFrame:
    """The table with its columns in seconds as text, as far as so many digits would lose microseconds."""
    texts = {
        name: ["" if pd.isna(each) else seconds(each, digits) for each in table[name]]
        for name in table.columns
        if str(name).endswith("[s]") and is_float_dtype(table[name]) and is_late(table[name].abs().max(), digits)
    }
    return table.assign(**texts)


def write_table(table: pd.DataFrame, folder: Path, name: str = "area", units: Mapping[str, str] = RESULTS) -> None:
    """Write `name`.csv: 12 digits, empty cells for missing values.

    Columns in seconds have microseconds however late their clock is. Nothing but the header stands above the rows:
    what a table refers to is told in run.json. ValueError where a column is in another unit than `units` has for its
    kind: every table of every command goes through here.
    """
    if odd := misfits(table.columns, units):
        raise ValueError(f"{name}: {', '.join(odd)}: not the unit that tables have for this kind of quantity")
    shown = with_microseconds(table, DIGITS)
    shown.to_csv(folder / f"{name}.csv", index=False, float_format=f"%.{DIGITS}g", lineterminator="\n")
