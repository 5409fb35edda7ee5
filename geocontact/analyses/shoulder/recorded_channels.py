"""Elevation of an exoskeleton's arm and force in its cuff, as logger and pressure mat recorded them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.options import AngleUnit, ForceUnit
from geocontact.data.errors import InputError
from geocontact.io.recordings.load_cells import column_in_newtons
from geocontact.io.text.columns import angles_of, parse_map, resolve
from geocontact.io.text.tables import TextTable, listed, read_table

ELEVATION, FORCE = "elevation", "force"


@dataclass(frozen=True, eq=False)
class Channels:
    """Channels over a clock of their own [rad, N]."""

    time: Float[np.ndarray, " t"]
    values: Mapping[str, Float[np.ndarray, " t"]]


def recorded_channels(
    path: Path,
    named: str | None = None,
    angles: AngleUnit | None = None,
    unit: ForceUnit | None = None,
    delay: float = 0.0,
) -> Channels:
    """Columns elevation and force of a table, or those that `named` maps to them; InputError where there is neither.

    Parameters
    ----------
    angles, unit
        Of columns whose header has no unit.
    delay
        How much the recording's clock is late [s].
    """
    table = read_table(path)
    if table.time_unit != "s":
        raise InputError(path, "", "time is in per cent of a cycle", "give a recording in seconds")
    mapping = {} if named is None else parse_map(named, (ELEVATION, FORCE))
    values = {}
    for channel in (ELEVATION, FORCE):
        column = _column(table, channel, mapping)
        if column is not None:
            sign, name = column
            found = angles_of(table, [name], angles)[:, 0] if channel == ELEVATION else _force(table, name, unit)
            values[channel] = sign * found
    if not values:
        what = f"no column elevation or force; columns are: {listed(table.channels)}"
        raise InputError(path, "", what, "name them: `map` elevation=NAME,force=NAME")
    return Channels(table.time - delay, values)


def _column(table: TextTable, channel: str, mapping: Mapping[str, tuple[float, str]]) -> tuple[float, str] | None:
    sign, name = mapping.get(channel, (1.0, channel))
    found = resolve(table, name)
    if found is None and channel in mapping:
        what = f"no column '{name}' for {channel}; columns are: {listed(table.channels)}"
        raise InputError(table.file, "`map`", what, f"name it: `map` {channel}=NAME")
    return None if found is None else (sign, found)


def _force(table: TextTable, name: str, unit: ForceUnit | None) -> Float[np.ndarray, " t"]:
    return column_in_newtons(table, name, unit)[0]
