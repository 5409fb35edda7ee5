"""Cells of a pressure mat beside the channel that they add up to: where they lie, and what each read over a trial."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float


@dataclass(frozen=True, eq=False)
class CellTrial:
    """One trial: time [s], strictly increasing, and pressures [Pa]; NaN where a cell was not measured."""

    time: Float[np.ndarray, " t"]
    pressure: Float[np.ndarray, "t n"]


@dataclass(frozen=True, eq=False)
class CellChannels:
    """One site of a case.

    Parameters
    ----------
    channel
        Output that the cells are the parts of ("thigh_force").
    ids
        Names of the cells, as in the layout.
    place, area
        Middle of each cell in the scan's frame [m], and its area [m^2].
    trials
        By the trial's id; a trial without cells is not there.
    """

    channel: str
    ids: tuple[str, ...]
    place: Float[np.ndarray, "n 3"]
    area: Float[np.ndarray, " n"]
    trials: Mapping[str, CellTrial]

    def forces(self, trial: str, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t n"]:
        """Force of every cell [N] at other times of a trial, straight between frames; NaN outside of them."""
        own = self.trials[trial]
        columns = [np.interp(time, own.time, column, np.nan, np.nan) for column in own.pressure.T]
        return np.asarray(np.column_stack(columns) * self.area)
