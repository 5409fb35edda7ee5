"""On what outcomes of the present foot hang, in the units that are shown."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from geocontact.below_knee_prosthesis.design.knob import AIMS
from geocontact.below_knee_prosthesis.design.outcomes import MEASURES
from geocontact.below_knee_prosthesis.design.sensitivities import FootSensitivity, Unit

STEPS: dict[Unit, tuple[float, str]] = {
    "m": (1e3, "mm"),
    "rad": (float(np.degrees(1.0)), "deg"),
    "-": (1.0, "-"),
    "factor": (1.0, "factor"),
}


def sensitivities_table(found: Sequence[FootSensitivity]) -> pd.DataFrame:
    """Long: one row for each number, response and outcome."""
    rows = []
    for each in found:
        factor, shown = STEPS[each.unit]
        for response, change in each.change.items():
            for aim, value in zip(AIMS, change, strict=True):
                row: dict[str, object] = {"number": each.name, "by": factor * each.by, "in": shown}
                row |= {"response": response, "outcome": aim, "unit": MEASURES[aim].unit, "change": float(value)}
                rows.append(row)
    return pd.DataFrame(rows)
