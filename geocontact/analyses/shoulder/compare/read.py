"""What a comparison starts from: a simulated arm, and its elevation and force as they were recorded."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.compare.options import CompareOptions
from geocontact.data.errors import InputError
from geocontact.io.recordings.load_cells import column_in_newtons
from geocontact.io.text.columns import angles_of, parse_map, resolve
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.tables import TextTable, listed, read_table
from geocontact.shoulder_exoskeleton.work_phases import PHASES

ELEVATION, FORCE = "elevation", "force"
SIMULATED = {ELEVATION: "elevation [rad]", FORCE: "supporting [N]"}
"""Columns of the simulated arm that the recorded channels are compared with."""


@dataclass(frozen=True, eq=False)
class Channels:
    """Channels over a clock of their own [rad, N]."""

    time: Float[np.ndarray, " t"]
    values: Mapping[str, Float[np.ndarray, " t"]]


@dataclass(frozen=True, eq=False)
class Both:
    """A simulated arm with its phases in words, and the recording."""

    simulated: Channels
    phase: tuple[str, ...]
    recorded: Channels


def read(o: CompareOptions, record: Record) -> Both:
    """Both files."""
    simulated, phase = _simulated(o.simulated)
    record.add_input("simulated", o.simulated, frames=len(phase))
    table = read_table(o.recorded)
    if table.time_unit != "s":
        raise InputError(o.recorded, "", "time is in per cent of a cycle", "give a recording in seconds")
    record.add_input("recorded", o.recorded, samples=len(table.time))
    mapping = {} if o.map is None else parse_map(o.map, (ELEVATION, FORCE))
    values = {}
    for channel in (ELEVATION, FORCE):
        column = _column(table, channel, mapping)
        if column is not None:
            sign, name = column
            found = angles_of(table, [name], o.angles)[:, 0] if channel == ELEVATION else _force(table, name, o)
            values[channel] = sign * found
    if not values:
        what = f"no column elevation or force; columns are: {listed(table.channels)}"
        raise InputError(o.recorded, "", what, "name them: `map` elevation=NAME,force=NAME")
    return Both(simulated, phase, Channels(table.time - o.delay, values))


def _simulated(path: Path) -> tuple[Channels, tuple[str, ...]]:
    needed = ("time [s]", "phase", *SIMULATED.values())
    table = read_side_table(path, needed)
    missing = [name for name in needed if name not in table]
    if missing:
        remedy = "give right.csv or left.csv of shoulder simulate"
        raise InputError(path, "", f"no column {missing[0]}", remedy)
    phase = tuple(map(str, table["phase"]))
    odd = [name for name in phase if name not in PHASES]
    if odd:
        raise InputError(path, "phase", f"{odd[0]!r} is no phase", f"phases are {', '.join(PHASES)}")
    values = {channel: np.asarray(table[name], float) for channel, name in SIMULATED.items()}
    return Channels(np.asarray(table["time [s]"], float), values), phase


def _column(table: TextTable, channel: str, mapping: Mapping[str, tuple[float, str]]) -> tuple[float, str] | None:
    sign, name = mapping.get(channel, (1.0, channel))
    found = resolve(table, name)
    if found is None and channel in mapping:
        what = f"no column '{name}' for {channel}; columns are: {listed(table.channels)}"
        raise InputError(table.file, "`map`", what, f"name it: `map` {channel}=NAME")
    return None if found is None else (sign, found)


def _force(table: TextTable, name: str, o: CompareOptions) -> Float[np.ndarray, " t"]:
    return column_in_newtons(table, name, o.unit)[0]
