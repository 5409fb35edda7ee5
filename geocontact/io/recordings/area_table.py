"""Tables that the analyses write and others read: area.csv, forces.csv, profile.csv."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from os import fspath
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.evolution import TiltedAreas
from geocontact.io.recordings.load_cells import STRONGEST, column_in_newtons
from geocontact.io.text.results import read_frame
from geocontact.io.text.tables import TextTable, listed, read_table

TIME, THRESHOLD, OFFSET = "time [s]", "threshold [mm]", "adduction offset [deg]"
COLUMNS = {
    "total": "area_fixed [mm^2]",
    "medial": "area_fixed_medial [mm^2]",
    "lateral": "area_fixed_lateral [mm^2]",
}
"""Column of each side."""

MM, MM2 = 1e-3, 1e-6
HALVES, PARTS = ("medial", "lateral"), 0.01
"""Sides that are the total together, and share of the largest total that they may be off: triangles are cut exactly."""
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
    _doubt_parts(file, ordered, sides)
    all_areas = {side: ordered[COLUMNS[side]].to_numpy(float).reshape(shape) * MM2 for side in sides}
    areas = {side: np.ascontiguousarray(each[:, :, at_none[0]]) for side, each in all_areas.items()}
    tilted = {side: TiltedAreas(np.radians(offsets), each) for side, each in all_areas.items()}
    return AreaTable(file, time, thresholds * MM, areas, tilted if len(offsets) > 1 else {})


def _doubt_parts(file: str, table: pd.DataFrame, sides: Sequence[str]) -> None:
    """A warning for medial and lateral areas that are not the total one together."""
    if "medial" not in sides or "lateral" not in sides:
        return
    total, parts = (table[[COLUMNS[side] for side in of]].sum(axis=1).to_numpy(float) for of in (["total"], HALVES))
    off = np.abs(parts - total)
    at = int(np.argmax(off))
    if off[at] > PARTS * total.max():
        what = f"medial and lateral areas are {parts[at]:.0f} mm² together at {table[TIME].iloc[at]:g} s"
        warnings.warn(
            f"{file}: {what}, the total is {total[at]:.0f} mm²: is one of them of another trial, or in another unit?",
            InputWarning,
            stacklevel=3,
        )


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


SIDES = ("medial", "lateral", "total")


@dataclass(frozen=True, eq=False)
class ForceCurves:
    """Forces by side [N] over time [s], compression positive; `unit` is that of the file."""

    file: str
    time: Float[np.ndarray, " t"]
    forces: dict[str, Float[np.ndarray, " t"]]
    unit: str


def read_force_curves(path: Path, unit: str | None, mapping: Mapping[str, tuple[float, str]]) -> ForceCurves:
    """Columns `medial`, `lateral` and `total`, as far as they are there; the total is their sum where it is not.

    Parameters
    ----------
    unit
        Unit of the forces; None where their headers say it.
    mapping
        Sign and name of the column that holds a side, by side.
    """
    table = read_table(path)
    if table.time_unit != "s":
        raise InputError(table.file, "", "time is in per cent of a cycle", "give forces over seconds")
    sources = {side: mapping.get(side, (1.0, side)) for side in SIDES}
    there = {side: source for side, source in sources.items() if side in mapping or source[1] in table.channels}
    if not there:
        what = f"no column medial, lateral or total; columns are: {listed(table.channels)}"
        raise InputError(table.file, "", what, "name them: `map` medial=F1,lateral=F2")
    forces, units = _forces(table, there, unit)
    if "total" not in forces and {"medial", "lateral"} <= set(forces):
        forces["total"] = forces["medial"] + forces["lateral"]
    largest = max(float(np.abs(values).max()) for values in forces.values())
    if largest > STRONGEST:
        what = f"forces reach {largest:.0f} N"
        raise InputError(table.file, "", what, f"is the file in {units} at all? see `unit`")
    return ForceCurves(table.file, table.time, forces, units)


def _forces(
    table: TextTable, sources: Mapping[str, tuple[float, str]], unit: str | None
) -> tuple[dict[str, Float[np.ndarray, " t"]], str]:
    found = {side: (sign, *column_in_newtons(table, name, unit)) for side, (sign, name) in sources.items()}
    units = ", ".join(sorted({said for _, _, said in found.values()}))
    return {side: np.asarray(sign * values) for side, (sign, values, _) in found.items()}, units


NAMES = ("side", "flexion [deg]", "radius [mm]")


@dataclass(frozen=True, eq=False)
class RadiusProfile:
    """Radius [m] over flexion [rad], flexion increasing; places where the patch had no face are left out."""

    flexion: Float[np.ndarray, " m"]
    radius: Float[np.ndarray, " m"]


def read_radius_profile(path: Path) -> dict[str, RadiusProfile]:
    """Profiles by side, in the order of the file."""
    table = read_frame(path, NAMES, "give a profile.csv")
    if missing := [name for name in NAMES if name not in table]:
        raise InputError(path, "line 1", f"no column {', '.join(missing)}", "give the profile.csv of geocontact fit")
    found = {}
    for side, rows in table.groupby("side", sort=False):
        numbers = rows[list(NAMES[1:])].apply(pd.to_numeric, errors="coerce").dropna().sort_values(NAMES[1])
        flexion, radius = np.radians(numbers[NAMES[1]].to_numpy(float)), numbers[NAMES[2]].to_numpy(float) * 1e-3
        sound = np.isfinite([flexion, radius]).all() and (radius > 0.0).all() and (np.diff(flexion) > 0.0).all()
        if len(flexion) < 2 or not sound:
            what = f"side {side!r:.60}: radii must be above 0 at 2 angles or more, each angle once"
            raise InputError(path, "", what, "give the profile.csv of geocontact fit")
        found[str(side)] = RadiusProfile(flexion, radius)
    if not found:
        raise InputError(path, "", "no rows", "give the profile.csv of geocontact fit")
    return found
