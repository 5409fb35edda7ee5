"""Zero-lag Butterworth low-pass, as gait laboratories smooth what they record."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

ORDER = 2
"""Of the filter; run both ways it is of the fourth order (Winter, Biomechanics and Motor Control, 2009, sec. 3.4)."""
TWICE = (2.0**0.5 - 1.0) ** 0.25
"""Tangent of the cut-off of two passes of order two over that of each (Winter 2009, sec. 3.4.4.2)."""
OPENSIM = 3
"""Order of OpenSim's filter, which runs both ways with the cut-off of one pass (Storage::lowpassIIR, 4.6)."""


def zero_lag(values: Float[np.ndarray, "t ..."], step: float, cutoff: float) -> Float[np.ndarray, "t ..."]:
    """Values, evenly spaced by `step` [s], without what lies above `cutoff` [Hz]; half the power passes there.

    ValueError where the cut-off is not below half the sampling frequency or the recording is too short to be filtered.
    """
    _check(step, cutoff)
    corner = float(np.arctan(np.tan(np.pi * cutoff * step) / TWICE)) / (np.pi * step)
    return _both_ways(values, step, corner, ORDER)


def as_opensim(values: Float[np.ndarray, "t ..."], step: float, cutoff: float) -> Float[np.ndarray, "t ..."]:
    """The same by OpenSim's filter: a quarter of the power passes at `cutoff`. Ends are mirrored over half the length.

    OpenSim starts from nothing beyond the mirrored ends, this filter from where it would have settled.
    """
    _check(step, cutoff)
    return _both_ways(values, step, cutoff, OPENSIM, len(values) // 2)


def _check(step: float, cutoff: float) -> None:
    if not 0.0 < cutoff < 0.5 / step:
        raise ValueError(f"a cut-off of {cutoff:g} Hz needs to lie between 0 and {0.5 / step:.3g} Hz")


def _both_ways(
    values: Float[np.ndarray, "t ..."], step: float, corner: float, order: int, mirrored: int | None = None
) -> Float[np.ndarray, "t ..."]:
    from scipy.signal import butter, sosfiltfilt

    sections = butter(order, corner, fs=1.0 / step, output="sos")
    try:
        return np.asarray(sosfiltfilt(sections, values, axis=0, padlen=mirrored))
    except ValueError as error:
        raise ValueError(f"{len(values)} samples are too few to be filtered") from error
