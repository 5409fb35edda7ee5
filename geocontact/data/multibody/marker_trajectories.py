"""Recorded markers over time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation


@dataclass(frozen=True)
class MarkerTrajectories:
    """Where markers were.

    Parameters
    ----------
    time
        [s], strictly increasing.
    positions
        In the laboratory's frame [m]; NaN where a marker was not seen.
    names
        One for each marker.
    source
        The file, for messages and the record.
    """

    time: Float[np.ndarray, " t"]
    positions: Float[np.ndarray, "t m 3"]
    names: tuple[str, ...]
    source: str = ""

    def __len__(self) -> int:
        return len(self.time)

    def between(self, start: float, stop: float) -> MarkerTrajectories:
        """Frames from one time to another, both included to a millionth of a second."""
        kept = (self.time >= start - 1e-6) & (self.time <= stop + 1e-6)
        return MarkerTrajectories(self.time[kept], self.positions[kept], self.names, self.source)

    def turned(self, turn: Rotation) -> MarkerTrajectories:
        """The same in axes that this rotation turns those of the file into."""
        places = turn.apply(self.positions.reshape(-1, 3)).reshape(self.positions.shape)
        return MarkerTrajectories(self.time, places, self.names, self.source)

    def renamed(self, names: Mapping[str, str]) -> MarkerTrajectories:
        """The same with new names by old ones; ValueError where two markers would be called alike."""
        found = tuple(names.get(name, name) for name in self.names)
        twice = [name for name in found if found.count(name) > 1]
        if twice:
            raise ValueError(f"two markers would be called {twice[0]}")
        return MarkerTrajectories(self.time, self.positions, found, self.source)

    def of(self, names: tuple[str, ...]) -> Float[np.ndarray, "t n 3"]:
        """Positions of these markers in this order; NaN for a name that was not recorded."""
        found = np.full((len(self.time), len(names), 3), np.nan)
        for k, name in enumerate(names):
            if name in self.names:
                found[:, k] = self.positions[:, self.names.index(name)]
        return found
