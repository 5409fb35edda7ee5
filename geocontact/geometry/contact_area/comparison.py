"""Areas beside measured ones: at the same time and threshold, with the difference."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd

from geocontact.data.errors import InputError

TIME, THRESHOLD, RELATIVE = "time [s]", "threshold [mm]", "relative [-]"


@dataclass(frozen=True, eq=False)
class Compared:
    """A row per measured area, from `compared`, and the largest relative difference [-] that is acceptable."""

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


def is_area(name: str) -> bool:
    """Whether a column holds areas, as `AreaEvolution.table` names them: "area_fixed [mm^2]"."""
    return name.startswith("area_") and name.endswith("[mm^2]")


def compared(ours: pd.DataFrame, reference: pd.DataFrame, path: Path) -> pd.DataFrame:
    """A row per measured area: ours (linear in time between frames), the measured one, difference, relative difference.

    Parameters
    ----------
    ours
        Table of an evolution, `AreaEvolution.table`: time [s], threshold and areas in mm and mm^2.
    reference
        Measured areas in columns of the same names, over times and thresholds of their own; without a column of
        thresholds ours must be of a single one.
    path
        File of the measured areas, for messages.

    Raises
    ------
    InputError
        A time lies outside our frames, a threshold was not evaluated, a column is not among ours, or no area is a
        number.
    """
    levels = sorted(set(ours[THRESHOLD]))
    if THRESHOLD not in reference:
        if len(levels) > 1:
            raise InputError(path, "", "does not say which threshold it is for", f"add a column '{THRESHOLD}'")
        reference = reference.assign(**{THRESHOLD: levels[0]})
    rows = [
        _row(ours, row, name, path)
        for name in reference.columns
        if is_area(name)
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
