"""Main numbers of a result out of its tables: by name and in SI, for attributes of the result."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

from geocontact.io.text.units import si_unit

if TYPE_CHECKING:
    import pandas as pd


def by_name(table: pd.DataFrame, keys: Sequence[str], value: str) -> dict[Any, float]:
    """Numbers of a column in SI, whose unit stands in the column "unit" of each row.

    Parameters
    ----------
    table
        Rows, each with a unit; one that is not known is taken for SI, "-" for none.
    keys
        Columns that name a row: one name for one column, a tuple of names for several.
    value
        Column of the numbers.
    """
    names = zip(*(table[key] for key in keys), strict=True)
    return dict(in_si(names, table[value], table["unit"]))


def in_si(names: Iterable[tuple[Any, ...]], values: Iterable[float], units: Iterable[str]) -> list[tuple[Any, float]]:
    """Names and numbers in SI; a tuple of one name is that name."""
    return [
        (name if len(name) > 1 else name[0], float(value) * factor_of(unit))
        for name, value, unit in zip(names, values, units, strict=True)
    ]


def factor_of(unit: str) -> float:
    """How many of the SI unit one `unit` is; 1 for a unit that is not known."""
    known = si_unit(unit)
    return 1.0 if known is None else known[1]
