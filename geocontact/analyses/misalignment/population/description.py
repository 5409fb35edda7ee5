"""A population as `population.json` holds it."""

from __future__ import annotations

import math
from typing import Any

from geocontact.analyses.misalignment.planar_words import STATES, WITHOUT_FORCE, rounded
from geocontact.analyses.misalignment.population.drawn import Drawn
from geocontact.analyses.misalignment.population.tables import influence_table
from geocontact.identify.intervals.quantile_intervals import IntervalEstimate


def described(d: Drawn) -> dict[str, Any]:
    """What was asked for and found, with units in the keys; None stands for infinite and for what is not known."""
    content: dict[str, Any] = {
        "samples": len(d.peak),
        "synthetic": True,
        "limit_N": d.limit,
        "range_deg": [math.degrees(d.exposure.start), math.degrees(d.exposure.stop)],
        "stroke_mm": [d.exposure.lower * 1e3, d.exposure.upper * 1e3],
        "above_limit": _estimate(d.beyond),
        "without_a_force": {STATES[fate]: int((d.fate == fate).sum()) for fate in WITHOUT_FORCE},
        "quantiles_N": {f"{share:g}": _estimate(one) for share, one in d.quantiles.items()},
        "grid_error_N": d.grid_error,
        "influence": influence_table(d).to_dict(orient="records"),
        "rank_regression_explains": d.regression.explained,
    }
    told: dict[str, Any] = rounded(content)
    return told


def _estimate(one: IntervalEstimate) -> dict[str, float]:
    return {"value": one.value, "lower": one.lower, "upper": one.upper}
