"""Tables of gait events: one reader for whatever cuts recordings into cycles."""

from __future__ import annotations

from collections.abc import Hashable, Mapping
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.data.gait_events import OFF, STRIKE, GaitEvent
from geocontact.data.sides import LEFT, RIGHT
from geocontact.io.mocap.c3d_events import read_c3d_events
from geocontact.io.text.side_table import read_side_table

COLUMNS = ("side", "event", "time [s]")
WORDS = {
    **dict.fromkeys(("heel strike", "foot strike", "foot contact", "initial contact", "strike"), STRIKE),
    **dict.fromkeys(("toe off", "foot off", "off"), OFF),
}
"""What an event may be called."""


def read_gait_events(path: Path) -> tuple[GaitEvent, ...]:
    """Rows of `side, event, time [s]` and, where there are several, `recording` and `style`; or those of a .c3d.

    Parameters
    ----------
    path
        `side` is right or left, `event` heel strike or toe off; `recording` is a file's name without its ending.

    Raises
    ------
    InputError
        A column is missing, a side or an event is none of these, or an event occurs twice.
    """
    if path.suffix.lower() == ".c3d":
        return tuple(GaitEvent(side, WORDS[label], time) for side, label, time in read_c3d_events(path, tuple(WORDS)))
    table = read_side_table(path, (*COLUMNS, "recording", "style"))
    if missing := [name for name in COLUMNS if name not in table]:
        what = f"no column {', '.join(missing)}; columns are: {', '.join(map(str, table.columns))}"
        raise InputError(path, "line 1", what, "write side, event, time [s], and recording where there are several")
    rows = [_row(path, k, row) for k, row in enumerate(table.to_dict(orient="records"))]
    for k, row in enumerate(rows):
        if row in rows[:k]:
            what = f"{row.event} of the {row.side} side at {row.time:g} s occurs twice"
            raise InputError(path, f"row {k + 1}", what, "name each event once")
    return tuple(rows)


def _row(path: Path, k: int, row: Mapping[Hashable, object]) -> GaitEvent:
    side, event = (str(row[name]).strip().lower() for name in COLUMNS[:2])
    side = {"r": RIGHT, "l": LEFT}.get(side, side)
    if side not in (RIGHT, LEFT):
        raise InputError(path, f"row {k + 1}", f"'{row['side']}' is not a side", "write right or left")
    if event not in WORDS:
        raise InputError(path, f"row {k + 1}", f"'{row['event']}' is no event", f"write {STRIKE} or {OFF}")
    words = (str(row.get(name, "")).strip() for name in ("recording", "style"))
    return GaitEvent(side, WORDS[event], float(str(row["time [s]"])), *words)
