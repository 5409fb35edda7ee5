"""Tables with times of a late clock, made ready to be written with few digits."""

from __future__ import annotations

import pandas as pd
from pandas.api.types import is_float_dtype

from geocontact.data.seconds import is_late, seconds


def with_microseconds(table: pd.DataFrame, digits: int) -> pd.DataFrame:
    """The table with its columns in seconds as text, as far as so many digits would lose microseconds."""
    texts = {
        name: ["" if pd.isna(each) else seconds(each, digits) for each in table[name]]
        for name in table.columns
        if str(name).endswith("[s]") and is_float_dtype(table[name]) and is_late(table[name].abs().max(), digits)
    }
    return table.assign(**texts)
