"""Tables of a design; lengths in mm, angles in degrees."""

from __future__ import annotations

import numpy as np
import pandas as pd

from geocontact.analyses.misalignment.design.designed import Designed
from geocontact.analyses.misalignment.planar_words import STATES
from geocontact.axis_misalignment.compensation import needed_ends

MM = 1e3
PER_SI = {"k": 1.0}
UNITS = {"k": "N/m"}


def map_table(d: Designed) -> pd.DataFrame:
    """Offsets of the map: largest |F|, deflection, the stroke each asks for; empty cells for a pole or a fold."""
    least, largest = d.map.extremes.T
    lower, upper = needed_ends(d.map.extremes, d.task.slack).T
    columns = {
        "x [mm]": d.map.offsets[:, 0] * MM,
        "y [mm]": d.map.offsets[:, 1] * MM,
        "peak_force [N]": d.map.peak,
        "admissible": np.where(d.map.peak <= d.task.limit, "yes", "no"),
        "least_deflection [mm]": least * MM,
        "largest_deflection [mm]": largest * MM,
        "lower_end_at_most [mm]": lower * MM,
        "upper_end_at_least [mm]": upper * MM,
        "stroke [mm]": np.maximum(upper - lower, 0.0) * MM,
        "state": [STATES[int(fate)] for fate in d.map.fate],
    }
    return pd.DataFrame(columns)


def boundary_table(d: Designed) -> pd.DataFrame:
    """Where the limit is first exceeded in each direction from the offsets."""
    b = d.boundary
    columns = {
        "direction [deg]": np.degrees(b.angles),
        "distance [mm]": b.distances * MM,
        "x [mm]": (d.offset[0] + b.distances * np.cos(b.angles)) * MM,
        "y [mm]": (d.offset[1] + b.distances * np.sin(b.angles)) * MM,
        "passed": np.where(b.distances < b.most, "yes", "no"),
    }
    return pd.DataFrame(columns)


def sensitivity_table(d: Designed) -> pd.DataFrame:
    """Slopes in N per N/m or per mm, and elasticities."""
    rows = [
        {
            "number": one.name,
            "unit": UNITS.get(one.name, "mm"),
            "value": one.value * PER_SI.get(one.name, MM),
            "peak_slope": one.peak_slope / PER_SI.get(one.name, MM),
            "rms_slope": one.rms_slope / PER_SI.get(one.name, MM),
            "peak_elasticity": one.peak_elasticity,
            "rms_elasticity": one.rms_elasticity,
        }
        for one in d.sensitivities
    ]
    return pd.DataFrame(rows)


def force_table(d: Designed) -> pd.DataFrame:
    """Force over the angle at the offsets, and the band of all offsets within the uncertainty."""
    columns = {
        "beta [deg]": np.degrees(d.beta),
        "force [N]": d.force,
        "lowest [N]": d.band[0],
        "highest [N]": d.band[1],
    }
    return pd.DataFrame(columns)
