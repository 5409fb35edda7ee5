"""One recording of load cells, and what it comes to."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.data.cell_regression import CellRegression
from geocontact.loads.loadcells import CompartmentForces


@dataclass(frozen=True)
class RecordedCells:
    """A recording with the forces of its cells and of the compartments [N].

    Parameters
    ----------
    file
        Where it was read from.
    folder
        Of its results; empty where there is one recording.
    cells
        Columns in the order of the regression's cells.
    """

    file: Path
    folder: str
    cells: Float[np.ndarray, "t c"]
    forces: CompartmentForces

    def by_cell(self, regression: CellRegression) -> dict[str, Float[np.ndarray, " t"]]:
        """Forces of the cells by name [N]."""
        return dict(zip(regression.cells, self.cells.T, strict=True))

    def table(self) -> pd.DataFrame:
        """Forces of the compartments over time."""
        columns = {f"{side} [N]": values for side, values in self.forces.curves.items()}
        return pd.DataFrame({"time [s]": self.forces.time, **columns})
