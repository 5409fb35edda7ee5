"""Zero-lag Butterworth low-pass, as gait laboratories smooth what they record."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

ORDER = 2
"""Of the filter; run both ways it is of the fourth order (Winter, Biomechanics and Motor Control, 2009, sec. 3.4)."""
TWICE = (2.0**0.5 - 1.0) ** 0.25
"""Two passes of order two cut at their corner times this (Winter 2009, eq. 3.8)."""


def zero_lag(values: Float[np.ndarray, "t ..."], step: float, cutoff: float) -> Float[np.ndarray, "t ..."]:
    """Values, evenly spaced by `step` [s], without what lies above `cutoff` [Hz]; half the power passes there.

    ValueError where the cut-off is not below half the sampling frequency or the recording is too short to be filtered.
    """
    from scipy.signal import butter, sosfiltfilt

    corner = cutoff / TWICE
    if not 0.0 < corner < 0.5 / step:
        highest = 0.5 * TWICE / step
        raise ValueError(f"a cut-off of {cutoff:g} Hz needs to lie between 0 and {highest:.3g} Hz at {1 / step:.4g} Hz")
    sections = butter(ORDER, corner, fs=1.0 / step, output="sos")
    try:
        return np.asarray(sosfiltfilt(sections, values, axis=0))
    except ValueError as error:
        raise ValueError(f"{len(values)} samples are too few to be filtered") from error
