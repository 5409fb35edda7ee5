"""What the commands of a misaligned joint have in common: numbers of the exoskeleton, stroke and drift as typed."""

from __future__ import annotations

import math
from pathlib import Path

from geocontact.analyses import quantities
from geocontact.analyses.misalignment.parameters import require_link
from geocontact.analyses.run_record import Record
from geocontact.axis_misalignment.axis_drift import STILL, AxisDrift, from_instant_centre, polynomial, table
from geocontact.data.errors import InputError
from geocontact.io.recordings.axis_drift import read_axis_drift

EXAMPLE = "x=0:-8:2,y=0:5"


def above_zero(value: float, option: str, unit: str) -> float:
    """A finite number above 0, or one line that says so."""
    if not (math.isfinite(value) and value > 0.0):
        raise InputError("", option, f"{value:g} is not above 0", f"give {unit}")
    return value


def link(millimetres: float) -> float:
    """Length of the link [m]."""
    metres = above_zero(millimetres, "--l-mm", "mm") * 1e-3
    require_link(metres, "--l-mm")
    return metres


def stroke(text: str | None) -> tuple[float, float]:
    """Ends of the stroke [m]; both 0 where the joint is locked."""
    return (0.0, 0.0) if text is None else quantities.length_span(text, "--stroke-mm")


def drift(record: Record, text: str | None, span: tuple[float, float]) -> AxisDrift:
    """Drift of a table, or of coefficients in mm per power of rad; none where nothing was typed.

    A table that does not hold all angles of `span` [rad] is used with a warning: it is held at its ends.
    """
    if text is None:
        return STILL
    path = quantities.named_file(text)
    if path is None and "=" in text:
        return _polynomial(text)
    file = path or Path(text)
    told = read_axis_drift(file)
    record.add_input("--drift", file, rows=len(told.angle), tells=told.tells)
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


def _polynomial(text: str) -> AxisDrift:
    """ "x=0:-8:2,y=0:5" in mm, mm/rad, mm/rad²."""
    found: dict[str, list[float]] = {}
    for part in text.split(","):
        name, _, numbers = (piece.strip() for piece in part.partition("="))
        if name not in ("x", "y") or name in found:
            raise InputError("", "--drift", f"{part.strip()!r} is neither x=… nor y=…, once each", f"write {EXAMPLE}")
        found[name] = [1e-3 * quantities.number(each, "--drift", EXAMPLE) for each in numbers.split(":")]
    return polynomial(found.get("x", ()), found.get("y", ()))
