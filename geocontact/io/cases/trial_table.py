"""One recorded trial as a CSV file: `time [s]` first, then a column per measured channel, to SI units."""

from __future__ import annotations

from dataclasses import dataclass
from os import fspath
from pathlib import Path

import numpy as np
from jaxtyping import Float, Int

from geocontact.data.errors import InputError
from geocontact.data.motion import Signals
from geocontact.io.text.column_names import ColumnNames
from geocontact.io.text.csv_text import Column, open_csv, split_commas
from geocontact.io.text.table_rows import read_rows

LARGEST_TRIAL = 64_000_000
"""Bytes; ten channels at 1 kHz for a quarter of an hour."""

FEWEST_ROWS = 2


@dataclass(frozen=True)
class TrialTable:
    """A trial in SI units, and what its file says of each channel."""

    file: str
    signals: Signals
    columns: tuple[Column, ...]

    def column(self, name: str) -> Column:
        """What the header says of a channel."""
        return self.columns[self.signals.channels.index(name)]


def read_trial(path: Path) -> TrialTable:
    """Trial in a CSV file.

    Empty cells are NaN. Refused: a first column that is not time, channels without a unit or of an unknown one, time
    that does not increase, cells that are not numbers or are infinite, ragged rows, and a trial that is NaN throughout.
    The size of a number is no reason: a trial wrong by a thousand is something to be diagnosed.
    """
    file = fspath(path)
    with open_csv(path, LARGEST_TRIAL) as (stream, columns, first):
        _check_header(columns, file)
        names = tuple(column.name for column in columns)
        values, lines = read_rows(stream, first, names, file, split_commas)
    with np.errstate(over="ignore"):
        values = values * np.array([column.factor for column in columns])
    _check_finite(values, lines, names, file)
    _check_time(values[:, 0], lines, file)
    channels = columns[1:]
    signals = Signals(values[:, 0], values[:, 1:], ColumnNames(names[1:]), tuple(column.si for column in channels))
    return TrialTable(file, signals, channels)


def _check_header(columns: tuple[Column, ...], file: str) -> None:
    first = columns[0]
    if first.name.lower() != "time":
        raise InputError(file, "line 1", f"the first column is '{first.name}'", "put `time [s]` first")
    for column in columns:
        if not column.unit:
            remedy = f"write for example `{column.name} [{'s' if column is first else 'N'}]`, [-] for a pure number"
            raise InputError(file, "line 1", f"column '{column.name}' has no unit", remedy)
    if first.si != "s":
        raise InputError(file, "line 1", f"time is in '{first.unit}'", "write `time [s]` or [ms]")
    if len(columns) == 1:
        raise InputError(file, "line 1", "time is the only column", "a trial needs measured channels")


def _check_finite(
    values: Float[np.ndarray, "t c"], lines: Int[np.ndarray, " t"], names: tuple[str, ...], file: str
) -> None:
    """Refuse infinite cells, time that is missing, too few rows and a trial without a number."""
    infinite = np.argwhere(np.isinf(values))
    if len(infinite):
        row, column = infinite[0]
        what = f"'{names[column]}' is infinite or too large"
        raise InputError(file, f"line {lines[row]}", what, "leave cells empty where nothing was measured")
    missing = np.flatnonzero(np.isnan(values[:, 0]))
    if len(missing):
        raise InputError(file, f"line {lines[missing[0]]}", "time is missing", "every row needs its time")
    if len(values) < FEWEST_ROWS:
        raise InputError(file, "", f"{len(values)} row", f"a trial needs at least {FEWEST_ROWS}")
    if np.all(np.isnan(values[:, 1:])):
        raise InputError(file, "", "every channel is empty in every row", "strike the trial from case.toml")


def _check_time(time: Float[np.ndarray, " t"], lines: Int[np.ndarray, " t"], file: str) -> None:
    late = np.flatnonzero(np.diff(time) <= 0.0)
    if len(late):
        i = late[0]
        what = f"time {time[i + 1]:.9g} s does not follow {time[i]:.9g} s"
        raise InputError(file, f"line {lines[i + 1]}", what, "time must increase from row to row")
