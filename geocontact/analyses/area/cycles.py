"""Areas over gait cycles, and forces where there are some, by style."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Float

from geocontact.analyses.area.contact import MotionResult
from geocontact.analyses.frame.collector import note, say
from geocontact.analyses.frame.words import counted
from geocontact.analyses.motion.styles import Cutting, Trials, shifts_between, together
from geocontact.data.errors import InputError
from geocontact.data.evolution import MM2


def area_trials(cutting: Cutting, motions: Sequence[MotionResult], stems: Sequence[str]) -> Trials:
    """Every quantity over each cycle of the motions, whose files have these names; what is to be said of them."""
    parts = []
    for one, stem in zip(motions, stems, strict=True):
        if one.motion.time_unit != "s":
            raise InputError(stem, "`events`", "time is in per cent of a cycle", "leave it out: it is cut already")
        parts.append(cutting.trials_of(stem, one.motion.time, _quantities(one)))
    trials = together(parts)
    first = next(iter(trials.values()))
    note("cycles", {style: len(rows) for style, rows in first.items()})
    say(", ".join(f"{counted(len(rows), 'cycle')} of {style}" for style, rows in first.items()))
    for row in shifts_between(trials).to_dict(orient="records"):
        if row["quantity"].startswith("area_fixed at"):
            swing, later = row["peak_to_peak_difference"], row["later [%]"]
            say(
                f"{row['style']} against {row['reference']}, {row['quantity']}: RMSE {row['rmse']:.1f} mm^2, "
                f"swing {swing:+.1f} mm^2, {later:+.1f} % later"
            )
    return trials


def _quantities(one: MotionResult) -> dict[str, Float[np.ndarray, " t"]]:
    """Columns over time by name with unit."""
    e = one.evolution
    found = {}
    for k, threshold in enumerate(e.thresholds):
        at = f"at {threshold * 1e3:g} mm [mm^2]"
        found[f"area_fixed {at}"] = e.fixed.area[:, k] * MM2
        if e.medial_side:
            found[f"area_fixed_medial {at}"] = e.medial[:, k] * MM2
            found[f"area_fixed_lateral {at}"] = e.lateral[:, k] * MM2
    found["min_distance [mm]"] = e.min_distance * 1e3
    if one.pressure is not None:
        for side, loads in one.pressure.sides.items():
            found[f"force_{side} [N]"] = np.array([load.pressing for load in loads])
            found[f"pressed_area_{side} [mm^2]"] = np.array([load.area for load in loads]) * MM2
    return found
