"""Tables II and III of Serrancoli et al. (2019, IEEE Trans Neural Syst Rehabil Eng 27, 1597-1605), in their form.

A row for each variable and trial: joints are pooled as mean and standard deviation over them, and what a recording
varies by from trial to trial stands beside the model's error. The study calls an error small where it is less than the
largest standard deviation over its trials.

Deviations from the print: the divisor of a standard deviation is n - 1, which the study does not say; rates are beside
those of the recorded coordinates, whichever way the study of the user has them.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pandas as pd
from jaxtyping import Float

from geocontact.analyses.sit_to_stand.show import over_parts
from geocontact.analyses.sit_to_stand.trial_tables import StandingChannel, channels
from geocontact.standing_up.chain import JOINTS
from geocontact.standing_up.exoskeleton import EXO_JOINTS
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingNoise, StandingTrial

HINGES = (*JOINTS, *EXO_JOINTS)
VARIABLES: Mapping[str, tuple[str, ...]] = {
    "angles": HINGES,
    "angular velocities": tuple(f"{name} rate" for name in HINGES),
    "ground reaction along x": ("force_x",),
    "ground reaction along y": ("force_y",),
    "centre of pressure": ("centre",),
    "moments of the person": tuple(f"{name} torque" for name in JOINTS),
    "moments of the exoskeleton": tuple(f"{name} torque" for name in EXO_JOINTS),
    "strap at the pelvis": ("pelvis strap",),
    "strap at the thigh": ("strap",),
    "strap at the shank": ("shank strap",),
}
"""Channels that each variable of the tables pools."""
COLUMNS = ("variable", "unit", "trial", "mean", "sd over channels", "channels", "largest sd over trials")


def rmsd_by_trial(
    of: str, groups: Mapping[str, Sequence[TrialResult]], recorded: Sequence[StandingTrial], noise: StandingNoise
) -> pd.DataFrame:
    """Root mean square differences by variable and trial.

    Parameters
    ----------
    of
        What the groups are called, the first column: "phase", "predictor".
    groups
        Trials of each, with the model's channels.
    recorded
        Trials whose standard deviation over one another stands beside; NaN where there are fewer than two.

    Returns
    -------
    DataFrame
        `COLUMNS` after the group. Mean and standard deviation are over the channels of a variable that were recorded,
        the latter NaN for one; the last column is the largest over these channels and over parts of the movement.
    """
    rows = []
    for group, trials in groups.items():
        for variable, names in VARIABLES.items():
            for trial in trials:
                own = [each for each in _recorded(trial, noise) if each.name in names]
                if not own:
                    continue
                off = [each.factor * float(np.sqrt(np.mean((each.model - each.recorded) ** 2))) for each in own]
                sd = float(np.std(off, ddof=1)) if len(off) > 1 else np.nan
                varies = largest_sd([each.name for each in own], recorded, noise)
                told = (group, variable, own[0].unit, trial.recorded.name, float(np.mean(off)), sd, len(off), varies)
                rows.append(told)
    return pd.DataFrame(rows, columns=[of, *COLUMNS])


def largest_sd(names: Sequence[str], recorded: Sequence[StandingTrial], noise: StandingNoise) -> float:
    """Largest standard deviation over recorded trials at the same part of the movement, in the channels' unit."""
    courses: dict[str, list[Float[np.ndarray, " f"]]] = {name: [] for name in names}
    for each in recorded:
        for own in channels(each, each, noise):
            if own.name in courses and np.isfinite(own.recorded).all():
                courses[own.name].append(own.factor * over_parts(each.time, own.recorded))
    spread = [float(np.std(course, axis=0, ddof=1).max()) for course in courses.values() if len(course) > 1]
    return max(spread, default=np.nan)


def _recorded(trial: TrialResult, noise: StandingNoise) -> list[StandingChannel]:
    every = channels(trial.recorded, trial.model, noise)
    return [each for each in every if np.isfinite(each.recorded).all() and np.isfinite(each.model).all()]
