"""What is found of the loads on a foot."""

from __future__ import annotations

from dataclasses import dataclass

import pandas as pd

from geocontact.analyses.cop.force_plate import PlateCurves
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.cop.read import Foot
from geocontact.analyses.result import Result
from geocontact.loads.centre_of_pressure import CentreOfPressure
from geocontact.loads.sphere_loads import SphereLoads


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class FootLoads(Result):
    """Loads on a foot over its motion, in the frame of the ground.

    Parameters
    ----------
    foot
        Sole, law, motion and ground.
    loads
        Force of every sphere in every frame.
    centre
        Resultant, centre of pressure and free moment of every frame.
    plate, comparison
        What a force plate shows, and the differences to it; None without a plate.
    """

    options: CopOptions
    foot: Foot
    loads: SphereLoads
    centre: CentreOfPressure
    plate: PlateCurves | None
    comparison: pd.DataFrame | None
