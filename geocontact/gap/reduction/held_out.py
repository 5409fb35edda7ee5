"""Held-out trials with the predictions that the errors of a diagnosis are of."""

from __future__ import annotations

import numpy as np

from geocontact.data.gap.held_out import HeldOut
from geocontact.gap.case.problem import Problem
from geocontact.gap.reduction.raw_input_errors import RawInputErrors


def held_out(problem: Problem, errors: RawInputErrors, named: bool) -> tuple[HeldOut, ...]:
    """Every held-out trial of the case as it came, by name; without predictions of the answer where nothing is named.

    Parameters
    ----------
    errors
        Of base model and answer (`raw_input_errors.raw_input_errors`).
    """
    trials = []
    for k in range(len(problem.calibration.trials), len(problem.recorded.trials)):
        trial, measured = problem.recorded.trials[k], problem.recorded.outputs[k]
        there = np.isfinite(measured)
        base, after = (np.where(there, measured - part[k], np.nan) for part in (errors.before, errors.after))
        trials.append(HeldOut(trial.name, trial.time, measured, base, after if named else None))
    return tuple(sorted(trials, key=lambda trial: trial.name))
