"""Tables of what trials tell of the parameters."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import pandas as pd

from geocontact.analyses.sit_to_stand.standing_tables import certificate_rows
from geocontact.standing_up.calibrated_phase import CalibratedPhase
from geocontact.standing_up.contact_numbers import ContactNumber
from geocontact.standing_up.feet import FOOT_PARAMETERS


def parameters_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """Value and interval in SI, and standard deviations of what is searched: lengths in m, others as logarithms."""
    rows = [
        {
            "phase": phase.name,
            "parameter": n.name,
            "unit": n.unit,
            "value": n.value,
            "lower": n.lower,
            "upper": n.upper,
            "sd believed": n.before,
            "sd with the trials": n.after if np.isfinite(n.after) else np.nan,
            "sd of what is assumed": n.assumed,
            "verdict": n.verdict,
        }
        for phase in phases
        for n in _own(phase)
    ]
    return pd.DataFrame(rows)


def _own(phase: CalibratedPhase) -> list[ContactNumber]:
    """Of the feet in phase A, of the strap in phase B."""
    feet = {each.name for each in FOOT_PARAMETERS}
    return [n for n in phase.numbers.numbers if (n.name in feet) == (phase.name == "A")]


def correlation_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """Of the estimates of the parameters that were sought, phase by phase."""
    parts = []
    for phase in phases:
        n = phase.numbers
        columns = {name: n.correlation[:, k] for k, name in enumerate(n.names)}
        parts.append(pd.DataFrame({"phase": phase.name, "parameter": list(n.names), **columns}))
    return pd.concat(parts, ignore_index=True)


def profile_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """Rise of minus twice the log posterior where a parameter is held beside its best; 3.84 ends 95 %."""
    parts = [
        pd.DataFrame(
            {
                "phase": phase.name,
                "parameter": each.name,
                "unit": each.unit,
                "distance in sd [-]": each.distance,
                "value": each.places,
                "rise [-]": each.rise,
            }
        )
        for phase in phases
        for each in phase.profiles
    ]
    return pd.concat(parts, ignore_index=True) if parts else pd.DataFrame()


def certificate_table(phases: Sequence[CalibratedPhase]) -> pd.DataFrame:
    """Of the motions of all phases."""
    rows = []
    for phase in phases:
        rows += certificate_rows(phase.name, [motion.name for motion in phase.found.motions], phase.motions)
    return pd.DataFrame(rows)
