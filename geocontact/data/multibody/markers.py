"""Recorded markers over time, and how much each marker and coordinate counts in inverse kinematics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation


@dataclass(frozen=True, eq=False)
class Followed:
    """A recording of a coordinate that inverse kinematics keeps near.

    Parameters
    ----------
    time
        [s].
    values
        [rad, m].
    """

    time: Float[np.ndarray, " n"]
    values: Float[np.ndarray, " n"]

    def at(self, time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " t"]:
        """By a cubic spline; ValueError beyond the ends."""
        from scipy.interpolate import CubicSpline

        first, last = self.time[0] - 1e-6, self.time[-1] + 1e-6
        if time.min() < first or time.max() > last:
            raise ValueError(f"runs from {self.time[0]:g} to {self.time[-1]:g} s, markers to {time.max():g} s")

        return np.asarray(CubicSpline(self.time, self.values)(time))


@dataclass(frozen=True)
class MarkerTasks:
    """Weights.

    Parameters
    ----------
    markers
        Of squared distances, by name [1/m^2, up to a common factor]; a marker that is not named does not count.
    coordinates
        Of squared deviations by name [m^2/rad^2 or 1], beside the markers' weighted mean square as OpenSim has it, and
        the value wanted [rad, m]; None for the coordinate's default.
    from_file
        Weights of coordinates that are to be near those of a recording.
    followed
        That recording, by coordinate.
    """

    markers: Mapping[str, float]
    coordinates: Mapping[str, tuple[float, float | None]] = field(default_factory=dict)
    from_file: Mapping[str, float] = field(default_factory=dict)
    followed: Mapping[str, Followed] = field(default_factory=dict)

    def held(self, names: Sequence[str]) -> Float[np.ndarray, " n"]:
        """Weight of each coordinate; 0 where nothing is wanted of it."""
        fixed = {name: weight for name, (weight, _) in self.coordinates.items()}
        return np.array([self.from_file.get(name, fixed.get(name, 0.0)) for name in names])

    def wanted(self, defaults: Mapping[str, float], time: Float[np.ndarray, " t"]) -> Float[np.ndarray, "t n"]:
        """Value wanted of each coordinate at these times [rad, m]; its default where nothing else is."""
        fixed = {name: value for name, (_, value) in self.coordinates.items() if value is not None}
        found = np.tile([fixed.get(name, default) for name, default in defaults.items()], (len(time), 1))
        for k, name in enumerate(defaults):
            if name in self.from_file:
                found[:, k] = self.followed[name].at(time)
        return found


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
