"""Description of a population: what differs from person to person, and how."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.toml_text import toml_of
from geocontact.io.text.units import si_unit

LARGEST = 100_000
"""Bytes of the description."""

KINDS = {"value": (), "normal": ("mean", "sd"), "uniform": ("lower", "upper"), "table": ()}
"""How a quantity may be told, and the numbers that it then needs."""

CUTS = ("lower", "upper")
"""Numbers that a normal one may have besides."""


@dataclass(frozen=True)
class StatedQuantity:
    """A quantity: its kind, and its numbers in SI units (`value`, or those of `KINDS` and `CUTS`).

    `factor` is how many SI units the unit is that stands beside them.
    """

    kind: str
    numbers: Mapping[str, float]
    factor: float = 1.0


@dataclass(frozen=True, eq=False)
class PopulationFile:
    """Quantities by name, tables of people by file with their columns by name, and correlations by pair of names."""

    quantities: dict[str, StatedQuantity]
    tables: dict[Path, dict[str, Float[np.ndarray, " m"]]]
    correlations: dict[tuple[str, str], float]


def read_population(path: Path, units: Mapping[str, str]) -> PopulationFile:
    """The description, with `units` the SI units of the quantities that have to be in it; InputError otherwise."""
    content = toml_of(path, LARGEST)
    unknown = [key for key in content if key not in (*units, "correlation")]
    if unknown:
        raise InputError(
            path, f"[{unknown[0]}]", "is not a quantity here", f"these are: {', '.join(units)}, correlation"
        )
    missing = [name for name in units if not isinstance(content.get(name), dict)]
    if missing:
        raise InputError(path, "", f"no [{missing[0]}]", f"tell all of {', '.join(units)}")
    quantities = {name: _told(path, name, content[name], unit) for name, unit in units.items()}
    tables: dict[Path, dict[str, Float[np.ndarray, " m"]]] = {}
    for name, told in quantities.items():
        if told.kind == "table":
            file = path.parent / str(content[name]["table"])
            tables.setdefault(file, {})[name] = _column(file, name, units[name])
    return PopulationFile(quantities, tables, _correlations(path, content.get("correlation", {}), quantities))


def _told(path: Path, name: str, entry: dict[str, Any], unit: str) -> StatedQuantity:
    place = f"[{name}]"
    kinds = [kind for kind in KINDS if kind in entry]
    if len(kinds) != 1:
        raise InputError(path, place, f"is told in {len(kinds) or 'no'} ways", f"give one of {', '.join(KINDS)}")
    (kind,) = kinds
    if kind == "table":
        _only(path, place, entry, ("table",))
        return StatedQuantity(kind, {})
    _only(path, place, entry, (kind, "unit"))
    known = si_unit(str(entry.get("unit", "")))
    if known is None or known[0] != unit:
        raise InputError(
            path, place, f"unit is {entry.get('unit', 'missing')!r}", f"write one of {unit}, like unit = …"
        )
    given = {"value": entry[kind]} if kind == "value" else entry[kind]
    if not isinstance(given, dict):
        raise InputError(path, place, f"{kind} is no table", f"write {kind} = {{ {' = …, '.join(KINDS[kind])} = … }}")
    needed = KINDS[kind] or ("value",)
    _only(path, place, given, (*needed, *(CUTS if kind == "normal" else ())))
    numbers = {key: known[1] * _number(path, place, key, given.get(key)) for key in dict.fromkeys((*needed, *given))}
    _check_order(path, place, kind, numbers)
    return StatedQuantity(kind, numbers, known[1])


def _only(path: Path, place: str, entry: Mapping[str, Any], allowed: Sequence[str]) -> None:
    unknown = [key for key in entry if key not in allowed]
    if unknown:
        raise InputError(path, place, f"{unknown[0]!r} is not known here", f"these are: {', '.join(allowed)}")


def _number(path: Path, place: str, key: str, value: object) -> float:
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        what = "is missing" if value is None else f"{value!r} is not a finite number"
        raise InputError(path, place, f"{key} {what}", f"write {key} = 1.5")
    return float(value)


def _check_order(path: Path, place: str, kind: str, numbers: Mapping[str, float]) -> None:
    if kind == "normal" and numbers["sd"] <= 0.0:
        raise InputError(path, place, "sd is not above 0", "write value = … for what is the same for everybody")
    if numbers.get("upper", math.inf) <= numbers.get("lower", -math.inf):
        raise InputError(path, place, "upper is not above lower", "turn them round")


def _column(file: Path, name: str, unit: str) -> Float[np.ndarray, " m"]:
    label = f"{name} [{unit}]"
    table = read_side_table(file, (label,))
    if label not in table:
        what = f"no column '{name}' in {unit} or a multiple; columns are: {', '.join(map(str, table.columns))}"
        raise InputError(file, "line 1", what, f"write {label}")
    return table[label].to_numpy(float)


def _correlations(path: Path, entry: object, quantities: Mapping[str, StatedQuantity]) -> dict[tuple[str, str], float]:
    """Pairs written as x_y = 0.4."""
    place = "[correlation]"
    if not isinstance(entry, dict):
        raise InputError(path, place, "is no table", "write x_y = 0.4 below [correlation]")
    found: dict[tuple[str, str], float] = {}
    for key, value in entry.items():
        first, _, second = key.partition("_")
        for name in (first, second):
            if name not in quantities or first == second:
                raise InputError(path, place, f"{key!r} is no pair of quantities", "write x_y = 0.4")
            if quantities[name].kind not in ("normal", "uniform"):
                what = f"{name} is told by {quantities[name].kind}"
                raise InputError(path, place, what, "a table brings its own correlation, a value has none")
        if (second, first) in found:
            raise InputError(path, place, f"{key!r} is told twice", "keep one")
        found[first, second] = _number(path, place, key, value)
        if abs(found[first, second]) >= 1.0:
            raise InputError(path, place, f"{key} = {found[first, second]:g} is not between -1 and 1", "e.g. 0.4")
    return found
