"""What an axis shows: its name, its unit, and how SI values become numbers in that unit."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.view.curves.text import plain

WRAP = 32  # letters on a line of a label, which the height of a small figure has room for


@dataclass(frozen=True)
class Quantity:
    """Name and unit of an axis; `dataclasses.replace(AREA, name="medial contact area")` renames one.

    Parameters
    ----------
    name, unit
        As printed: "contact area [mm²]".
    per_si
        How many of `unit` one SI unit is: 1e6 for areas in mm².
    """

    name: str
    unit: str
    per_si: float = 1.0

    @property
    def label(self) -> str:
        """Label of an axis, on several lines if it is long."""
        return plain(f"{self.name} [{self.unit}]", WRAP)

    def shown(self, values: Float[np.ndarray, "*shape"]) -> Float[np.ndarray, "*shape"]:
        """SI values as numbers in `unit`."""
        return np.asarray(values * self.per_si)


AREA = Quantity("contact area", "mm²", 1e6)
LENGTH = Quantity("distance", "mm", 1e3)
FORCE = Quantity("contact force", "N")
MOMENT = Quantity("moment", "N m")
PRESSURE = Quantity("contact pressure", "MPa", 1e-6)
ANGLE = Quantity("angle", "°", 180.0 / np.pi)
TIME = Quantity("time", "s")
CYCLE = Quantity("cycle", "%")  # positions in a cycle are percentages throughout, as in Motion.time of unit "%"
