"""The table that says which stretches of which recording are cycles of which gait style."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.io.text.side_table import read_side_table

_COLUMNS = ("style", "start [s]", "end [s]")


@dataclass(frozen=True)
class CycleRow:
    """One cycle: gait style, recording (empty where there is only one), start and end [s]."""

    style: str
    recording: str
    start: float
    end: float


def read_cycle_table(path: Path) -> tuple[CycleRow, ...]:
    """Rows of `style, recording, start [s], end [s]`; `recording` is the name of a file without its ending."""
    table = read_side_table(path, (*_COLUMNS, "recording"))
    if missing := [name for name in _COLUMNS if name not in table]:
        found = ", ".join(map(str, table.columns))
        what = f"no column {', '.join(missing)}; columns are: {found}"
        raise InputError(path, "line 1", what, "write style, recording, start [s], end [s]")
    recordings = table["recording"] if "recording" in table else [""] * len(table)
    rows = tuple(
        CycleRow(*row) for row in zip(table["style"], recordings, table["start [s]"], table["end [s]"], strict=True)
    )
    for k, row in enumerate(rows):
        if not row.start < row.end:
            raise InputError(path, f"row {k + 1}", f"a cycle from {row.start:g} to {row.end:g} s", "end it after it")
    return rows
