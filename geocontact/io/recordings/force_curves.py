"""Contact forces by side over time: forces.csv of `geocontact loadcells`, or any table with such columns."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.io.recordings.load_cells import STRONGEST, column_in_newtons
from geocontact.io.text.tables import TextTable, listed, read_table

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
