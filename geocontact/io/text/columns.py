"""Columns of a table in SI units, and the little language that names them: `rz=knee_flexion,ry=-knee_rotation`."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from math import pi
from typing import NoReturn

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.text.tables import TextTable, listed
from geocontact.io.text.units import ANGLE, LENGTH, length_unit

LARGEST_RADIANS = 2.0 * pi
"""An angle beyond a full turn is taken for degrees."""

FEW_DEGREES = 0.2, 2.0
"""Degrees that no angle exceeds where they may be radians: of one or two columns, and of three or more under one flag
of a .mot or .sto. A whole motion within two degrees is rarer than one column; walking in radians stays below 1.3."""
MANY = 3
"""Columns that make a whole motion."""


def lengths(table: TextTable, names: Sequence[str]) -> Float[np.ndarray, "t k"]:
    """Columns in m: OpenSim's files are in m, a .csv must name the unit of each column."""
    return np.column_stack([table.needed(name) * _metres(table, name) for name in names])


def angles_of(table: TextTable, names: Sequence[str], angles: str | None = None) -> Float[np.ndarray, "t k"]:
    """Columns in rad.

    Parameters
    ----------
    angles
        "deg" or "rad" where the user says so; it overrules what the file says, with a warning when they disagree or
        when "rad" makes more than a turn of it.

    A file that says nothing or contradicts itself is refused, and so is one that says rad and holds more than a turn.
    One that says deg and never exceeds 0.2, or 2 in three columns of a .mot or .sto, is used with a warning.
    """
    if angles not in (None, "deg", "rad"):
        raise InputError("", "`angles`", f"'{angles}' is not a unit of angles here", "give deg or rad")
    values = np.column_stack([table.needed(name) for name in names])
    said = [_stated_unit(table, name) for name in names]
    units = [angles or unit or _ask(table, name) for name, unit in zip(names, said, strict=True)]
    if angles is None:
        _check_size(table, names, values, units)
    else:
        _warn_of_doubts(table, names, values, said, angles)
    return np.asarray(values * np.array([ANGLE[unit] for unit in units]))


def resolve(table: TextTable, name: str, joint: str = "") -> str | None:
    """The column that holds a coordinate: `name`, `joint/name/value` or `/jointset/joint/name/value`; None without.

    Without `joint` any joint's path will do.
    """
    ending = f"{joint}/{name}/value"
    there = dict.fromkeys(table.channels)
    found = [c for c in there if c in (name, ending) or c.endswith(f"/{ending.lstrip('/')}")]
    if not found:  # then without regard to case
        name, ending = name.casefold(), ending.casefold()
        alike = {c: c.casefold() for c in there}
        found = [c for c, own in alike.items() if own in (name, ending) or own.endswith(f"/{ending.lstrip('/')}")]
    if len(found) > 1:
        raise InputError(table.file, "", f"'{name}' is in several columns: {listed(tuple(found))}", "keep one of them")
    return found[0] if found else None


def parse_map(text: str, targets: Sequence[str]) -> dict[str, tuple[float, str]]:
    """`"rz=knee_flexion,ry=-knee_rotation"` as target → (sign, column), in the order written."""
    mapping: dict[str, tuple[float, str]] = {}
    for part in text.split(","):
        target, equals, name = (piece.strip() for piece in part.partition("="))
        if not equals or not name.lstrip("-+ "):
            raise InputError("", "`map`", f"'{part.strip()}' is not of the form target=column", "e.g. rz=knee_flexion")
        if target not in targets:
            raise InputError("", "`map`", f"unknown target '{target}'", f"targets are: {', '.join(targets)}")
        if target in mapping:
            raise InputError("", "`map`", f"target '{target}' is given twice", "name one column for each target")
        mapping[target] = (-1.0 if name.startswith("-") else 1.0, name.lstrip("-+ "))
    return mapping


def mapped(
    table: TextTable,
    mapping: dict[str, tuple[float, str]],
    rotations: Sequence[str],
    shifts: Sequence[str],
    angles: str | None,
) -> tuple[Float[np.ndarray, "t a"], Float[np.ndarray, "t b"]]:
    """Angles [rad] and lengths [m] of the targets in the order asked for; unmapped ones are 0, with a warning."""
    turned, moved = (np.zeros((len(table.time), len(targets))) for targets in (rotations, shifts))
    for targets, out in ((rotations, turned), (shifts, moved)):
        used = [target for target in targets if target in mapping]
        if not used:
            continue
        names = [resolve(table, mapping[target][1]) or mapping[target][1] for target in used]
        values = angles_of(table, names, angles) if out is turned else lengths(table, names)
        out[:, [targets.index(target) for target in used]] = values * np.array([mapping[t][0] for t in used])
    missing = [target for target in (*rotations, *shifts) if target not in mapping]
    if missing:
        warnings.warn(
            InputWarning(f"{table.file}: nothing is mapped to {', '.join(missing)}; taken as 0"), stacklevel=3
        )
    return turned, moved


def _metres(table: TextTable, name: str) -> float:
    if table.opensim:
        return 1.0
    written = _csv_unit(table, name)
    unit = length_unit(written)
    if unit is None:
        what = f"column '{name}' is in '{written}'" if written else f"column '{name}' has no unit"
        raise InputError(table.file, "", what, f"write e.g. `{name} [mm]` (one of {', '.join(LENGTH)})")
    return LENGTH[unit]


def _csv_unit(table: TextTable, name: str) -> str:
    table.needed(name)
    return table.units[table.channels.index(name)]


def _stated_unit(table: TextTable, name: str) -> str | None:
    """Unit of an angle column by its file: the header of a .csv column, what an OpenSim header says of all."""
    said: str | None = table.angles.unit if table.opensim else _csv_unit(table, name) or None
    if said is not None and said not in ANGLE:
        raise InputError(table.file, "", f"angle column '{name}' is in '{said}'", f"write `{name} [deg]` or [rad]")
    return said


def _ask(table: TextTable, name: str) -> NoReturn:
    """Refuse an angle column whose unit the file does not tell, or tells in two ways."""
    if table.angles.conflict:
        raise InputError(table.file, f"line {table.angles.line}", table.angles.conflict, "pass `angles` deg or rad")
    remedy = "pass `angles` deg or rad" + (" (SIMM motion files are in degrees by convention)" * table.angles.simm)
    where = "header" if table.opensim else f"column '{name}'"
    raise InputError(table.file, "", f"{where} does not say whether angles are degrees or radians", remedy)


def _check_size(table: TextTable, names: Sequence[str], values: Float[np.ndarray, "t k"], units: list[str]) -> None:
    if found := _beyond_a_turn(table, names, values, units):
        what = f"{found[1]}, too much for the radians that the header declares"
        raise InputError(table.file, found[0], what, "pass `angles` deg or rad")
    size = np.max(np.abs(values))
    if set(units) == {"deg"} and 0.0 < size < FEW_DEGREES[table.opensim and len(names) >= MANY]:
        what = f"no angle exceeds {size:.3g} deg; if they are radians pass `angles` rad"
        warnings.warn(InputWarning(f"{table.file}: {what}"), stacklevel=4)


def _warn_of_doubts(
    table: TextTable, names: Sequence[str], values: Float[np.ndarray, "t k"], said: list[str | None], angles: str
) -> None:
    """The user's word is followed; say where the file says otherwise, and where the size of the numbers does."""
    doubts = []
    if other := {unit for unit in said if unit not in (None, angles)}:
        doubts.append(f"{table.file}: says {other.pop()}, read as {angles} as asked for")
    elif table.angles.conflict:
        doubts.append(f"{table.file} line {table.angles.line}: {table.angles.conflict}; read as {angles} as asked for")
    if found := _beyond_a_turn(table, names, values, [angles] * len(names)):
        doubts.append(f"{table.file} {found[0]}: {found[1]}, much for radians; if these are degrees pass `angles` deg")
    for doubt in doubts:
        warnings.warn(InputWarning(doubt), stacklevel=4)


def _beyond_a_turn(
    table: TextTable, names: Sequence[str], values: Float[np.ndarray, "t k"], units: list[str]
) -> tuple[str, str] | None:
    """Place and words for the first column in rad that exceeds a turn; None when there is none."""
    for name, unit, column in zip(names, units, np.abs(values).T, strict=True):
        row = int(np.argmax(column))
        if unit == "rad" and column[row] > LARGEST_RADIANS:
            return f"line {table.lines[row]}", f"column '{name}' reaches {column[row]:.4g}"
    return None
