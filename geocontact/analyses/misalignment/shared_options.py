"""Options of several analyses of the elbow, and values of options that cannot be. Light to import."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated

from geocontact.analyses.frame.marks import AngleUnit, Expression, ForceUnit, Spelled, Typed
from geocontact.analyses.frame.options import Options
from geocontact.analyses.misalignment.law_numbers import DRIFT, STROKE
from geocontact.data.errors import InputError
from geocontact.data.plausible import CUTOFF, JOINT_ANGLE

Angles = Annotated[tuple[float, float], Typed("rad", "angle_span", "gc.deg(0, 120)"), Spelled(dashed=True), JOINT_ANGLE]
Stroke = Annotated[
    tuple[float, float],
    Typed("m", "length_span", "gc.mm(-20, 35)"),
    Spelled("stroke-mm", "stroke_mm", dashed=True),
    STROKE,
]
Drift = Annotated[
    Path | Mapping[str, tuple[float, ...]],
    Typed("-", "misalignment.planar:drift", '{"x": gc.mm(0, -8, 2)}'),
    Spelled(dashed=True),
    DRIFT,
]
SMALLEST_SPAN = math.radians(5.0)
"""rad; nobody asks for what happens within less, but radians are taken for degrees."""
MIXED_UP = "are degrees and radians mixed up?"


@dataclass(frozen=True)
class ColumnOptions(Options):
    """How the columns of recordings are read and filtered.

    Parameters
    ----------
    Columns and units
    -----------------
    map
        Columns by what they are, where they have other names: beta=elbow_flexion,force=-Fx.
    angles
        Unit of the angle where its file does not say.
    unit
        Unit of the force where its file does not say.
    cutoff
        Cut-off of a zero-lag low-pass over the measured channels [Hz]; none by default.
    """

    _: KW_ONLY
    map: Expression | None = None
    angles: AngleUnit | None = None
    unit: ForceUnit | None = None
    cutoff: Annotated[float | None, CUTOFF] = None


def require_rising(ends: tuple[float, float] | None, option: str) -> None:
    """Refuse a range without room between its ends."""
    if ends is not None and not ends[0] < ends[1]:
        raise InputError("", option, "has no room between its ends", "give the lower one first")


def require_span(ends: tuple[float, float]) -> None:
    """Refuse angles [rad] of `range` that do not rise, hardly differ, or are more than a turn."""
    require_rising(ends, "`range`")
    told = f"{math.degrees(ends[0]):.4g} to {math.degrees(ends[1]):.4g} degrees"
    if ends[1] - ends[0] < SMALLEST_SPAN:
        raise InputError("", "`range`", f"{told} is hardly a range", MIXED_UP)
    if max(map(abs, ends)) > 2.0 * math.pi:
        raise InputError("", "`range`", f"{told} is more than a turn", MIXED_UP)


def require_stroke(ends: tuple[float, float] | None) -> None:
    """Refuse a stroke whose upper end is below the lower one."""
    if ends is not None and not ends[0] <= ends[1]:
        raise InputError("", "`stroke`", "its upper end is below the lower one", "give the lower end first")


def require_at_least_0(value: float | int | None, option: str) -> None:
    """Refuse a value that is negative or not finite."""
    if value is not None and not 0.0 <= value < math.inf:
        raise InputError("", option, f"{value:g} is not 0 or more", "give for example 0.5")


def require_within(
    value: float | int | None, option: str, ends: tuple[float | int, float | int], usual: float | int
) -> None:
    """Refuse a value that is not between two ends."""
    if value is not None and not ends[0] <= value <= ends[1]:
        raise InputError("", option, f"{value:g} is not {ends[0]:g} to {ends[1]:.10g}", f"give {usual:g}")


def require_drift(drift: object) -> None:
    """Refuse coefficients of something else than x and y."""
    for name in drift if isinstance(drift, Mapping) else ():
        if name not in ("x", "y"):
            raise InputError("", "`drift`", f"{name!r} is neither x nor y", "the axis drifts along these")
