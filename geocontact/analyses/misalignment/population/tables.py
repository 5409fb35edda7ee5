"""Tables of a population; lengths in mm, stiffness in N/m."""

from __future__ import annotations

import numpy as np
import pandas as pd

from geocontact.analyses.misalignment.planar_words import STATES
from geocontact.analyses.misalignment.population.drawn import Drawn
from geocontact.axis_misalignment.population import QUANTITIES
from geocontact.identify.intervals.sobol_indices import Indices

SHOWN = {name: ("N/m", 1.0) if name == "k" else ("mm", 1e3) for name in QUANTITIES}
"""Unit of each quantity, and how many of it one SI unit is."""


def quantile_table(d: Drawn) -> pd.DataFrame:
    """Quantiles with their Monte Carlo interval of 95 %; `inf` where samples without a force reach that far."""
    rows = [
        {"share [-]": share, "peak_force [N]": one.value, "lower [N]": one.lower, "upper [N]": one.upper}
        for share, one in d.quantiles.items()
    ]
    return pd.DataFrame(rows)


def exceedance_table(d: Drawn) -> pd.DataFrame:
    """Probability that the largest |F| is above a force, with exact intervals of 95 %."""
    columns = {
        "force [N]": d.levels,
        "probability [-]": [one.value for one in d.exceedance],
        "lower [-]": [one.lower for one in d.exceedance],
        "upper [-]": [one.upper for one in d.exceedance],
    }
    return pd.DataFrame(columns)


def influence_table(d: Drawn) -> pd.DataFrame:
    """Coefficient of each quantity's rank, and the shares of the variance of the factor that it belongs to."""
    rows = []
    factors = [k for k, factor in enumerate(d.sampling.factors) for _ in factor.names]
    r = d.regression
    for name, k, own, far in zip(d.varying, factors, r.coefficients, r.of_distance, strict=True):
        row: dict[str, object] = {
            "quantity": name,
            "factor": " and ".join(d.sampling.factors[k].names),
            "rank_coefficient": float(own),
            "distance_rank_coefficient": float(far),
        }
        rows.append(row | _shares(d.indices, k))
    return pd.DataFrame(rows)


def _shares(indices: Indices | None, k: int) -> dict[str, float]:
    """First-order and total share of one factor with their intervals; NaN where there are none."""
    told: dict[str, float] = {}
    for kind in ("first", "total"):
        values = (np.nan, np.nan, np.nan)
        if indices is not None:
            lower, upper = getattr(indices, f"{kind}_interval")[k]
            values = (float(getattr(indices, kind)[k]), float(lower), float(upper))
        told |= dict(zip((f"sobol_{kind}", f"sobol_{kind}_lower", f"sobol_{kind}_upper"), values, strict=True))
    return told


def sample_table(d: Drawn) -> pd.DataFrame:
    """Every sample."""
    columns: dict[str, object] = {
        f"{name} [{unit}]": d.people[:, k] * per_si for k, (name, (unit, per_si)) in enumerate(SHOWN.items())
    }
    return pd.DataFrame({**columns, "peak_force [N]": d.peak, "state": [STATES[int(fate)] for fate in d.fate]})
