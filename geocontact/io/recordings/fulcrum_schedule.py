"""Schedule of a semi-active foot: a table of what starts where, by stride, time, walking speed or phase of gait.

    stride [-],setting
    1,low
    3,medium

The first column is `stride [-]` (counted from 1), `time [s]`, `speed [m/s]` or `phase [%]` (of the stride, from
touch-down); the second `setting`, or `fulcrum [mm]`. Each row holds from there on to the next.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Literal

import numpy as np

from geocontact.data.errors import InputError
from geocontact.io.text.side_table import read_side_table

By = Literal["stride", "time", "speed", "phase"]
COLUMNS: dict[str, By] = {"stride [-]": "stride", "time [s]": "time", "speed [m/s]": "speed", "phase [-]": "phase"}
"""In SI: a phase in % is read as a share."""
SETTING, FULCRUM = "setting", "fulcrum [m]"


@dataclass(frozen=True)
class ScheduleRow:
    """From `start` on, in the unit of the schedule, a setting by its name or a place of the fulcrum [m]."""

    start: float
    setting: str | None
    fulcrum: float | None


@dataclass(frozen=True)
class ScheduleTable:
    """Rows in rising order of what they are by: stride [-], time [s], walking speed [m/s], phase of the stride [-]."""

    by: By
    rows: tuple[ScheduleRow, ...]


def read_fulcrum_schedule(path: Path) -> ScheduleTable:
    """The table; InputError for one that is none."""
    table = read_side_table(path, (*COLUMNS, SETTING, FULCRUM))
    by = [name for name in COLUMNS if name in table]
    what = [name for name in (SETTING, FULCRUM) if name in table]
    if len(by) != 1 or len(what) != 1:
        said = f"columns are {', '.join(map(str, table.columns))}"
        remedy = "write one of stride [-], time [s], speed [m/s], phase [%], and one of setting, fulcrum [mm]"
        raise InputError(path, "line 1", said, remedy)
    starts = table[by[0]].to_numpy(float)
    if not (np.diff(starts) > 0.0).all():
        raise InputError(path, by[0], "does not rise from row to row", "order the rows, one for each start")
    kind = COLUMNS[by[0]]
    if kind == "stride" and ((starts != np.round(starts)) | (starts < 1.0)).any():
        raise InputError(path, by[0], "has a number that is no count", "strides count from 1")
    if kind == "phase" and not ((starts >= 0.0) & (starts < 1.0)).all():
        raise InputError(path, by[0], "is not 0 to below 100 %", "a stride is 100 %, from touch-down to touch-down")
    named = [str(each) for each in table[SETTING]] if SETTING in table else [None] * len(starts)
    placed = table[FULCRUM].tolist() if FULCRUM in table else [None] * len(starts)
    rows = zip(starts.tolist(), named, placed, strict=True)
    return ScheduleTable(kind, tuple(ScheduleRow(*row) for row in rows))
