"""Tables of a page: files that went in, and data frames."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.view.page.content import Table


def inputs_table(inputs: Sequence[Mapping[str, object]]) -> Table:
    """Files that went in, as `run.json` lists them."""
    rows = [
        (str(i["role"]).replace("`", ""), Path(str(i["file"])).name, str(i.get("unit", "")), str(i["sha256"]))
        for i in inputs
    ]
    return Table("Input files", ("role", "file", "unit", "SHA-256"), rows, folded=True)


PLAIN = 1e6  # below which a number is written without an exponent


def written(value: float, digits: int = 4) -> str:
    """So many significant digits: "4500", "0.0213", "7.73e+06"."""
    text = f"{value:.{digits}g}"
    return f"{float(text):.0f}" if "e+" in text and abs(value) < PLAIN else text


ROWS = 200
"""Rows of a table that a page shows; its file has all."""


def frame_table(title: str, rows: pd.DataFrame, digits: int = 4, most: int = ROWS) -> Table:
    """A data frame as the page shows it: what is not known is empty; of a long one `most` rows, as the title says."""
    if len(rows) > most:
        title, rows = f"{title}, {most} of {len(rows)} rows", rows.iloc[:most]

    def text(value: object) -> str:
        if isinstance(value, bool | np.bool_):
            return "yes" if value else "no"
        if not isinstance(value, float):
            return str(value)
        return "" if np.isnan(value) else written(value, digits)

    return Table(title, tuple(map(str, rows.columns)), rows.map(text).to_numpy().tolist())
