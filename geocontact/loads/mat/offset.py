"""What an unloaded mat reads: an offset of each cell, and its drift between two times without load."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

FEWEST = 3  # frames of a window


@dataclass(frozen=True, eq=False)
class Unloaded:
    """Reading of each cell without load, straight in time: offset + drift (t - middle).

    Parameters
    ----------
    offset
        At `middle` [Pa].
    drift
        [Pa/s]; 0 where there is one window only.
    middle
        [s].
    """

    offset: Float[np.ndarray, "r c"]
    drift: Float[np.ndarray, "r c"]
    middle: float

    def at(self, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t r c"]:
        """Readings without load [Pa]."""
        return np.asarray(self.offset + self.drift * (time - self.middle)[:, None, None])


def unloaded(
    time: Float[np.ndarray, " t"], pressure: Float[np.ndarray, "t r c"], windows: Sequence[tuple[float, float]]
) -> Unloaded:
    """Offset, and with two windows or more drift by least squares, from frames in `windows` [s]."""
    inside = np.zeros(len(time), bool)
    for first, last in windows:
        own = (time >= first) & (time <= last)
        if own.sum() < FEWEST:
            raise ValueError(f"{first:g} … {last:g} s holds {int(own.sum())} frames, at least {FEWEST} are needed")
        inside |= own
    middle = float(time[inside].mean())
    offset = pressure[inside].mean(axis=0)
    drift = np.zeros_like(offset)
    if len(windows) > 1:
        moment = time[inside] - middle
        drift = np.einsum("t,trc->rc", moment, pressure[inside] - offset) / float(moment @ moment)
    return Unloaded(offset, drift, middle)
