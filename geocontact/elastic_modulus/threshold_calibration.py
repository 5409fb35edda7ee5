"""The distance threshold with which computed areas are those of a table of areas over force."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.optimize import minimize_scalar

from geocontact.elastic_modulus.area_force import ThresholdAreas

GRID = 60  # thresholds tried before the search


@dataclass(frozen=True, eq=False)
class Calibration:
    """The threshold that fits an area-force table best.

    Parameters
    ----------
    threshold
        [m].
    rms
        Root mean square of the relative differences that remain.
    frames
        How many frames carried a force within the table's.
    on_end
        Whether it is the smallest or the largest threshold evaluated: the best one may be outside.
    """

    threshold: float
    rms: float
    frames: int
    on_end: bool


def calibrated(
    evolution: ThresholdAreas,
    frames: Float[np.ndarray, " n"],
    force: Float[np.ndarray, " n"],
    table_force: Float[np.ndarray, " m"],
    table_area: Float[np.ndarray, " m"],
) -> Calibration:
    """Threshold at which the areas at the frames come closest to the table's areas at the same force.

    The table [N], [m^2] is interpolated linearly at each measured force; frames with a force outside it do not count.
    A table of one row counts in the frames next to its force, on either side of each crossing.
    """
    order = np.argsort(table_force)
    wanted, there = _wanted(force, table_force[order], table_area[order])
    places = frames[there]

    def rms(threshold: float) -> float:
        area = np.interp(places, evolution.time, evolution.within(threshold))
        return float(np.sqrt(np.mean((area / wanted - 1.0) ** 2)))

    low, high = float(evolution.thresholds[0]), float(evolution.thresholds[-1])
    grid = np.linspace(low, high, GRID)
    k = int(np.argmin([rms(each) for each in grid]))
    around = (float(grid[max(k - 1, 0)]), float(grid[min(k + 1, GRID - 1)]))
    found = minimize_scalar(rms, bounds=around, method="bounded", options={"xatol": 1e-7})
    best = min((float(found.x), low, high), key=rms)
    edge = 1e-3 * (high - low)
    return Calibration(best, rms(best), int(there.sum()), best - low < edge or high - best < edge)


def _wanted(
    force: Float[np.ndarray, " n"], table_force: Float[np.ndarray, " m"], table_area: Float[np.ndarray, " m"]
) -> tuple[Float[np.ndarray, " w"], np.ndarray]:
    if len(table_force) > 1:
        there = (force >= table_force[0]) & (force <= table_force[-1])
    else:
        above = force >= table_force[0]
        crossed = np.flatnonzero(above[:-1] != above[1:])
        there = np.zeros(len(force), bool)
        there[crossed] = there[crossed + 1] = True
    if not there.any():
        raise ValueError(f"no frame carries a force between {table_force[0]:g} and {table_force[-1]:g} N")
    return np.interp(force[there], table_force, table_area), there
