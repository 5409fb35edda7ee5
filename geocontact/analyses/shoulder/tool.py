"""When the tool runs: a channel of 0 and 1, or a current with a threshold."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from jaxtyping import Bool, Float

from geocontact.analyses.run_record import Record
from geocontact.data.errors import InputError
from geocontact.io.text.tables import TextTable, listed, read_table
from geocontact.io.text.units import split_header

EVENT, CURRENT = "event", "current"
RUNNING = 4.0
"""Current that an event of 1 stands for [A]; a screwdriver takes as much."""


def tool_runs(record: Record, file: Path, threshold: float, time: Float[np.ndarray, " t"]) -> Bool[np.ndarray, " t"]:
    """Whether the tool runs at these times [s]; InputError for events that are neither 0 nor 1.

    Parameters
    ----------
    threshold
        Current from which the tool counts as running [A], for a file with a column `current [A]`.
    """
    table, current, binary = _current(file)
    on = current > (0.5 if binary else threshold)
    record.add_input("`tool`", file, samples=len(table.time))
    if not on.any():
        raise InputError(file, "`tool`", "the tool never runs", "give a smaller `tool_current`, or leave it out")
    last = np.clip(np.searchsorted(table.time, time + 1e-9, "right") - 1, 0, len(on) - 1)
    return np.asarray(on[last])


def tool_current(record: Record, file: Path, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """Current of the tool at these times [A], as far as the file goes; that of events is 0 or `RUNNING`."""
    table, current, _ = _current(file)
    record.add_input("`tool`", file, samples=len(table.time))
    return np.asarray(np.interp(time, table.time, current))


def current_at(file: Path, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
    """The same of a file that is an input already."""
    table, current, _ = _current(file)
    return np.asarray(np.interp(time, table.time, current))


def _current(file: Path) -> tuple[TextTable, Float[np.ndarray, " s"], bool]:
    """The table, its current [A], and whether that stands for events of 0 and 1."""
    table = read_table(file)
    named = {split_header(name)[0]: name for name in table.channels}
    if EVENT in named:
        values = table.column(named[EVENT])
        odd = np.flatnonzero(~np.isin(values, (0.0, 1.0)))
        if len(odd):
            what = f"event is {values[odd[0]]:g} at {table.time[odd[0]]:g} s, neither 0 nor 1"
            raise InputError(file, "", what, "give 1 while the tool runs and 0 else")
        return table, RUNNING * values, True
    if CURRENT in named:
        return table, table.column(named[CURRENT]), False
    what = f"no column event or current; columns are: {listed(table.channels)}"
    raise InputError(file, "", what, "name it event [-] or current [A]")
