"""Several feet, each pressed against its ground to a depth: the load that each bears, and where it acts.

`FootMap` read the other way round. Between its rows of pitch heights are linear, and so they are between its loads, so
that the load of a height is exact; beyond the last load of a row the foot is as stiff as before it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.below_knee_prosthesis.design.foot_map import PLACES, FootMap


@dataclass(frozen=True, eq=False)
class FeetOnGround:
    """Maps with the same rows.

    Parameters
    ----------
    pitch, load
        Of the rows [rad, N].
    table
        Height, centre of pressure along x and y [m] of each foot.
    """

    pitch: Float[np.ndarray, " p"]
    load: Float[np.ndarray, " l"]
    table: Float[np.ndarray, "n p l c"]

    def height(self, pitch: Float[np.ndarray, " n"], load: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
        """At which each foot bears a load [m]."""
        rows = self._rows(pitch)[..., 0]
        at = np.clip(np.searchsorted(self.load, load) - 1, 0, len(self.load) - 2)
        return _between(rows, at, (load - self.load[at]) / self.load[1])

    def borne(
        self, pitch: Float[np.ndarray, " n"], height: Float[np.ndarray, " n"]
    ) -> tuple[Float[np.ndarray, " n"], Float[np.ndarray, "n 2"]]:
        """Load [N], 0 above the ground, and centre of pressure in each keel's frame [m]."""
        rows = self._rows(pitch)
        at = np.clip((rows[..., 0] >= height[:, None]).sum(axis=1) - 1, 0, len(self.load) - 2)
        n = np.arange(len(at))
        first, second = rows[n, at], rows[n, at + 1]
        fall = np.maximum(first[:, 0] - second[:, 0], LEAST)
        share = np.maximum((first[:, 0] - height) / fall, 0.0)
        inside = np.minimum(share, 1.0)[:, None]
        return (at + share) * self.load[1], first[:, 1:] + inside * (second - first)[:, 1:]

    def _rows(self, pitch: Float[np.ndarray, " n"]) -> Float[np.ndarray, "n l c"]:
        step = self.pitch[1] - self.pitch[0]
        place = np.clip((pitch - self.pitch[0]) / step, 0.0, len(self.pitch) - 1.0)
        at = np.minimum(place.astype(int), len(self.pitch) - 2)
        n, share = np.arange(len(at)), (place - at)[:, None, None]
        return np.asarray((1.0 - share) * self.table[n, at] + share * self.table[n, at + 1])


LEAST = 1e-9
"""m; by which a foot sinks from one row of loads to the next, at least."""


def feet_on_ground(maps: Sequence[FootMap]) -> FeetOnGround:
    """Of maps whose rows are the same; ValueError for others."""
    first = maps[0]
    if any(each.pitch is not first.pitch and not np.array_equal(each.pitch, first.pitch) for each in maps):
        raise ValueError("the maps have other rows")
    return FeetOnGround(first.pitch, first.load, np.stack([each.table[..., :PLACES] for each in maps]))


def _between(rows: Float[np.ndarray, "n l"], at: np.ndarray, share: Float[np.ndarray, " n"]) -> Float[np.ndarray, " n"]:
    n = np.arange(len(at))
    return np.asarray(rows[n, at] + share * (rows[n, at + 1] - rows[n, at]))
