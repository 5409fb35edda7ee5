"""area.csv as `geocontact area` writes it: area over time at one or several thresholds, whole and by side."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from os import fspath
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.tilted_areas import TiltedAreas
from geocontact.io.text.frame import read_frame

TIME, THRESHOLD, OFFSET = "time [s]", "threshold [mm]", "adduction offset [deg]"
COLUMNS = {
    "total": "area_fixed [mm^2]",
    "medial": "area_fixed_medial [mm^2]",
    "lateral": "area_fixed_lateral [mm^2]",
}
"""Column of each side."""

MM, MM2 = 1e-3, 1e-6
FEWEST = 8
"""Frames below which nothing is identified."""


@dataclass(frozen=True, eq=False)
class AreaTable:
    """Areas by side.

    Parameters
    ----------
    file
        Path as given, for messages.
    time
        (t,) [s].
    thresholds
        (k,) [m], increasing.
    areas
        (t, k) [m^2] by side: "total", and "medial" and "lateral" where the areas were split; at no offset.
    tilted
        By side, where areas at several offsets of adduction were given.
    """

    file: str
    time: Float[np.ndarray, " t"]
    thresholds: Float[np.ndarray, " k"]
    areas: dict[str, Float[np.ndarray, "t k"]]
    tilted: dict[str, TiltedAreas] = field(default_factory=dict)


def read_area_table(paths: Sequence[Path]) -> AreaTable:
    """One table, or several of the same frames at other thresholds or offsets of adduction."""
    tables = [_read(path) for path in paths]
    file = ", ".join(fspath(path) for path in paths)
    table = pd.concat(tables, ignore_index=True)
    sides = [side for side, name in COLUMNS.items() if all(name in each for each in tables)]
    thresholds = np.unique(table[THRESHOLD].to_numpy(float))
    time = np.unique(table[TIME].to_numpy(float))
    if len(time) < FEWEST:
        raise InputError(
            file, "", f"{len(time)} frames are too few", f"{FEWEST} at least; compute the area over a motion"
        )
    offsets = np.unique(table[OFFSET].to_numpy(float))
    at_none = np.flatnonzero(offsets == 0.0)
    if not len(at_none):
        what = f"areas at adduction offsets of {', '.join(f'{each:g}' for each in offsets)} degrees only"
        raise InputError(file, "", what, "give those without an offset as well")
    shape = (len(time), len(thresholds), len(offsets))
    if len(table) != np.prod(shape) or table.duplicated([TIME, THRESHOLD, OFFSET]).any():
        what = f"{len(table)} rows are not {len(time)} times at {len(thresholds)} thresholds, each once"
        if len(offsets) > 1:
            what = f"{what} for each of {len(offsets)} adduction offsets"
        raise InputError(file, "", what, "give areas of the same frames at each threshold and offset")
    ordered = table.sort_values([TIME, THRESHOLD, OFFSET])
    all_areas = {side: ordered[COLUMNS[side]].to_numpy(float).reshape(shape) * MM2 for side in sides}
    areas = {side: np.ascontiguousarray(each[:, :, at_none[0]]) for side, each in all_areas.items()}
    tilted = {side: TiltedAreas(np.radians(offsets), each) for side, each in all_areas.items()}
    return AreaTable(file, time, thresholds * MM, areas, tilted if len(offsets) > 1 else {})


def _read(path: Path) -> pd.DataFrame:
    table = read_frame(path, (TIME, THRESHOLD, OFFSET, *COLUMNS.values()), "give an area.csv")
    needed = [TIME, THRESHOLD, COLUMNS["total"]]
    if missing := [name for name in needed if name not in table]:
        percent = " (time is in per cent of a cycle)" if "time [%]" in table else ""
        what = f"no column {', '.join(missing)}{percent}; columns are: {', '.join(map(str, table.columns))[:300]}"
        raise InputError(path, "line 1", what, "give the area.csv of geocontact area over a motion in seconds")
    if OFFSET not in table:
        table[OFFSET] = 0.0
    for name in [*needed, OFFSET, *(each for each in COLUMNS.values() if each in table)]:
        numbers = pd.to_numeric(table[name], errors="coerce").to_numpy(float)
        bad = np.flatnonzero(~np.isfinite(numbers) | ((numbers < 0.0) & (name not in (TIME, OFFSET))))
        if len(bad):
            what = f"'{name}' is {str(table[name].iloc[int(bad[0])])[:40]}, not a number of 0 or more"
            raise InputError(path, f"row {int(bad[0]) + 2}", what, "is it an area.csv?")
        table[name] = numbers
    return table


def read_area_over_force(path: Path) -> tuple[Float[np.ndarray, " m"], Float[np.ndarray, " m"]]:
    """Measured areas over force from a table with the columns `force [N]` and `area [mm^2]`, in N and m^2."""
    from geocontact.io.text.side_table import read_side_table

    wanted = ("force [N]", "area [m^2]")
    table = read_side_table(path, wanted)
    for name in wanted:
        if name not in table:
            what = f"no column for {name.split()[0]} with its unit; columns are: {', '.join(map(str, table.columns))}"
            raise InputError(path, "line 1", what, "write force [N], area [mm^2]")
    force, area = table["force [N]"].to_numpy(float), table["area [m^2]"].to_numpy(float)
    if (area <= 0.0).any() or len(np.unique(force)) < len(force):
        raise InputError(path, "", "an area is not above 0 or a force occurs twice", "one row for each force")
    return force, area
