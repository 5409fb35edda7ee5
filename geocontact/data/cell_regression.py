"""How the cells of an instrumented implant make up the forces of its compartments."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class CellRegression:
    """Medial and lateral force as weighted sums of the cells' forces.

    Parameters
    ----------
    name, source
        What it is called, and where its numbers are from.
    cells
        Names of the cells, which are names of columns.
    medial, lateral
        Weight of each cell in that compartment's force [-].
    """

    name: str
    source: str
    cells: tuple[str, ...]
    medial: tuple[float, ...]
    lateral: tuple[float, ...]

    def __post_init__(self) -> None:
        count = len(self.cells)
        if count == 0 or len(self.medial) != count or len(self.lateral) != count:
            raise ValueError(f"{count} cells, {len(self.medial)} medial and {len(self.lateral)} lateral weights")
        if len(set(self.cells)) < count:
            raise ValueError("a cell occurs twice")
        if not all(map(math.isfinite, (*self.medial, *self.lateral))):
            raise ValueError("weights must be finite numbers")

    @property
    def shares(self) -> dict[str, float]:
        """How much of each cell's force arrives in both compartments together: 1 where none is lost or doubled."""
        return {c: m + k for c, m, k in zip(self.cells, self.medial, self.lateral, strict=True)}
