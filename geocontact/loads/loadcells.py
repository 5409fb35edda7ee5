"""Four load cells under a tibial tray become a medial and a lateral contact force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.cell_regression import CellRegression

PUBLISHED = CellRegression(
    name="eknee",
    source=(
        "regression for the first-generation eKnee tray (posterior-medial, anterior-medial, anterior-lateral, "
        "posterior-lateral cell) as a public model of the 4th Grand Challenge prints it; the order of the cells was "
        "not checked against a paper"
    ),
    cells=("PM", "AM", "AL", "PL"),
    medial=(0.9683, 0.9871, 0.0387, 0.0211),
    lateral=(0.0317, 0.0129, 0.9613, 0.9789),
)
"""What is taken unless another is given. Each cell's force is shared out whole: its two weights sum to 1."""


@dataclass(frozen=True)
class CompartmentForces:
    """Compressive force on each compartment of the tray [N]."""

    time: Float[np.ndarray, " t"]
    medial: Float[np.ndarray, " t"]
    lateral: Float[np.ndarray, " t"]

    @property
    def total(self) -> Float[np.ndarray, " t"]:
        """Both together [N]."""
        return np.asarray(self.medial + self.lateral)

    @property
    def curves(self) -> dict[str, Float[np.ndarray, " t"]]:
        """All three by name, in the order of tables and figures."""
        return {"medial": self.medial, "lateral": self.lateral, "total": self.total}


def compartment_forces(
    time: Float[np.ndarray, " t"], cells: Float[np.ndarray, "t c"], regression: CellRegression = PUBLISHED
) -> CompartmentForces:
    """Forces of the compartments from those of the cells [N], columns in the order of `regression.cells`."""
    return CompartmentForces(time, cells @ np.array(regression.medial), cells @ np.array(regression.lateral))
