"""What `geocontact mat` wrote of one recording: where its cells lie on the body, and what each read."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.io.cases.case_cells import AREA, PLACE
from geocontact.io.cases.trial_table import read_trial
from geocontact.io.text.side_table import read_side_table
from geocontact.io.text.tables import listed

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
