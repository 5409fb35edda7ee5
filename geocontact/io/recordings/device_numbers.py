"""Dynamic parameters of an exoskeleton as `sit-to-stand device` wrote them into numbers.csv."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.data.plausible import LARGEST_MEANT, TALL, TOO_LARGE
from geocontact.io.text.csv_text import dict_rows

LARGEST = 1_000_000
"""Bytes."""
HEIGHT, ALONE = "height", "found, by itself"
REMEDY = "give numbers.csv of sit-to-stand device"


@dataclass(frozen=True)
class DeviceNumbers:
    """What is read.

    Parameters
    ----------
    height
        Of the person whom it was set to [m].
    values
        Parameters by name, in SI.
    by_itself
        Names of those that the motion identified by themselves.
    """

    height: float
    values: Mapping[str, float]
    by_itself: tuple[str, ...]


def read_device_numbers(path: Path, names: Collection[str]) -> DeviceNumbers:
    """Height and parameters; InputError where one of `names` is missing, twice or no number."""
    rows = dict_rows(path, LARGEST, "a table of numbers")
    if not {"number", "value", "note"} <= set(rows.fieldnames or ()):
        raise InputError(path, "line 1", "has no columns number, value and note", REMEDY)
    found: dict[str, float] = {}
    alone: list[str] = []
    wanted = {HEIGHT, *names}
    for line, row in enumerate(rows, 2):
        name = row["number"]
        if name not in wanted:
            continue
        if name in found:
            raise InputError(path, f"line {line}", f"{name} is there twice", "keep one of them")
        found[name] = _number(path, f"line {line}", name, row["value"])
        if row["note"] == ALONE:
            alone.append(name)
    missing = [name for name in (HEIGHT, *names) if name not in found]
    if missing:
        raise InputError(path, "", f"no {', '.join(missing)}", REMEDY)
    return DeviceNumbers(found.pop(HEIGHT), found, tuple(alone))


def _number(path: Path, place: str, name: str, text: str | None) -> float:
    """A finite number; the height is one of a person."""
    try:
        value = float(text or "")
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(path, place, f"{name} is not a number", REMEDY)
    if abs(value) > LARGEST_MEANT:
        raise InputError(path, place, f"{name} {TOO_LARGE}", REMEDY)
    if name == HEIGHT and (refusal := TALL.refusal(value)) is not None:
        raise InputError(path, place, f"{name}: {refusal[0]}", refusal[1])
    return value
