"""What is found of the loads on a foot."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.cop.force_plate import PlateCurves
from geocontact.analyses.cop.options import CopOptions
from geocontact.analyses.cop.read import Foot
from geocontact.analyses.result import Result
from geocontact.loads.along_foot import FootAxis
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
    centres
        The centre of each of `loads.centre_of_pressure.POINTS`, `centre.centre` among them.
    axis
        From the heel to the toe; None where nobody said which way the toe is.
    zones
        Sum of the normal forces of each zone, filtered where the forces are.
    plate, comparison
        What a force plate shows, and the differences to it; None without a plate.
    """

    options: CopOptions
    foot: Foot
    loads: SphereLoads
    centre: CentreOfPressure
    centres: dict[str, Float[np.ndarray, "t 3"]]
    axis: FootAxis | None
    zones: dict[str, Float[np.ndarray, " t"]]
    plate: PlateCurves | None
    comparison: pd.DataFrame | None


def loads_table(r: FootLoads) -> pd.DataFrame:
    """Force, centre and free moment of every frame; centre and free moment are empty below the gate."""
    c = r.centre
    vectors = {
        f"{name}_{axis} [{unit}]": values[:, k]
        for name, unit, values in (("force", "N", c.wrench.force), ("cop", "m", c.centre))
        for k, axis in enumerate("xyz")
    }
    return pd.DataFrame(
        {
            "time [s]": r.foot.motion.time,
            **vectors,
            "free_moment [N m]": c.free_moment,
            "normal [N]": c.pressing,
            "spheres [-]": np.count_nonzero(r.loads.depth > 0.0, axis=1),
            "max_depth [m]": np.maximum(r.loads.depth.max(axis=1), 0.0),
        }
    )
