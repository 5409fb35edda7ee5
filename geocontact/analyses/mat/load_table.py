"""A load over time as a table."""

from __future__ import annotations

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.loads.mat.load import MatLoad

MM, MM2 = 1e3, 1e6
AXES = "xyz"


def load_table(load: MatLoad, time: Float[np.ndarray, " t"]) -> pd.DataFrame:
    """Wrench, pressing, area, pressures and centre of every frame; the centre is empty below the gate."""
    force, moment, centre = load.wrench.force, load.wrench.moment, load.centre * MM
    return pd.DataFrame(
        {
            "time [s]": time,
            **{f"f{axis} [N]": force[:, k] for k, axis in enumerate(AXES)},
            **{f"m{axis} [N m]": moment[:, k] for k, axis in enumerate(AXES)},
            "normal [N]": load.pressing,
            "perpendicular [N]": load.perpendicular,
            "area [mm^2]": load.area * MM2,
            "peak [Pa]": load.peak,
            "mean [Pa]": load.mean,
            **{f"cop_{axis} [mm]": centre[:, k] for k, axis in enumerate(AXES)},
        }
    )
