"""Cycles of a walk: heel strikes where the loads of feet set in, and curves cut at them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.sides import stem_and_side
from geocontact.data.wrench import Wrench
from geocontact.identify.signals.cycles import STEPS, cut, strides

Strikes = dict[str, Float[np.ndarray, " k"]]
"""Times [s], increasing, by side: "right", "left"."""


def strikes_on_plates(
    time: Float[np.ndarray, " t"], loads: Mapping[str, Wrench], up: Float[np.ndarray, " 3"], onset: float
) -> Strikes:
    """Where the load of the bodies of one side sets in; a foot that stands on a plate at the start has no strike.

    Parameters
    ----------
    time
        [s], increasing.
    loads
        Forces on bodies, (t, 3) each [N], in one frame. Those whose name says no side do not count, those of one side
        add up.
    up
        Unit vector upwards in that frame.
    onset
        Force upwards [N] at which a foot is on the ground.

    Returns
    -------
    Strikes
        Two or more of each side that is loaded, or none.
    """
    pressing: dict[str, Float[np.ndarray, " t"]] = {}
    for body, wrench in loads.items():
        side = stem_and_side(body)[1]
        if side:
            pressing[side] = pressing.get(side, np.zeros(len(time))) + wrench.force @ up
    return {side: _onsets(time, load, onset) for side, load in pressing.items()}


def _onsets(time: Float[np.ndarray, " t"], load: Float[np.ndarray, " t"], onset: float) -> Float[np.ndarray, " k"]:
    """Onsets where there are two or more, the ends of strides; else none."""
    spans = strides(time, load, onset)
    return np.array([*(span.start for span in spans), *(span.end for span in spans[-1:])])


@dataclass(frozen=True)
class GaitCycles:
    """Cycles of many curves.

    Parameters
    ----------
    starts
        Heel strikes [s] that lie in the recording, by side; each but the last begins a cycle.
    curves
        By coordinate, a row for each cycle of its own side; of the right, where it has none, else of the left.
    units
        Of the curves, by coordinate.
    """

    starts: Strikes
    curves: Mapping[str, Float[np.ndarray, "_ 101"]]
    units: Mapping[str, str]

    def __bool__(self) -> bool:
        return bool(self.curves)

    @property
    def counts(self) -> dict[str, int]:
        """Cycles by side."""
        return {side: len(starts) - 1 for side, starts in self.starts.items()}


def gait_cycles(
    time: Float[np.ndarray, " t"],
    names: Sequence[str],
    units: Sequence[str],
    values: Float[np.ndarray, "t n"],
    strikes: Strikes,
) -> GaitCycles:
    """Cut curves at the strikes within the recording; without two strikes of a side there are none.

    Parameters
    ----------
    time
        [s], strictly increasing.
    names, units
        Of the curves. A curve whose name says a side is cut at the strikes of that side, others at those of the right,
        or of the left where the right has none.
    values
        A column for each curve, in its unit; NaN where they are missing.
    strikes
        Heel strikes of each side [s], strictly increasing.

    Returns
    -------
    GaitCycles
        Without curves that never change, such as locked coordinates.
    """
    inside = {side: at[(at >= time[0]) & (at <= time[-1])] for side, at in strikes.items()}
    starts = {side: at for side, at in sorted(inside.items(), reverse=True) if len(at) > 1}  # right first
    curves: dict[str, Float[np.ndarray, "_ 101"]] = {}
    for name, column in zip(names, values.T, strict=True):
        own = stem_and_side(name)[1] or next(iter(starts), "")
        trials = cut(time, column, starts[own]) if own in starts else np.zeros((0, len(STEPS)))
        known = trials[np.isfinite(trials)]
        if known.size and np.ptp(known) > 0.0:  # a locked coordinate has no cycle
            curves[name] = trials
    return GaitCycles(starts, curves, {name: unit for name, unit in zip(names, units, strict=True) if name in curves})
