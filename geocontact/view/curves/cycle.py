"""Cutting a recording into cycles of 0 to 100 %."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
from jaxtyping import Float

from geocontact.identify.signals.cycles import normalised
from geocontact.view.curves.given import array, positions
from geocontact.view.curves.quantity import TIME


def cycles(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"], starts: Float[np.ndarray, " k"]
) -> Float[np.ndarray, "trials 101"]:
    """Each cycle at 0, 1, … 100 % of its own duration, interpolated linearly.

    Values between a missing sample (NaN) and its neighbours are missing. Filter before, not after: interpolation
    adds nothing to the signal, and peaks between two samples are cut.

    Parameters
    ----------
    time, values
        Recording, strictly increasing in time [s].
    starts
        Where cycles begin [s]; the last one ends the last cycle, so k starts make k - 1 cycles.
    """
    t, begins = positions(TIME, time), array("starts", starts, ("k",))
    y = array("values", values, (len(t),))
    if len(begins) < 2 or not (np.diff(begins) > 0.0).all():
        raise ValueError(f"starts: {begins}; expected two or more, increasing, the end of the last cycle included")
    if begins[0] < t[0] or begins[-1] > t[-1]:
        raise ValueError(f"starts: {begins[0]:g} to {begins[-1]:g} s, but the recording has {t[0]:g} to {t[-1]:g} s")
    return np.array([normalised(t, y, begin, end) for begin, end in pairwise(begins.tolist())])
