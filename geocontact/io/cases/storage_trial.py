"""A trial out of OpenSim's tables: `ik.mot` (coordinates) and `id.sto` (generalised forces), to SI units.

Their columns carry no unit. `[columns]` of gather.toml says which channel each is, in which unit: "angle [deg]". That
is held against what the file tells: whether angles are in degrees by its header, that a column is a moment or a force
by the ending of its name; everything else is in SI units there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.motion import Signals
from geocontact.io.cases.trial_table import TrialTable
from geocontact.io.text.columns import LARGEST_RADIANS, resolve
from geocontact.io.text.csv_text import Column
from geocontact.io.text.tables import TextTable, listed, read_table
from geocontact.io.text.units import si_unit, split_header

STORAGE = (".mot", ".sto")
ENDINGS = {"_moment": "N m", "_force": "N"}
"""Of a generalised force, as `geocontact id` and OpenSim name it."""
EXAMPLE = '"angle [deg]" = "knee_angle_r"'


@dataclass(frozen=True)
class StorageColumn:
    """A channel with its unit in the file, and the column that holds it."""

    channel: Column
    label: str


def is_storage(path: Path) -> bool:
    """Whether a file is one of OpenSim's tables."""
    return path.suffix.lower() in STORAGE


def columns_of(path: Path, given: Any) -> tuple[StorageColumn, ...]:
    """`[columns]` of gather.toml, the file `path`; InputError for a channel without a known unit."""
    if not isinstance(given, dict):
        raise InputError(path, "columns", "is no table", f"write [columns] and {EXAMPLE}")
    return tuple(_column(path, header, label) for header, label in given.items())


def _column(path: Path, header: str, label: Any) -> StorageColumn:
    place = f"[columns] {header[:80]!r}"
    if not isinstance(label, str) or not label.strip():
        raise InputError(path, place, f"is {label!r:.60}", f"write the name of a column in quotes, as in {EXAMPLE}")
    name, unit = split_header(header)
    known = si_unit(unit)
    if not name.isidentifier() or known is None:
        what = "is no channel with a unit that is known"
        raise InputError(path, place, what, f"write for example {EXAMPLE}")
    si, factor = known
    expected = next((each for ending, each in ENDINGS.items() if label.endswith(ending)), None)
    if expected is not None and unit != expected:
        raise InputError(path, place, f"column {label!r} is in {expected} by its name", f"write [{expected}]")
    if si != "rad" and factor != 1.0:
        raise InputError(path, place, f"is in {unit!r}; OpenSim's tables are in {si}", f"write [{si}]")
    return StorageColumn(Column(name, unit, si, factor), label)


def read_storage_trial(path: Path, columns: Sequence[StorageColumn]) -> TrialTable:
    """Channels of a trial from the columns that a .mot or .sto file has, SI units.

    Columns that are not there are left out; InputError where none is, or where the header contradicts a unit.
    """
    table = read_table(path)
    there = [(one, label) for one in columns if (label := resolve(table, one.label)) is not None]
    if not there:
        what = f"holds none of {listed(tuple(one.label for one in columns))}"
        raise InputError(table.file, "", what, f"columns are: {listed(table.channels)}")
    values = np.column_stack([_values(table, one.channel, label) for one, label in there])
    channels = tuple(one.channel for one, _ in there)
    names, units = tuple(each.name for each in channels), tuple(each.si for each in channels)
    return TrialTable(table.file, Signals(table.time, values, names, units), channels)


def _values(table: TextTable, channel: Column, label: str) -> Float[np.ndarray, " t"]:
    said = table.angles.unit
    if channel.si == "rad" and said not in (None, channel.unit):
        what = f"angles are in {said} by the header, [columns] has {channel.name} in {channel.unit}"
        raise InputError(table.file, f"line {table.angles.line}", what, f'write "{channel.name} [{said}]"')
    values = table.needed(label)
    if channel.unit == "rad" and (largest := float(np.abs(values).max(initial=0.0))) > LARGEST_RADIANS:
        what = f"column {label!r} reaches {largest:.4g}, too much for the radians that [columns] has {channel.name} in"
        raise InputError(table.file, "", what, f'write "{channel.name} [deg]" if they are degrees')
    return values * channel.factor
