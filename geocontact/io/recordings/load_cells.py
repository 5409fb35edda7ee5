"""Recordings of an instrumented implant's load cells, and the files that say how cells make up compartments."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from os import fspath
from pathlib import Path

import numpy as np
from jaxtyping import Float
from pydantic import BaseModel, ConfigDict, ValidationError

from geocontact.data.cell_regression import CellRegression
from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import parts, release, room
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.tables import CELLS, TextTable, listed, read_table
from geocontact.io.text.toml_text import toml_of
from geocontact.io.text.units import DIMENSIONS, si_unit

_COLUMNS = ("style", "start [s]", "end [s]")


@dataclass(frozen=True)
class CycleRow:
    """One cycle: gait style, recording (empty where there is only one), start and end [s]."""

    style: str
    recording: str
    start: float
    end: float


def read_cycle_table(path: Path) -> tuple[CycleRow, ...]:
    """Rows of `style, recording, start [s], end [s]`; `recording` is the name of a file without its ending."""
    table = read_side_table(path, (*_COLUMNS, "recording"))
    if missing := [name for name in _COLUMNS if name not in table]:
        found = ", ".join(map(str, table.columns))
        what = f"no column {', '.join(missing)}; columns are: {found}"
        raise InputError(path, "line 1", what, "write style, recording, start [s], end [s]")
    recordings = table["recording"] if "recording" in table else [""] * len(table)
    rows = tuple(
        CycleRow(*row) for row in zip(table["style"], recordings, table["start [s]"], table["end [s]"], strict=True)
    )
    for k, row in enumerate(rows):
        if not row.start < row.end:
            raise InputError(
                path, f"row {k + 1}", f"a cycle from {row.start:g} to {row.end:g} s", "the end must be after the start"
            )
    return rows


LARGEST_REGRESSION = 8_000_000  # bytes
FORCES = DIMENSIONS["N"]
STRONGEST = 20e3  # N; no knee bears this much
_MATRIX = "write medial = [...] and cells = [...], or a .csv with the columns cell, medial [-], lateral [-]"


@dataclass(frozen=True)
class CellRecording:
    """Forces of the cells over time, compression positive.

    Parameters
    ----------
    file
        Path as given, for messages.
    time
        [s], strictly increasing.
    forces
        [N], columns in the order asked for.
    unit
        Unit in the file.
    """

    file: str
    time: Float[np.ndarray, " t"]
    forces: Float[np.ndarray, "t c"]
    unit: str


class RegressionFile(BaseModel):
    """Weights of cells in a .toml; lateral is what medial leaves where it is not given."""

    model_config = ConfigDict(extra="forbid", strict=True, allow_inf_nan=False)
    name: str | None = None
    source: str = ""
    cells: list[str]
    medial: list[float]
    lateral: list[float] | None = None


def read_load_cells(
    path: Path, cells: tuple[str, ...], unit: str | None, mapping: Mapping[str, tuple[float, str]]
) -> CellRecording:
    """Columns of a .csv, .mot or .sto table, in N.

    Parameters
    ----------
    cells
        Names of the cells; the same names are looked for among the columns, unless mapped.
    unit
        Unit of all of them; None where their headers say it (`PM [lbf]`). A header that says another is refused.
    mapping
        Sign and name of the column that holds a cell, by cell.
    """
    table = read_table(path)
    if table.time_unit != "s":
        raise InputError(table.file, "", "time is in per cent of a cycle", "give a recording in seconds")
    sources = [mapping.get(cell, (1.0, cell)) for cell in cells]
    for name in {name for _, name in sources if table.channels.count(name) > 1}:
        table.needed(name)  # refuses it, and says how often it occurs
    missing = [(cell, name) for cell, (_, name) in zip(cells, sources, strict=True) if name not in table.channels]
    if missing:
        what = f"no column '{missing[0][1]}' for the cell {missing[0][0]}; columns are: {listed(table.channels)}"
        raise InputError(table.file, "", what, f"name it, `map` {','.join(f'{cell}=…' for cell, _ in missing)}")
    columns = [(sign, *column_in_newtons(table, name, unit)) for sign, name in sources]
    units = {said for _, _, said in columns}
    forces = room((len(table.time), len(columns)))
    for cell, (sign, values, _) in zip(forces.T, columns, strict=True):
        cell[:] = sign * values
        release()
    largest = max(float(np.abs(part.sum(axis=1)).max()) for (part,) in parts(forces))
    if largest > STRONGEST:
        what = f"all cells together reach {largest:.0f} N"
        raise InputError(table.file, "", what, f"is the file in {', '.join(sorted(units))} at all? see `unit`")
    return CellRecording(table.file, table.time, forces, ", ".join(sorted(units)))


def column_in_newtons(table: TextTable, name: str, given: str | None) -> tuple[Float[np.ndarray, " t"], str]:
    """A column of forces [N] and its unit in the file, which its header says or `given` does."""
    unit = _unit(table, name, given)
    return np.asarray(table.needed(name) * FORCES[unit]), unit


def _unit(table: TextTable, name: str, given: str | None) -> str:
    """Unit of a column of forces, by its header or as given."""
    table.needed(name)
    said = table.units[table.channels.index(name)]
    if said and (si_unit(said) or ("", 0.0))[0] != "N":
        raise InputError(table.file, "", f"column '{name}' is in '{said}'", f"forces are in {', '.join(FORCES)}")
    if said and given and si_unit(said) != si_unit(given):
        raise InputError(table.file, "", f"column '{name}' is in {said}, not in {given}", "leave `unit` out")
    if not said and not given:
        raise InputError(table.file, "`unit`", "is missing: the file names no unit", "pass `unit` lbf, N or kN")
    return next(u for u in FORCES if si_unit(u) == si_unit(said or given or ""))


def read_regression(path: Path) -> CellRegression:
    """Weights from a .toml (cells, medial, lateral) or a .csv (cell, medial [-], lateral [-])."""
    suffix = path.suffix.lower()
    if suffix not in (".toml", *CELLS):
        raise InputError(path, "", f"'{suffix}' is not a file of weights", "give a .toml or a .csv")
    file = _from_toml(path) if suffix == ".toml" else _from_csv(path)
    lateral = [1.0 - weight for weight in file.medial] if file.lateral is None else file.lateral
    try:
        return CellRegression(
            file.name or path.stem, file.source or path.name, tuple(file.cells), tuple(file.medial), tuple(lateral)
        )
    except ValueError as error:
        raise InputError(path, "", str(error), _MATRIX) from error


def _from_toml(path: Path) -> RegressionFile:
    try:
        return RegressionFile.model_validate(toml_of(path, LARGEST_REGRESSION))
    except ValidationError as error:
        first = error.errors()[0]
        what = "is not known here" if first["type"] == "extra_forbidden" else first["msg"].lower()
        raise InputError(path, ".".join(map(str, first["loc"])), what, _MATRIX) from error


def _from_csv(path: Path) -> RegressionFile:
    wanted = ("cell", "medial [-]")
    table = read_side_table(path, (*wanted, "lateral [-]"))
    if missing := [name for name in wanted if name not in table]:
        found = ", ".join(map(str, table.columns))
        raise InputError(fspath(path), "line 1", f"no column {', '.join(missing)}; columns are: {found}", _MATRIX)
    lateral = table["lateral [-]"].tolist() if "lateral [-]" in table else None
    return RegressionFile(cells=table["cell"].tolist(), medial=table["medial [-]"].tolist(), lateral=lateral)
