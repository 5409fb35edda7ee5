"""Gaps of a recording filled up to a limit, then smoothed: what a motion needs before it drives a simulation."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.interpolate import PchipInterpolator

from geocontact.identify.signals.even_times import even_times
from geocontact.identify.signals.zero_lag import zero_lag


def filled_and_smoothed(
    time: Float[np.ndarray, " t"],
    values: Float[np.ndarray, "t n"],
    *,
    cutoff: float | None,
    longest_gap: float,
) -> tuple[Float[np.ndarray, " e"], Float[np.ndarray, "e n"]]:
    """Even times [s] and the columns there, without gaps, through a zero-lag low-pass.

    Gaps are bridged by monotone cubics (Fritsch & Carlson 1980, SIAM J Numer Anal 17, 238-246), which do not overshoot.

    Parameters
    ----------
    time
        [s], increasing.
    values
        NaN where a sample is missing; a row that is left out counts as well.
    cutoff
        Of the low-pass [Hz]; None leaves the values as they are.
    longest_gap
        Time between two samples of a column that is bridged [s]. ValueError names the first gap beyond it, and a
        column that begins late or ends early.
    """
    even, step = even_times(time)
    found = np.empty((len(even), values.shape[1]))
    for k, column in enumerate(values.T):
        there = np.isfinite(column)
        if there.sum() < 2:
            raise ValueError(f"column {k + 1} has {int(there.sum())} samples")
        known = time[there]
        wide = np.diff(np.concatenate([even[:1] - 1e-9, known, even[-1:] + 1e-9]))
        worst = int(np.argmax(wide))
        if wide[worst] > longest_gap + 1.5 * step:
            start = known[worst - 1] if worst else even[0]
            told = f"column {k + 1} has a gap of {wide[worst]:.3g} s after {start:.4g} s"
            raise ValueError(f"{told}; up to {longest_gap:g} s is bridged")
        curve = PchipInterpolator(known, column[there])
        found[:, k] = curve(np.clip(even, known[0], known[-1]))
    return even, found if cutoff is None else zero_lag(found, step, cutoff)
