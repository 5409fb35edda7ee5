"""How much each marker and coordinate counts in inverse kinematics."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float
from scipy.interpolate import CubicSpline


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
