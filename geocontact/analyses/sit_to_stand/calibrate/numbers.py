"""Every number of a calibration as it ran."""

from __future__ import annotations

from collections.abc import Sequence

from geocontact.analyses.sit_to_stand.numbers_table import sizes_of
from geocontact.standing_up.calibrated_phase import CalibratedPhase
from geocontact.standing_up.numbers_that_ran import (
    Ran,
    belief_numbers,
    model_numbers,
    parameter_numbers,
    search_numbers,
    size_numbers,
)
from geocontact.standing_up.trials import StandingTrial


def calibration_numbers(phases: Sequence[CalibratedPhase], trials: Sequence[StandingTrial]) -> list[Ran]:
    """Of the model once, of each phase what it sought, believed and weighed, and on which meshes."""
    rows = model_numbers(phases[-1].model)
    for one in phases:
        prefix = f"phase {one.name} "
        rows += parameter_numbers(one.phase.parameters, one.found.p, prefix, free=one.phase.free)
        rows += belief_numbers(one.phase, prefix) + size_numbers(sizes_of(one.phase), prefix)
        rows += search_numbers(one.found.motions, trials, prefix)
    return rows
