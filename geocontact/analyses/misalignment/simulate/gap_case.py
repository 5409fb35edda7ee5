"""Synthetic recordings as a gap case of the base model `elbow`."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.gap.case import GapCase
from geocontact.data.motion import Signals
from geocontact.data.parameter import Parameter
from geocontact.data.trial import Trial

UNITS = {"beta": "deg"}
"""In which the trials are written, where that is not SI."""

CALIBRATED = 2.0 / 3.0  # of the trials
NEAR, STIFFER = 0.05, 4.0  # m, times: how far the bounds are from what was put in


def gap_case(trials: Sequence[ElbowRecording], numbers: Mapping[str, float]) -> GapCase:
    """Two thirds of the trials to fit to, the others held out; k, x, y free, l and z known.

    The base model has neither damping nor a stiffness that follows the pressure: where they were put in, they are
    what it lacks. The search begins at the numbers that were put in.
    """
    count = round(CALIBRATED * len(trials))
    made = tuple(_trial(each) for each in trials)
    k, offsets = numbers["k"], [(name, numbers[name]) for name in ("x", "y")]
    free = (
        Parameter("k", "N/m", k, k / STIFFER, k * STIFFER),
        *(Parameter(name, "m", value, value - NEAR, value + NEAR) for name, value in offsets),
    )
    known = {name: numbers[name] for name in ("l", "z")}
    return GapCase("elbow", "elbow", made[:count], made[count:], free, known)


def _trial(r: ElbowRecording) -> Trial:
    return Trial(r.name, Signals(r.time, np.column_stack([r.beta, r.force]), ("beta", "force"), ("rad", "N")))
