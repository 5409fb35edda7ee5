"""Trials of a gap case from columns that somebody chose of recorded tables, each with a channel's name and a unit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geocontact.data.errors import InputError
from geocontact.io.text.tables import TextTable, listed, read_table


@dataclass(frozen=True)
class ChosenColumn:
    """A column of a recording, the channel that it is, and the unit that it is in."""

    column: str
    channel: str
    unit: str


def recorded_columns(path: Path) -> list[tuple[str, str]]:
    """Names of the columns beside time, each with the unit that the file states, "" where it states none."""
    table = _over_seconds(path)
    return list(zip(table.channels, table.units, strict=True))


def write_chosen(path: Path, chosen: Sequence[ChosenColumn], out: Path) -> None:
    """Write these columns as a trial: time in s, numbers as the file has them, names and units in the header.

    Raises
    ------
    InputError
        The table cannot be read, has no column of that name, or states another unit than the one that was chosen.
    """
    table = _over_seconds(path)
    stated = dict(zip(table.channels, table.units, strict=True))
    names = [each.channel for each in chosen]
    if twice := [name for name in names if names.count(name) > 1]:
        raise InputError(path, "", f"two columns are the channel {twice[0]}", "choose one of them")
    for each in chosen:
        if each.column not in stated:
            raise InputError(path, "", f"no column {each.column!r}", f"it has {listed(table.channels)}")
        if stated[each.column] not in ("", each.unit):
            what = f"column {each.column} is in {stated[each.column]}, not in {each.unit}"
            raise InputError(path, "", what, "choose the unit that the file states")
        if not each.unit:
            raise InputError(path, "", f"column {each.column} has no unit", "choose one")
    rows = np.column_stack([table.time, *(table.column(each.column) for each in chosen)]).tolist()
    head = ",".join(["time [s]", *(f"{each.channel} [{each.unit}]" for each in chosen)])
    lines = [",".join("" if np.isnan(value) else repr(value) for value in row) for row in rows]
    out.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8", newline="\n")


def _over_seconds(path: Path) -> TextTable:
    table = read_table(path, leave_words=True)
    if table.time_unit != "s":
        raise InputError(path, "", "time is in per cent of a cycle", "write its time in s")
    return table
