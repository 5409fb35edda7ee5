"""Files about a shoulder exoskeleton and its wearer: numbers of the device with sources, lengths of the person."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from geocontact.data.errors import InputError
from geocontact.io.text.near_names import near_names
from geocontact.io.text.toml_text import toml_of
from geocontact.io.text.units import si_unit

LARGEST = 100_000
"""Bytes of a description."""
KEYS = ("value", "unit", "source", "note")


@dataclass(frozen=True)
class StatedNumber:
    """A number of a device in SI, where it is from, and why it is so."""

    value: float
    source: str
    note: str


@dataclass(frozen=True)
class DeviceFile:
    """Name, the device whose numbers count where none is given, and the numbers that are given."""

    name: str
    based_on: str
    numbers: Mapping[str, StatedNumber]


def read_device_file(path: Path, units: Mapping[str, str], sources: tuple[str, ...]) -> DeviceFile:
    """A device from `device.toml`; InputError for what it cannot be.

    Parameters
    ----------
    units
        SI unit of every number that a device has.
    sources
        Words that may say where a number is from.
    """
    content = toml_of(path, LARGEST)
    for key in content:
        if key not in ("name", "based_on", "numbers"):
            raise InputError(path, f"`{key}`", "is not known here", "write name, based_on and [numbers]")
    numbers = content.get("numbers", {})
    if not isinstance(numbers, dict):
        raise InputError(path, "[numbers]", "is no table", f"write bore = {_entry('m', sourced=True)}")
    found = {}
    for name, told in numbers.items():
        if name not in units:
            near = near_names([name], list(units))
            raise InputError(path, f"[numbers] {name}", "is no number of a device", _perhaps(near, units))
        found[name] = stated_number(path, name, told, units[name], sources)
    return DeviceFile(str(content.get("name", path.stem)), str(content.get("based_on", "lucy")), found)


def read_person_file(path: Path, names: tuple[str, ...]) -> dict[str, float]:
    """Lengths of a person [m] from a TOML file, `upper_arm = { value = 300, unit = "mm" }`; any may be missing."""
    content = toml_of(path, LARGEST)
    found = {}
    for name in names:
        if name in content:
            found[name] = stated_number(path, name, content[name], "m", ()).value
    if not found:
        raise InputError(path, "", f"none of {', '.join(names)}", f"write upper_arm = {_entry('m', sourced=False)}")
    return found


def _perhaps(near: Mapping[str, str], units: Mapping[str, str]) -> str:
    return f"perhaps {next(iter(near.values()))}" if near else f"numbers are {', '.join(units)}"


def _entry(si: str, *, sourced: bool) -> str:
    """An example of a number with its unit, as the file may have it."""
    value, unit = (32 if sourced else 300, "mm") if si == "m" else (1, si)
    source = ', source = "invented", note = "why"' if sourced else ""
    return f'{{ value = {value}, unit = "{unit}"{source} }}'


def stated_number(path: Path, name: str, told: Any, si: str, sources: tuple[str, ...]) -> StatedNumber:
    """A number with its unit, `{ value = 32, unit = "mm" }`, in SI; with `sources` also where it is from."""
    place, entry = f"[numbers] {name}" if sources else name, _entry(si, sourced=bool(sources))
    if not isinstance(told, dict) or not {"value", "unit"} <= set(told) <= set(KEYS):
        raise InputError(path, place, "is not a value with its unit", f"write {name} = {entry}")
    unit, value = str(told["unit"]), told["value"]
    if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
        raise InputError(path, place, f"{value!r} is not a finite number", f"write {name} = {entry}")
    known = (si, 1.0) if unit == si else si_unit(unit)
    if known is None or known[0] not in (si, "-" if si == "1" else si):
        raise InputError(path, place, f"{unit!r} is not a unit of it", f"its SI unit is {si}")
    source = str(told.get("source", "invented"))
    if sources and source not in sources:
        raise InputError(path, place, f"source {source!r} is not known", f"write one of {', '.join(sources)}")
    return StatedNumber(float(value) * known[1], source, str(told.get("note", "")))
