"""Trials of a gap case from columns that somebody chose of recorded tables, each with a channel's name and a unit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.quantities import is_known
from geocontact.data.errors import InputError
from geocontact.io.text.tables import TextTable, listed, read_table
from geocontact.io.text.units import si_unit

TURNS = ("rad", "rad/s", "rad/s^2")
"""What OpenSim means by the angles of a .mot or .sto: its Kinematics writes speeds and accelerations in deg as well."""


@dataclass(frozen=True)
class ChosenColumn:
    """A column of recordings, the channel that it is, and the unit that it is in.

    Parameters
    ----------
    stated
        What the file says, which the unit was chosen from: the unit itself, "" or a word that is no known unit. Another
        file that says neither this nor a known unit is refused.
    """

    column: str
    channel: str
    unit: str
    stated: str = ""


def recorded_columns(path: Path) -> list[tuple[str, str]]:
    """Names of the columns beside time, each with the unit that the file states, "" where it states none."""
    table = _over_seconds(path)
    return list(zip(table.channels, table.units, strict=True))


def si_of(unit: str) -> str:
    """SI unit of the same dimension, "" where the unit is not known."""
    known = si_unit(unit)
    return known[0] if known else ""


def same_unit(one: str, other: str) -> bool:
    """Whether two files state the same unit, however it is spelled; words that are no unit by their letters."""
    return (si_unit(one) or one) == (si_unit(other) or other)


def write_chosen(path: Path, chosen: Sequence[ChosenColumn], out: Path) -> None:
    """Write these columns as a trial: time in s, numbers as the file has them, names and units in the header.

    Raises
    ------
    InputError
        The table cannot be read, has no column of that name, states another unit than the one that was chosen, none
        where the first file states one, or angles in rad where deg were chosen.
    """
    table = _over_seconds(path)
    names = [each.channel for each in chosen]
    if twice := [name for name in names if names.count(name) > 1]:
        raise InputError(path, "", f"two columns are the channel {twice[0]}", "choose one of them")
    units = [_unit_in(table, each) for each in chosen]
    rows = np.column_stack([table.time, *(table.column(each.column) for each in chosen)]).tolist()
    head = ",".join(["time [s]", *(f"{name} [{unit}]" for name, unit in zip(names, units, strict=True))])
    lines = [",".join("" if np.isnan(value) else repr(value) for value in row) for row in rows]
    out.write_text("\n".join([head, *lines]) + "\n", encoding="utf-8", newline="\n")


def _unit_in(table: TextTable, each: ChosenColumn) -> str:
    """Unit of a column in this file: its own where it states a known one, else the chosen one."""
    if each.column not in table.channels:
        raise InputError(table.file, "", f"no column {each.column!r}", f"it has {listed(table.channels)}")
    here, column = table.units[table.channels.index(each.column)], f"column {each.column}"
    if known := si_unit(here):
        chosen = si_unit(each.unit)
        if known == chosen or (is_known(each.stated) and chosen and known[0] == chosen[0]):
            return here
        raise InputError(
            table.file, "", f"{column} is in {here}, not in {each.unit}", "choose the unit that the file states"
        )
    if here != each.stated:
        what = f"{column} {f'is in {here!r}' if here else 'has no unit'}"
        before = f"in the first file it {f'is in {each.stated!r}' if each.stated else 'has none'}"
        raise InputError(table.file, "", f"{what}; {before}", "write the unit into the headers of all files")
    if not each.unit:
        raise InputError(table.file, "", f"{column} has no unit", "choose one")
    _check_angle(table, each)
    return each.unit


def _check_angle(table: TextTable, each: ChosenColumn) -> None:
    """Refuse degrees for a column where the header of the .mot or .sto says radians, and the other way round."""
    said, chosen = table.angles, si_unit(each.unit)
    if said.unit is None or chosen is None or chosen[0] not in TURNS:
        return
    wanted, other = (chosen[0].replace("rad", unit) for unit in (said.unit, "deg" if said.unit == "rad" else "rad"))
    if chosen == si_unit(other):
        what = f"{said.text!r} says that angles are in {said.unit}; {each.unit} was chosen for {each.column}"
        raise InputError(table.file, f"line {said.line}", what, f"choose {wanted}, or correct the header")


def _over_seconds(path: Path) -> TextTable:
    table = read_table(path, leave_words=True)
    if table.time_unit != "s":
        raise InputError(path, "", "time is in per cent of a cycle", "write its time in s")
    return table
