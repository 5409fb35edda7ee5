"""Where a recording has lost samples, so that nothing is known of what lies between those that are left."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from jaxtyping import Bool, Float

from geocontact.identify.signals.cycles import Span
from geocontact.identify.signals.even_times import GAP

BRIDGED = 0.05
"""s; a straight line across less loses little of what a limb does: 4 % of a stride of 1.2 s."""


def gaps(time: Float[np.ndarray, " t"]) -> list[Span]:
    """Spans between samples that are farther apart than `GAP` usual steps and than `BRIDGED`, in their order."""
    steps = np.diff(time)
    if not len(steps):
        return []
    wide = np.flatnonzero(steps > max(GAP * float(np.median(steps)), BRIDGED))
    return [Span(float(time[k]), float(time[k + 1])) for k in wide]


def in_gaps(time: Float[np.ndarray, " n"], missing: Sequence[Span]) -> Bool[np.ndarray, " n"]:
    """Which times [s] lie inside one of the gaps, their ends not counted."""
    found = np.zeros(len(time), bool)
    for each in missing:
        found |= (time > each.start) & (time < each.end)
    return found


def broken(
    time: Float[np.ndarray, " t"], values: Float[np.ndarray, " t"]
) -> tuple[Float[np.ndarray, " b"], Float[np.ndarray, " b"]]:
    """The curve with a missing value (NaN) in the middle of each gap, as it is drawn."""
    missing = gaps(time)
    places = [int(np.searchsorted(time, each.end)) for each in missing]
    middles = [0.5 * (each.start + each.end) for each in missing]
    return np.insert(time, places, middles), np.insert(values, places, np.nan)
