"""Units that written tables are in: one for each kind of quantity, as `docs/reference/written_files.md` lists them."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from types import MappingProxyType

from geocontact.io.text.units import si_unit, split_header

RESULTS: Mapping[str, str] = MappingProxyType(
    {
        "s": "s",
        "rad": "deg",
        "m": "mm",
        "m^2": "mm^2",
        "N": "N",
        "N m": "N m",
        "N/m": "N/m",
        "N s/m": "N s/m",
        "Pa": "Pa",
        "-": "-",
    }
)
"""Unit of tables for people, by the SI unit of the same dimension."""

CASES: Mapping[str, str] = MappingProxyType({si: si for si in RESULTS})
"""Unit of tables that gap cases are made of, and of what is written about a case: SI."""

BESIDE = (r"cycle \[%\]", r"(peak_)?later(_lower|_upper)? \[%\]", r"pressure \[mmHg\]")
"""A place in a cycle, how much later in it something is, and a cuff's pressure as its gauge shows it."""

KEPT = (r"(plate_|difference_)?cop_[xyz] \[m\]", r"max_depth \[m\]", r"peak\S* \[MPa\]")
"""Columns of cop.csv, its comparison.csv and pressure.csv that had another unit before there was one for each kind."""


def misfits(columns: Iterable[object], convention: Mapping[str, str]) -> list[str]:
    """Columns that are in another unit than the convention has for their kind; units of no kind known here are left."""
    return [str(column) for column in columns if not _fits(str(column), convention)]


def _fits(column: str, convention: Mapping[str, str]) -> bool:
    _, unit = split_header(column)
    known = si_unit(unit) if unit else None
    if known is None or convention.get(known[0], unit) == unit:
        return True
    return any(re.fullmatch(each, column) for each in (*BESIDE, *KEPT))
