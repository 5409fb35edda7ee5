"""What the page and the statistics of a study are about."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError

KEYS = ("table", "columns", "over", "where", "subject", "condition")


@dataclass(frozen=True)
class SummarySettings:
    """Which curves are compared, and between whom.

    Parameters
    ----------
    table
        Name of the table; the first one over time unless given.
    columns
        Of numbers, with their units; the first few unless given.
    over
        Column that a curve is over; its span is 0 to 100 % of the curve.
    where
        Values of columns that choose the rows of a curve, such as one threshold of several; the first unless given.
    subject
        Name under which a trial has its subject: trials of one are averaged before subjects are compared.
    condition
        Name under which a trial has what is compared.
    """

    table: str = ""
    columns: tuple[str, ...] = ()
    over: str = "time [s]"
    where: Mapping[str, float | str] = field(default_factory=dict)
    subject: str = "subject"
    condition: str = "condition"


def summary_of(path: Path, told: Mapping[str, Any]) -> SummarySettings:
    """From [summary] of a study's description."""
    odd = [key for key in told if key not in KEYS]
    if odd:
        raise InputError(path, f"[summary] {odd[0]}", "is not known here", f"write {', '.join(KEYS)}")
    texts = {key: told[key] for key in ("table", "over", "subject", "condition") if key in told}
    for key, value in texts.items():
        if not isinstance(value, str):
            raise InputError(path, f"[summary] {key}", f"{value!r} is no text", "write it in quotes")
    columns, where = told.get("columns", []), told.get("where", {})
    if not isinstance(columns, list) or not all(isinstance(each, str) for each in columns):
        raise InputError(path, "[summary] columns", "is no list of names", 'write columns = ["area_fixed [mm^2]"]')
    if not isinstance(where, dict) or not all(isinstance(each, (str, int, float)) for each in where.values()):
        raise InputError(path, "[summary] where", "is no table", 'write where = { "threshold [mm]" = 4 }')
    return SummarySettings(columns=tuple(columns), where=where, **texts)
