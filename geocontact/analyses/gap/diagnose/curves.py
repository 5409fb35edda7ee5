"""Held-out trials at other phases than their own, as figures and page show them."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.data.gap.held_out import HeldOut


def resampled(
    trial: HeldOut, values: Float[np.ndarray, "t c"], phase: Float[np.ndarray, " p"]
) -> Float[np.ndarray, "p c"]:
    """Columns of a trial at other phases, by linear interpolation; NaN next to what is not there."""
    return np.stack([np.interp(phase, trial.phase, column) for column in values.T], axis=1)
