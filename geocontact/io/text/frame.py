"""A table of numbers and words as a data frame, its columns named as they are asked for."""

from __future__ import annotations

from collections.abc import Iterable
from io import StringIO
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.data.errors import InputError
from geocontact.data.magnitude import TOO_LARGE, too_large
from geocontact.io.text.column_names import spelled_as
from geocontact.io.text.plain_table import open_plain

MOST_CELLS = 10_000
"""In a row; pandas takes hundreds of bytes for each column."""


def read_frame(path: Path, wanted: Iterable[str], remedy: str) -> pd.DataFrame:
    """Table below a row of names; lines that begin with # are passed over.

    Parameters
    ----------
    wanted
        Names that columns get which are written with other upper and lower case.
    remedy
        What to give instead of a file that is no table.
    """
    try:
        with open_plain(path) as stream:
            text = stream.read()
        wide = next((number for number, line in enumerate(text.split("\n"), 1) if line.count(",") > MOST_CELLS), 0)
        if wide:
            raise InputError(path, f"line {wide}", f"more than {MOST_CELLS} cells", remedy)
        table = pd.read_csv(StringIO(text), comment="#")
    except InputError:
        raise
    except (OSError, ValueError, pd.errors.ParserError) as error:
        raise InputError(path, "", f"cannot be read as a table ({error})", remedy) from error
    table.columns = [str(name).strip() for name in table.columns]
    for k, name in enumerate(table.columns):
        odd = np.flatnonzero(too_large(pd.to_numeric(table.iloc[:, k], errors="coerce").to_numpy(float)))
        if len(odd):
            what = f"'{name}' is {str(table.iloc[odd[0], k])[:40]}, which {TOO_LARGE}"
            raise InputError(path, f"row {odd[0] + 1}", what, remedy)
    return named(table, wanted)


def named(table: pd.DataFrame, wanted: Iterable[str]) -> pd.DataFrame:
    """The table with the columns that are wanted named so, where only upper and lower case differ."""
    return table.rename(columns=dict(spelled_as(wanted, table.columns)))
