"""What one motion of two bodies is found to give."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from geocontact.analyses.area.congruence.along import CongruenceEvolution
from geocontact.analyses.area.pose_error.along import AreaUncertainty
from geocontact.analyses.area.pressure.along import PressureEvolution
from geocontact.data.evolution import AreaEvolution
from geocontact.data.motion import Motion
from geocontact.geometry.contact_area.maps import DistanceMaps


@dataclass(frozen=True, eq=False)
class MotionResult:
    """Contact of two bodies over one motion.

    Parameters
    ----------
    name
        Of its sub-folder; empty when there is one motion.
    motion
        Poses of MOVING in FIXED.
    evolution
        Areas, bounds and separation of every frame.
    maps
        Distances of the vertices in some frames; in all of them with `save_map`.
    pressure
        Loads of every frame; None unless `pressure` was asked for.
    comparison
        Differences to measured areas; None unless `compare` names some.
    uncertainty
        Error of the poses carried into FIXED's area; None unless one was given.
    congruence
        How alike the surfaces are curved in contact; None unless asked for.
    reservations
        What is to be doubted about this motion, each one line.
    """

    name: str
    motion: Motion
    evolution: AreaEvolution
    maps: DistanceMaps
    pressure: PressureEvolution | None
    comparison: pd.DataFrame | None
    uncertainty: AreaUncertainty | None
    congruence: CongruenceEvolution | None
    reservations: tuple[str, ...]
