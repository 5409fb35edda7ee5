"""Parameters of contacts as a calibration wrote them: `parameter, unit, value` and more columns (.csv)."""

from __future__ import annotations

import csv
import math
from collections.abc import Collection, Mapping
from pathlib import Path

from geocontact.data.errors import InputError
from geocontact.data.magnitude import LARGEST_MEANT, TOO_LARGE
from geocontact.io.text.csv_text import text_of

LARGEST = 1_000_000
"""Bytes."""


def read_contact_parameters(
    path: Path, units: Mapping[str, str], bounds: Mapping[str, tuple[float, float]]
) -> dict[str, float]:
    """Values by name in SI; InputError where one of `units` is missing, twice, in another unit or out of bounds."""
    text = text_of(path, LARGEST, "a table of parameters").decode("utf-8")
    rows = csv.DictReader(text.splitlines())
    if not {"parameter", "unit", "value"} <= set(rows.fieldnames or ()):
        remedy = "give parameters.csv of a calibration"
        raise InputError(path, "line 1", "has no columns parameter, unit and value", remedy)
    found: dict[str, float] = {}
    for number, row in enumerate(rows, 2):
        name, unit = row["parameter"], row["unit"]
        if name not in units:
            continue
        if name in found:
            raise InputError(path, f"line {number}", f"{name} is there twice", "keep one of them")
        if unit != units[name]:
            raise InputError(path, f"line {number}", f"{name} is in {unit!r}", f"it is in {units[name]} here")
        try:
            found[name] = float(row["value"])
        except (TypeError, ValueError):
            found[name] = math.nan
        if not math.isfinite(found[name]):
            raise InputError(path, f"line {number}", f"{name} is no number", "calibrate it, or write its value")
        low, high = bounds[name]
        if not low <= found[name] <= high:
            what = f"{name} {found[name]:g} {unit} is outside {low:g} to {high:g}"
            raise InputError(path, f"line {number}", what, "check value and unit")
    missing = [name for name in units if name not in found]
    if missing:
        raise InputError(path, "", f"no {', '.join(missing)}", "calibrate trials with the exoskeleton")
    return found


def read_contact_intervals(path: Path, names: Collection[str]) -> dict[str, tuple[float, float]]:
    """Ends of the intervals of `names` in SI, of those that have one: a held parameter has none.

    InputError for an interval without room.
    """
    rows = csv.DictReader(text_of(path, LARGEST, "a table of parameters").decode("utf-8").splitlines())
    found: dict[str, tuple[float, float]] = {}
    for row in rows:
        if row.get("parameter") in names:
            try:
                low, high = float(row["lower"]), float(row["upper"])
            except (KeyError, TypeError, ValueError):
                continue
            if not (math.isfinite(low) and math.isfinite(high)):
                continue
            if max(abs(low), abs(high)) > LARGEST_MEANT:
                raise InputError(path, row["parameter"], f"an end of its interval {TOO_LARGE}", "calibrate it again")
            if not low < high:
                what = f"no room between {low:g} and {high:g}"
                raise InputError(path, row["parameter"], what, "give lower < upper, or leave both empty")
            found[row["parameter"]] = low, high
    return found
