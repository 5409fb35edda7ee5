"""A mistake in the data undone in the data, and put back into what a model predicts.

Undone where it was made, noise and units are right again for all that follows; errors are then reported against what
was recorded, mistake and all, so that they compare with those of the base model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from jaxtyping import Float

from geocontact.chain.candidate import Candidate
from geocontact.data.gap.case import GapCase
from geocontact.data.trial import Trial
from geocontact.gap.data_errors.gross import DataError


def corrected(case: GapCase, data_error: DataError) -> GapCase:
    """The case as it would have been recorded without the mistake."""
    return replace(
        case,
        calibration=tuple(_corrected(trial, data_error) for trial in case.calibration),
        evaluation=tuple(_corrected(trial, data_error) for trial in case.evaluation),
    )


def mistaken(trial: Trial, one: Candidate) -> Trial:
    """A trial with a mistake in its data made."""
    return _times(trial, one, one.factor)


def _corrected(trial: Trial, data_error: DataError) -> Trial:
    one = data_error.candidate
    return _times(trial, one, 1.0 / one.factor) if trial.name in data_error.trials else trial


def _times(trial: Trial, one: Candidate, factor: float) -> Trial:
    """The channel of the mistake times a factor, or its two channels exchanged."""
    channels = trial.signals.channels
    values = trial.signals.values.copy()
    if one.channel:
        values[:, channels.index(one.channel)] *= factor
    else:
        a, b = exchanged(one.variant, channels)
        values[:, [a, b]] = values[:, [b, a]]
    return replace(trial, signals=replace(trial.signals, values=values))


def exchanged(variant: str, channels: Sequence[str]) -> tuple[int, int]:
    """Places of the two channels that a swap is about."""
    return next(
        (i, j) for i, a in enumerate(channels) for j, b in enumerate(channels) if i != j and variant == f"{a}_{b}"
    )


def put_back(
    data_error: DataError | None, trial: str, outputs: Sequence[str], columns: Float[np.ndarray, "t c *p"]
) -> Float[np.ndarray, "t c *p"]:
    """Residuals, or derivatives of predictions, as they are of what was recorded."""
    if data_error is None or trial not in data_error.trials:
        return columns
    one = data_error.candidate
    if one.channel and one.channel not in outputs:
        return columns
    out = columns.copy()
    if one.channel:
        out[:, list(outputs).index(one.channel)] *= one.factor
    else:
        a, b = exchanged(one.variant, outputs)
        out[:, [a, b]] = columns[:, [b, a]]
    return out
