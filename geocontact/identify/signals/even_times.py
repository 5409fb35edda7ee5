"""Curves on evenly spaced times, where a recording has lost samples or its clock was uneven."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

UNEVEN = 0.05
"""Of a step that a sample may be off without being moved."""
GAP = 1.5
"""Steps between samples beyond which nothing is said of what lies between them."""


def even_times(time: Float[np.ndarray, " t"]) -> tuple[Float[np.ndarray, " e"], float]:
    """Evenly spaced times over the same span and their step [s], the median one; `time` itself where it is even."""
    step = float(np.median(np.diff(time)))
    own = time[0] + step * np.arange(round((time[-1] - time[0]) / step) + 1)
    if len(own) == len(time) and np.abs(own - time).max() <= UNEVEN * step:
        return time, step
    return own[own <= time[-1] + 1e-9 * step], step


def at_times(
    time: Float[np.ndarray, " t"], curve: Float[np.ndarray, " t"], wanted: Float[np.ndarray, " e"], step: float
) -> Float[np.ndarray, " e"]:
    """The curve at other times, straight between samples; NaN inside of gaps longer than `GAP` steps."""
    if wanted is time:
        return curve
    after = np.clip(np.searchsorted(time, wanted), 1, len(time) - 1)
    wide = time[after] - time[after - 1] > GAP * step
    off = np.minimum(np.abs(wanted - time[after]), np.abs(wanted - time[after - 1]))
    return np.where(wide & (off > UNEVEN * step), np.nan, np.interp(wanted, time, curve))
