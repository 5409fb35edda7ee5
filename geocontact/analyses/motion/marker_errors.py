"""How far markers are from a model, and how far they may be.

Limits are those of OpenSim's documentation, "Checklist - Evaluating your simulation": in inverse kinematics root mean
squares below about 2 cm and a largest error below 4 cm; in scaling 1 cm and 2 cm.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geocontact.analyses.frame.collector import reserve
from geocontact.dynamics.inverse_kinematics import Poses

FAR = 0.05
"""m of root mean square that no subject has who stood model for it."""


@dataclass(frozen=True)
class MarkerLimits:
    """Largest root mean square and largest distance of markers from a model that are good enough [m]."""

    rms: float
    largest: float

    @property
    def words(self) -> str:
        """The two, in mm."""
        return f"{1e3 * self.rms:g} and {1e3 * self.largest:g} mm"


MOVING, STANDING = MarkerLimits(0.02, 0.04), MarkerLimits(0.01, 0.02)


@dataclass(frozen=True)
class MarkerErrors:
    """Distances of markers from a model over all frames and markers [m], and where the largest is [s]."""

    rms: float
    largest: float
    marker: str
    time: float

    @classmethod
    def of(cls, poses: Poses) -> MarkerErrors:
        """Errors of the markers that were seen and count."""
        frame, which = np.unravel_index(int(np.nanargmax(poses.distances)), poses.distances.shape)
        rms = float(np.sqrt(np.nanmean(poses.distances**2)))
        largest = float(poses.distances[frame, which])
        return cls(rms, largest, poses.markers[int(which)], float(poses.time[frame]))

    def within(self, limits: MarkerLimits) -> bool:
        """Whether they are good enough."""
        return self.rms <= limits.rms and self.largest <= limits.largest

    def words(self, limits: MarkerLimits) -> str:
        """The numbers in one clause."""
        return (
            f"{1e3 * self.rms:.1f} mm from the model, root mean square, and {1e3 * self.largest:.1f} mm at most, "
            f"{self.marker} at {self.time:.3g} s (OpenSim advises less than {limits.words})"
        )

    def warn(self, limits: MarkerLimits, why: str = "") -> None:
        """One line where they are beyond the limits; `why` is the cause that was found."""
        if self.within(limits):
            return
        check = f"check where {self.marker} is on the model and in the recording, the scaling, and exchanged markers"
        if self.rms > FAR:
            check = "another subject's size, axes (`axes`) or unit?"
        reserve(f"markers are {self.words(limits)}: {why or check}")
