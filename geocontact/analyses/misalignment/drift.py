"""How the joint's axis wanders with the angle, as the options tell it: coefficients, or a table."""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path

from geocontact.analyses import quantities
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.axis_drift import STILL, AxisDrift, from_instant_centre, polynomial, table
from geocontact.data.errors import InputError
from geocontact.io.recordings.axis_drift import read_axis_drift

EXAMPLE = "x=0:-8:2,y=0:5"


def typed(text: str, option: str) -> Path | dict[str, tuple[float, ...]]:
    """ "x=0:-8:2,y=0:5" (mm, mm/rad, mm/rad²) to coefficients in SI; else the file of that name."""
    path = quantities.named_file(text)
    if path is not None or "=" not in text:
        return path or Path(text)
    found: dict[str, tuple[float, ...]] = {}
    for part in text.split(","):
        name, _, numbers = (piece.strip() for piece in part.partition("="))
        if name not in ("x", "y") or name in found:
            raise InputError("", option, f"{part.strip()!r} is neither x=… nor y=…, once each", f"write {EXAMPLE}")
        found[name] = tuple(1e-3 * quantities.number(each, option, EXAMPLE) for each in numbers.split(":"))
    return found


def axis_drift(
    record: Record, told: Path | Mapping[str, tuple[float, ...]] | None, span: tuple[float, float]
) -> AxisDrift:
    """Drift of coefficients [m, m/rad, m/rad², …] or of a table; none where nothing is told.

    A table that does not hold all angles of `span` [rad] is used with a warning: it is held at its ends.
    """
    if told is None:
        return STILL
    return polynomial(told.get("x", ()), told.get("y", ())) if isinstance(told, Mapping) else _table(record, told, span)


def _table(record: Record, file: Path, span: tuple[float, float]) -> AxisDrift:
    told = read_axis_drift(file)
    record.add_input("`drift`", file, rows=len(told.angle), tells=told.tells)
    if told.angle[0] > span[0] or told.angle[-1] < span[1]:
        ends, asked = (
            " to ".join(f"{math.degrees(a):.4g}" for a in two) for two in ((told.angle[0], told.angle[-1]), span)
        )
        record.warn(f"{file}: angles from {ends} deg, asked for {asked}: beyond its ends the axis is taken to stay")
    try:
        if told.tells == "instant centre":
            return from_instant_centre(told.angle, told.x, told.y)
        return table(told.angle, told.x, told.y, over_joint=told.tells == "joint")
    except ValueError as error:
        raise InputError(file, "", str(error), "give rising angles that hold the whole range") from error
