"""Errors of a simulated channel over a whole trial, over the work and in each phase."""

from __future__ import annotations

from itertools import groupby

import numpy as np
from jaxtyping import Bool, Float

from geocontact.identify.signals.agreement import Agreement, agreement, over_stretches
from geocontact.shoulder_exoskeleton.work_phases import PHASES

ALL, WORK = "all", "work"
"""The whole trial; from the beginning of lifting to the end of lowering, as the study of the exoskeleton takes it."""


def phase_errors(
    model: Float[np.ndarray, " t"],
    measured: Float[np.ndarray, " t"],
    step: float,
    phase: np.ndarray,
    inside: Bool[np.ndarray, " t"],
) -> dict[str, Agreement]:
    """Agreement by part: `ALL`, `WORK`, and each phase that there is.

    Parameters
    ----------
    step
        Between samples [s].
    phase
        Word of each sample, of `PHASES`.
    inside
        Samples that were recorded.
    """
    parts = {ALL: inside, WORK: inside & (phase != PHASES[0])} | {name: inside & (phase == name) for name in PHASES[1:]}
    return {name: _agreement(model, measured, step, part) for name, part in parts.items() if part.any()}


def _agreement(model: np.ndarray, measured: np.ndarray, step: float, part: Bool[np.ndarray, " t"]) -> Agreement:
    if part.all():
        return agreement(model, measured, step)
    runs = [[i for i, _ in group] for inside, group in groupby(enumerate(part), lambda pair: bool(pair[1])) if inside]
    return over_stretches(model, measured, step, [(run[0], run[-1] + 1) for run in runs])
