"""How much each marker and coordinate counts in inverse kinematics."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field


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
    """

    markers: Mapping[str, float]
    coordinates: Mapping[str, tuple[float, float | None]] = field(default_factory=dict)
