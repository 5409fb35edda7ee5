"""The trials of a case: one CSV file each, the same channels in the same order, and cells of mats beside them."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass, replace
from os import fspath
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float, Int

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.gap_cells import CellChannels, CellTrial
from geocontact.data.motion import Signals
from geocontact.io.cases.case_settings import SETTINGS, TRIALS, CaseSettings, inside
from geocontact.io.text.column_names import ColumnNames
from geocontact.io.text.csv_text import Column, open_csv, split_commas
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.tables import listed, read_rows

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
        raise InputError(file, "", "every channel is empty in every row", "delete the trial from case.toml")


def _check_time(time: Float[np.ndarray, " t"], lines: Int[np.ndarray, " t"], file: str) -> None:
    late = np.flatnonzero(np.diff(time) <= 0.0)
    if len(late):
        i = late[0]
        what = f"time {time[i + 1]:.9g} s does not follow {time[i]:.9g} s"
        raise InputError(file, f"line {lines[i + 1]}", what, "time must increase from row to row")


Trials = Mapping[str, TrialTable]
"""Tables by the trial's id, in the order of case.toml."""


def alike(trials: Trials) -> dict[str, TrialTable]:
    """The trials with their channels in the order of the first; refused when the channels themselves differ."""
    model, *_ = trials.values()
    found = {name: _ordered_like(model, table) for name, table in trials.items()}
    for channel in model.signals.channels:
        if all(np.all(np.isnan(table.signals.column(channel))) for table in found.values()):
            remedy = "delete the column from all trials, or add a trial that has it"
            raise InputError(Path(model.file).parent, "", f"column '{channel}' is empty in all trials", remedy)
    return found


def _ordered_like(model: TrialTable, table: TrialTable) -> TrialTable:
    channels, wanted = table.signals.channels, model.signals.channels
    first = Path(model.file).name
    lacking = tuple(name for name in wanted if name not in channels)
    surplus = tuple(name for name in channels if name not in wanted)
    if lacking or surplus:
        what = f"no column {listed(lacking)}" if lacking else f"column {listed(surplus)} more"
        raise InputError(table.file, "line 1", f"{what}, unlike {first}", "all trials need the same columns")
    for name in wanted:
        here, there = table.column(name), model.column(name)
        if here.si != there.si:
            what = f"'{name}' is in '{here.unit}', in {first} it is in '{there.unit}'"
            raise InputError(table.file, "line 1", what, "units of one column must be of one dimension")
    order = [channels.index(name) for name in wanted]
    values = np.ascontiguousarray(table.signals.values[:, order])  # noqa: PD011 no pandas here
    signals = replace(table.signals, values=values, channels=wanted, units=model.signals.units)
    return replace(table, signals=signals, columns=tuple(table.columns[i] for i in order))


def noise_in_si(noise: Mapping[str, float], trials: Trials, file: Path) -> dict[str, float]:
    """Noise of channels, given in the unit that the trial files have them in, in SI units.

    Parameters
    ----------
    noise
        Standard deviation by channel.
    trials
        Alike (see `alike`).
    file
        Where the noise was written, for messages.
    """
    return {channel: sd * _factor(channel, trials, file) for channel, sd in noise.items()}


def _factor(channel: str, trials: Trials, file: Path) -> float:
    model, *_ = trials.values()
    if channel not in model.signals.channels:
        remedy = f"channels are: {listed(model.signals.channels)}"
        raise InputError(file, "[noise]", f"no trial has a channel {channel[:80]!r}", remedy)
    units = {table.column(channel).factor: (table.column(channel).unit, table.file) for table in trials.values()}
    if len(units) > 1:
        (one, here), (other, there), *_ = units.values()
        what = f"{channel} is in {one} in {Path(here).name} and in {other} in {Path(there).name}"
        raise InputError(
            file, "[noise]", f"{what}, so the unit of its noise is not clear", "use one unit in all trials"
        )
    return next(iter(units))


PLACE, AREA = ("x [m]", "y [m]", "z [m]"), "area [m^2]"
EXAMPLE = "id, x [m], y [m], z [m], area [m^2]"


def read_cells(home: Path, settings: CaseSettings, channels: tuple[str, ...]) -> dict[str, CellChannels]:
    """Cells of every site that case.toml has a layout of.

    The channel of a site is `<site>_force`, else `<site>`, else `force`, whichever the trials have. A trial without a
    file of cells is left out, a site without any trial too, both with a warning.
    """
    found = {}
    for site, file in settings.layout.items():
        layout = _layout(inside(home, file, f"layout.{site}"))
        channel = _channel(home, site, channels)
        ids = tuple(str(name) for name in layout["id"])
        trials = {name: _trial(path, ids) for name, path in _files(home, site, settings).items()}
        if trials:
            place, area = layout[list(PLACE)].to_numpy(float), layout[AREA].to_numpy(float)
            found[site] = CellChannels(channel, ids, place, area, trials)
    return found


def cells_file(home: Path, trial: str, site: str) -> Path:
    """Where a site's cells of a trial are."""
    return home / TRIALS / f"{trial}_{site}_cells.csv"


def channel_name(cell: str) -> str:
    """Column of a cell with that id: c7 for 7; c7 stays."""
    return f"c{cell}" if cell.isdecimal() else cell


def _layout(path: Path) -> pd.DataFrame:
    wanted = ("id", *PLACE, AREA)
    table = read_side_table(path, wanted)
    missing = [name for name in wanted if name not in table.columns]
    if missing:
        raise InputError(path, "line 1", f"no column {listed(tuple(missing))}", f"write {EXAMPLE}")
    names = [str(name) for name in table["id"]]
    if twice := [name for name in names if names.count(name) > 1]:
        raise InputError(path, "", f"cell {twice[0]} is listed {names.count(twice[0])} times", "list each once")
    if not (table[AREA] > 0.0).all():
        least = names[int(np.argmin(table[AREA]))]
        raise InputError(
            path, "", f"the area of cell {least} is not positive", "write the area that its pressure acts on"
        )
    return table


def _channel(home: Path, site: str, channels: tuple[str, ...]) -> str:
    wanted = (f"{site}_force", site, "force")
    for name in wanted:
        if name in channels:
            return name
    what = f"no trial has a channel {wanted[0]} that the cells of {site} add up to"
    raise InputError(home / SETTINGS, f"layout.{site}", what, f"channels are {listed(channels)}")


def _files(home: Path, site: str, settings: CaseSettings) -> Mapping[str, Path]:
    paths = {name: cells_file(home, name, site) for name in settings.trials}
    there = {name: path for name, path in paths.items() if path.is_file()}
    lacking = tuple(paths[name].name for name in paths if name not in there)
    if lacking:
        message = f"{home / TRIALS}: no {listed(lacking)}: cells of {site} are not used there"
        warnings.warn(InputWarning(message), stacklevel=4)
    return there


def _trial(path: Path, ids: tuple[str, ...]) -> CellTrial:
    table = read_trial(path)
    wanted = tuple(channel_name(name) for name in ids)
    _require_same(table, wanted)
    recorded = table.signals
    order = [recorded.channels.index(name) for name in wanted]
    return CellTrial(recorded.time, np.ascontiguousarray(recorded.values[:, order]))  # noqa: PD011 no pandas here


def _require_same(table: TrialTable, wanted: tuple[str, ...]) -> None:
    given = table.signals.channels
    known, there = set(wanted), set(given)
    lacking = tuple(name for name in wanted if name not in there)
    surplus = tuple(name for name in given if name not in known)
    if lacking or surplus:
        what = f"no column {listed(lacking)}" if lacking else f"the layout has no cell {listed(surplus)}"
        raise InputError(table.file, "line 1", what, "columns are the cells of the layout, c0 for id 0")
    for column in table.columns:
        if column.si != "Pa":
            raise InputError(table.file, "line 1", f"'{column.name}' is in {column.unit}", "cells are pressures, in Pa")
