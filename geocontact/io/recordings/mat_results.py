"""Where a mat lies on a scan: landmarks of a recording, and what `geocontact mat` wrote."""

from __future__ import annotations

import math
from dataclasses import dataclass
from os import fspath
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.io.cases.trial_table import AREA, PLACE, read_trial
from geocontact.io.recordings.landmarks import Landmarks, read_landmarks
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.tables import listed

EXAMPLE = "id, row, column, x [mm], y [mm], z [mm]"
FEWEST = 2


@dataclass(frozen=True)
class MatLandmarks:
    """Landmarks of a mat.

    Parameters
    ----------
    name
        Of each.
    place
        Row and column in cells from the corner of the first cell: (0, 0) is that corner, (0.5, 0.5) its middle.
    point
        On the scan, in its frame [m].
    picked
        The file that they were read from; None where they were found otherwise.
    """

    name: tuple[str, ...]
    place: Float[np.ndarray, "k 2"]
    point: Float[np.ndarray, "k 3"]
    picked: Landmarks | None = None


def read_mat_landmarks(path: Path, rows: int, columns: int) -> MatLandmarks:
    """Landmarks of a CSV `id, row, column, x [mm], y [mm], z [mm]` (any unit of length) for a mat of that size.

    Refused: fewer than two, a name or a place that occurs twice, a place off the mat, a mat that all of them are on one
    point of.
    """
    found, file = read_landmarks(path, ("row", "column"), EXAMPLE), fspath(path)
    table, names, point = found.table, found.names, found.points
    place = np.array([[_number(table, file, name, k) for name in ("row", "column")] for k in range(len(table))])
    if len(names) < FEWEST:
        raise InputError(file, "", f"{len(names)} landmark is too few", "give four or more, two at the least")
    places = [tuple(each) for each in place.tolist()]
    twice = [each for k, each in enumerate(places) if each in places[:k]]
    if twice:
        raise InputError(file, "", f"place {twice[0]} occurs twice", "keep one")
    off = (place < 0.0) | (place > np.array([rows, columns]))
    if off.any():
        k = int(np.argmax(off.any(axis=1)))
        what = (
            f"landmark {names[k]} lies at row {place[k, 0]:g}, column {place[k, 1]:g}, off a mat of {rows} × {columns}"
        )
        raise InputError(file, f"row {k + 1}", what, "rows and columns count cells from the first cell's corner")
    if not np.ptp(point, axis=0).max() > 0.0:
        raise InputError(file, "", "all landmarks are at one point of the scan", "give their own points")
    return MatLandmarks(names, place, point, found)


def _number(table: pd.DataFrame, file: str, name: str, k: int) -> float:
    text = str(table[name].iloc[k])
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise InputError(file, f"row {k + 1}", f"{name} is {text[:40]!r}", "write a number of cells, such as 0 or 7.5")
    return value


CELLS, FRAMES = "cells.csv", "frames_cells.csv"


@dataclass(frozen=True, eq=False)
class MatFolder:
    """A mat on its surface.

    Parameters
    ----------
    cells
        Row and column of each.
    place, area
        Middles in the frame of the results [m], and areas [m^2].
    time, pressure
        Of the frames [s], and of every cell [Pa].
    """

    folder: Path
    cells: tuple[tuple[str, str], ...]
    place: Float[np.ndarray, "n 3"]
    area: Float[np.ndarray, " n"]
    time: Float[np.ndarray, " t"]
    pressure: Float[np.ndarray, "t n"]

    @property
    def force(self) -> Float[np.ndarray, " t"]:
        """Sum of pressure times area [N], whichever way cells look: `normal [N]` of wrench.csv."""
        return np.asarray(self.pressure @ self.area)


def read_mat_result(folder: Path) -> MatFolder:
    """Cells and frames in the folder that `geocontact mat` named."""
    for name in (CELLS, FRAMES):
        if not (folder / name).is_file():
            raise InputError(folder, "", f"no {name} in it", "name the folder that `geocontact mat` wrote")
    table, frames = read_side_table(folder / CELLS), read_trial(folder / FRAMES)
    wanted = ("id", "row", "column", *PLACE, AREA)
    if missing := tuple(name for name in wanted if name not in table.columns):
        raise InputError(folder / CELLS, "line 1", f"no column {listed(missing)}", "run `geocontact mat` again")
    ids = tuple(str(name) for name in table["id"])
    if set(ids) != set(frames.signals.channels):
        raise InputError(folder / FRAMES, "line 1", f"its cells are not those of {CELLS}", "run `geocontact mat` again")
    pressure = np.column_stack([frames.signals.column(name) for name in ids])
    cells = tuple(zip(map(str, table["row"]), map(str, table["column"]), strict=True))
    place, area = table[list(PLACE)].to_numpy(float), table[AREA].to_numpy(float)
    return MatFolder(folder, cells, place, area, frames.signals.time, pressure)
