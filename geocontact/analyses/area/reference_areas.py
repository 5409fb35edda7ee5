"""The user's own measured areas beside ours."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.data.errors import InputError
from geocontact.io.text.frame import read_frame

PARTS = ("", "_lower", "_upper", "_medial", "_lateral")
TIME, THRESHOLD, RELATIVE = "time [s]", "threshold [mm]", "relative [-]"


@dataclass(frozen=True)
class Reference:
    """The user's table and the largest relative difference to it that is acceptable."""

    path: Path
    table: pd.DataFrame
    tolerance: float

    def accepts(self, rows: pd.DataFrame) -> bool:
        """Whether no row of a comparison is beyond the tolerance."""
        return largest_difference(rows) <= self.tolerance


@dataclass(frozen=True, eq=False)
class Compared:
    """A row per measured area, from `compared`, and the largest relative difference that is acceptable."""

    rows: pd.DataFrame
    tolerance: float

    @property
    def largest(self) -> float:
        """Largest relative difference."""
        return largest_difference(self.rows)

    @property
    def accepted(self) -> bool:
        """Whether no row is beyond the tolerance."""
        return self.largest <= self.tolerance


def read_reference(path: Path) -> pd.DataFrame:
    """Reference table: `time [s]`, optionally `threshold [mm]`, and one or more area columns as in area.csv [mm^2]."""
    areas = (f"area_{body}{part} [mm^2]" for body in ("fixed", "moving") for part in PARTS)
    table = read_frame(path, (TIME, THRESHOLD, *areas), "give a CSV like area.csv")
    if TIME not in table or not any(_is_area(name) for name in table.columns):
        what = f"has the columns {', '.join(map(str, table.columns))}"
        raise InputError(path, "", what, "it needs 'time [s]' and for example 'area_fixed [mm^2]'")
    for name in table.columns:
        if name in (TIME, THRESHOLD) or _is_area(name):
            table[name] = pd.to_numeric(table[name], errors="coerce")
    if table[TIME].isna().any():
        raise InputError(path, f"row {int(table[TIME].isna().argmax()) + 2}", "time is not a number", "correct it")
    return table


def _is_area(name: str) -> bool:
    return name.startswith("area_") and name.endswith("[mm^2]")


def compared(ours: pd.DataFrame, reference: pd.DataFrame, path: Path) -> pd.DataFrame:
    """One row per reference value: ours (linear in time between frames), theirs, difference, relative difference.

    Reference times outside our own frames are refused; rows without a threshold need ours to have only one.
    """
    levels = sorted(set(ours[THRESHOLD]))
    if THRESHOLD not in reference:
        if len(levels) > 1:
            raise InputError(path, "", "does not say which threshold it is for", f"add a column '{THRESHOLD}'")
        reference = reference.assign(**{THRESHOLD: levels[0]})
    rows = [
        _row(ours, row, name, path)
        for name in reference.columns
        if _is_area(name)
        for _, row in reference.iterrows()
        if np.isfinite(row[name])
    ]
    if not rows:
        raise InputError(path, "", "no area in it is a number", "give measured areas in mm^2")
    return pd.DataFrame(rows)


def largest_difference(rows: pd.DataFrame) -> float:
    """Largest relative difference of a comparison."""
    return float(rows[RELATIVE].abs().max())


def _row(ours: pd.DataFrame, row: pd.Series, name: str, path: Path) -> dict[str, object]:
    if name not in ours:
        raise InputError(path, name, "is not among our columns", f"ours are {', '.join(ours.columns)}")
    same = ours[np.isclose(ours[THRESHOLD], row[THRESHOLD], rtol=1e-9, atol=1e-9)]
    if same.empty:
        levels = ", ".join(f"{level:g}" for level in sorted(set(ours[THRESHOLD])))
        raise InputError(path, "", f"threshold {row[THRESHOLD]:g} mm was not evaluated ({levels})", "see `threshold`")
    time, value = same[TIME].to_numpy(float), same[name].to_numpy(float)
    tolerance = 1e-6 * max(1.0, float(np.abs(time).max()))
    if not time[0] - tolerance <= row[TIME] <= time[-1] + tolerance:
        raise InputError(path, "", f"time {row[TIME]:g} lies outside {time[0]:g} … {time[-1]:g}", "shift its clock")
    mine = float(np.interp(row[TIME], time, value))
    theirs = float(row[name])
    return {
        TIME: row[TIME],
        THRESHOLD: row[THRESHOLD],
        "quantity": name,
        "ours [mm^2]": mine,
        "reference [mm^2]": theirs,
        "difference [mm^2]": mine - theirs,
        RELATIVE: (mine - theirs) / theirs if theirs else (0.0 if mine == 0.0 else np.inf),
    }
