"""Even grids of time."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def even_grid(time: Float[np.ndarray, " t"]) -> Float[np.ndarray, " n"]:
    """Evenly spaced times over a trial, about as many as there would be without missing rows."""
    steps = max(round((time[-1] - time[0]) / float(np.median(np.diff(time)))), 1)
    return np.linspace(time[0], time[-1], steps + 1)
