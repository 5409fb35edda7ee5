"""Displacement over angle and one offset, the other being 0: the two surfaces of the explicit model's Fig. 5."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.axis_misalignment.explicit import Offsets, displacement

ANGLES = np.radians(np.arange(0.0, 136.0, 1.0))
SHARE = 0.6  # of the link: the largest offset that is shown
STEPS = 61


@dataclass(frozen=True, eq=False)
class Surfaces:
    """Total and linear displacement [m] over angles [rad] and offsets [m]."""

    l: float
    z: float
    angle: Float[np.ndarray, " a"]
    offset: Float[np.ndarray, " o"]
    over_x: Float[np.ndarray, "o a"]
    over_y: Float[np.ndarray, "o a"]
    linear_over_x: Float[np.ndarray, "o a"]
    linear_over_y: Float[np.ndarray, "o a"]

    def table(self) -> pd.DataFrame:
        """One row per angle and offset."""
        offset, angle = (grid.ravel() for grid in np.meshgrid(self.offset, self.angle, indexing="ij"))
        columns = {
            "beta [deg]": np.degrees(angle),
            "offset [mm]": offset * 1e3,
            "d_tot over x [mm]": self.over_x.ravel() * 1e3,
            "d_tot over y [mm]": self.over_y.ravel() * 1e3,
            "d_lin over x [mm]": self.linear_over_x.ravel() * 1e3,
            "d_lin over y [mm]": self.linear_over_y.ravel() * 1e3,
        }
        return pd.DataFrame(columns)


def surfaces(l: float, z: float) -> Surfaces:
    """Surfaces of a link and an offset of the attachment [m], offsets of either sign."""
    offset = SHARE * l * np.linspace(-1.0, 1.0, STEPS)
    over_x = [_row(Offsets(l, z, float(o), 0.0)) for o in offset]
    over_y = [_row(Offsets(l, z, 0.0, float(o))) for o in offset]
    totals = [np.array([total for total, _ in rows]) for rows in (over_x, over_y)]
    linear = [np.array([lin for _, lin in rows]) for rows in (over_x, over_y)]
    return Surfaces(l, z, ANGLES, offset, *totals, *linear)


def _row(offsets: Offsets) -> tuple[Float[np.ndarray, " a"], Float[np.ndarray, " a"]]:
    found = displacement(ANGLES, offsets)
    return found.total, found.linear
