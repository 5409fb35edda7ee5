"""A table as LaTeX (package booktabs), with every sign that LaTeX reads otherwise written so that it prints."""

from __future__ import annotations

import numpy as np
import pandas as pd

_SIGNS = {
    "\\": r"\textbackslash{}",
    "&": r"\&",
    "%": r"\%",
    "$": r"\$",
    "#": r"\#",
    "_": r"\_",
    "{": r"\{",
    "}": r"\}",
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "²": r"\textsuperscript{2}",
}
DIGITS = 4


def latex(table: pd.DataFrame) -> str:
    """The table with four significant digits; what is missing is empty."""
    numbers = [pd.api.types.is_numeric_dtype(kind) for kind in table.dtypes]
    head = " & ".join(_escaped(str(name)) for name in table.columns)
    rows = [" & ".join(_cell(value) for value in row) for row in table.itertuples(index=False)]
    body = "".join(f"{row} \\\\\n" for row in rows)
    columns = "".join("r" if number else "l" for number in numbers)
    return f"\\begin{{tabular}}{{{columns}}}\n\\toprule\n{head} \\\\\n\\midrule\n{body}\\bottomrule\n\\end{{tabular}}\n"


def _cell(value: object) -> str:
    if isinstance(value, (float, np.floating)):
        return "" if np.isnan(value) else f"{value:.{DIGITS}g}"
    return _escaped(str(value))


def _escaped(text: str) -> str:
    return "".join(_SIGNS.get(sign, sign) for sign in text)
