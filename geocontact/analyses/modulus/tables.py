"""Tables of an identification: moduli, curves, the trial that was not used, and what E* depends on."""

from __future__ import annotations

import math

import numpy as np
import pandas as pd

from geocontact.analyses.modulus.identified import Identified
from geocontact.elastic_modulus.area_force import MODULUS
from geocontact.elastic_modulus.identify import agreement


def modulus_table(found: Identified) -> pd.DataFrame:
    """E* of each side with its 95 % interval by profile likelihood, E for each stated Poisson's ratio, and the fit."""
    rows: list[dict[str, object]] = []
    for side, each in found.sides.items():
        profile = each.profiles[MODULUS]
        rmse, r2 = agreement(each.measured, each.predicted)
        rows.append(
            {
                "side": side,
                "E_star [Pa]": each.modulus,
                "E_star_lower [Pa]": profile.lower,
                "E_star_upper [Pa]": profile.upper,
                **{f"E at nu {nu:g} [Pa]": each.modulus * (1.0 - nu**2) for nu in found.poisson},
                "rmse [N]": rmse,
                "r2 [-]": r2,
            }
        )
    return pd.DataFrame(rows)


def curve_table(found: Identified) -> pd.DataFrame:
    """Measured and predicted force at each frame that was used, sides one after another."""
    parts = []
    for side, pair in found.curves().items():
        columns = {"measured [N]": pair.measured, "predicted [N]": pair.predicted}
        parts.append(pd.DataFrame({"time [s]": pair.time, "side": side, **columns}))
    return pd.concat(parts, ignore_index=True)


def prediction_table(found: Identified) -> pd.DataFrame:
    """The trial that was not used; empty where its force is not known."""
    parts = []
    for p in found.predictions:
        columns = {"predicted [N]": p.predicted, "measured [N]": np.nan if p.measured is None else p.measured}
        parts.append(pd.DataFrame({"time [s]": p.time, "side": p.side, **columns}))
    return pd.concat(parts, ignore_index=True)


def sensitivity_table(found: Identified) -> pd.DataFrame:
    """E* by side, reading and threshold; empty where the reading sees no contact."""
    rows = [
        {
            "side": row.side,
            "reading": row.reading,
            "threshold [mm]": row.threshold * 1e3,
            "E_star [Pa]": row.modulus if math.isfinite(row.modulus) else np.nan,
            "rmse [N]": row.rmse,
            "r2 [-]": row.r2,
        }
        for row in found.sensitivity
    ]
    return pd.DataFrame(rows)
