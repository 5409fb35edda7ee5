"""Four load cells under a tibial tray: forces of the compartments, and what the cells read of given ones.

The regression gives two forces from four cells, F_medial = Σ m_c N_c and F_lateral = Σ l_c N_c, so that two more
equations are needed. The tray is taken for a rigid beam on two rows of cells, one at x_anterior, one at x_posterior: on
each side the front cell carries the share s = (x - x_posterior)/(x_anterior - x_posterior) of that side's two cells, x
the centre of the side's patch (lever rule). With S_medial = N_PM + N_AM, S_lateral = N_PL + N_AL

    F_medial  = S_medial (m_PM (1 - s_m) + m_AM s_m) + S_lateral (m_PL (1 - s_l) + m_AL s_l),

F_lateral likewise with l: two equations for S_medial and S_lateral at each sample.

Assumed: the cells carry force along the tray's normal only, contact is normal to the tray, and the resultant of a side
acts at the area centroid of its patch. A patch in front of the front row makes the other row's share negative.
"""

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


CELLS = ("PM", "AM", "AL", "PL")
MEDIAL, LATERAL = ("PM", "AM"), ("PL", "AL")
"""Rear and front cell of each side."""


def cell_forces(
    sides: Float[np.ndarray, "t 2"],
    centre: Float[np.ndarray, "t 2"],
    rows: tuple[float, float],
    regression: CellRegression,
) -> Float[np.ndarray, "t 4"]:
    """Force of each cell [N], in the order of `CELLS`.

    Parameters
    ----------
    sides
        Medial and lateral force [N].
    centre
        x of the centre of each side's patch [m], anterior positive.
    rows
        x of the posterior and of the anterior row of cells [m].
    regression
        Weights of the cells in the forces of the sides.
    """
    posterior, anterior = rows
    front = (centre - posterior) / (anterior - posterior)
    weights = np.array([regression.medial, regression.lateral])
    place = {name: regression.cells.index(name) for name in CELLS}
    matrix = np.empty((len(sides), 2, 2))
    for column, (rear, fore) in enumerate((MEDIAL, LATERAL)):
        share = front[:, column, None]
        matrix[:, :, column] = weights[:, place[rear]] * (1.0 - share) + weights[:, place[fore]] * share
    sums = np.linalg.solve(matrix, sides[..., None])[..., 0]
    of = {}
    for column, (rear, fore) in enumerate((MEDIAL, LATERAL)):
        of[rear] = sums[:, column] * (1.0 - front[:, column])
        of[fore] = sums[:, column] * front[:, column]
    return np.column_stack([of[name] for name in CELLS])
