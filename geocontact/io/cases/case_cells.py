"""Cells of a case: the layout of each site, and trials/<id>_<site>_cells.csv."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.gap.cell_channels import CellChannels, CellTrial
from geocontact.io.cases.case_folder import SETTINGS, TRIALS, inside
from geocontact.io.cases.case_settings import CaseSettings
from geocontact.io.cases.trial_table import TrialTable, read_trial
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.tables import listed

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
        message = f"{home / TRIALS}: no {listed(lacking)}: cells of {site} are not looked at there"
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
