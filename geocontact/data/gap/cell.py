"""One cell of the map of a gap, and the axes that are frequencies."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

FAST = 5.0  # Hz, above which the map over the phase looks
BAND, FAST_PHASE = "band", "fast phase"
"""Axes of energies: frequency [Hz], and the phase of the trial for what is faster than `FAST`."""


@dataclass(frozen=True)
class Cell:
    """What a model misses of one channel in one part of an axis.

    Parameters
    ----------
    channel, axis, low, high
        Of an output, over "phase", an input, its rate, "load", "band" [Hz], or "fast phase", between these values, SI.
    gap
        Mean residual there [the channel's unit]; of an energy the root mean square.
    share
        Of the channel's squared gap along this axis, noise taken off: along an axis they add up to 1, or to 0.
    p_value
        Family-wise.
    ci95
        Of `share`.
    floor
        Part of the channel's squared residual along this axis that is no gap: with it (1 - floor) × shares make 1.
    """

    channel: str
    axis: str
    low: float
    high: float
    gap: float
    share: float
    p_value: float
    ci95: tuple[float, float]
    floor: float


def shares(parts: Float[np.ndarray, " b"]) -> Float[np.ndarray, " b"]:
    """Parts of their sum; 0 where there is nothing."""
    return np.asarray(parts / max(float(parts.sum()), 1e-300))
