"""Cycles of a walk: heel strikes where the loads of feet set in, and curves cut at them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from jaxtyping import Float

from geocontact.data.gait_events import OFF, STRIKE, GaitEvent, Part, cycles_between
from geocontact.data.sides import stem_and_side
from geocontact.data.wrench import Wrench
from geocontact.identify.signals.cycles import STEPS, normalised, strides

Strikes = dict[str, Float[np.ndarray, " _"]]
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
    counts
        Cycles by side, right first.
    curves
        By coordinate, a row for each cycle of its own side; of the right, where it has none, else of the left.
    units
        Of the curves, by coordinate.
    part
        First part of each cycle that the curves are over, or "stance"; None: all of it.
    """

    counts: Mapping[str, int]
    curves: Mapping[str, Float[np.ndarray, "_ 101"]]
    units: Mapping[str, str]
    part: Part = None

    def __bool__(self) -> bool:
        return bool(self.curves)


def gait_cycles(
    time: Float[np.ndarray, " t"],
    names: Sequence[str],
    units: Sequence[str],
    values: Float[np.ndarray, "t n"],
    strikes: Strikes,
    offs: Strikes | None = None,
    part: Part = None,
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
    offs
        Toe offs of each side [s], for stances.
    part
        First part of each cycle that is used, or "stance".

    Returns
    -------
    GaitCycles
        Without curves that never change, such as locked coordinates.
    """
    spans = {side: _spans(time, strikes[side], (offs or {}).get(side), part) for side in sorted(strikes, reverse=True)}
    spans = {side: own for side, own in spans.items() if own}  # right first
    curves: dict[str, Float[np.ndarray, "_ 101"]] = {}
    for name, column in zip(names, values.T, strict=True):
        own = stem_and_side(name)[1] or next(iter(spans), "")
        trials = np.array([normalised(time, column, *each) for each in spans.get(own, [])]).reshape(-1, len(STEPS))
        known = trials[np.isfinite(trials)]
        if known.size and np.ptp(known) > 0.0:  # a locked coordinate has no cycle
            curves[name] = trials
    counts = {side: len(own) for side, own in spans.items()}
    known_units = {name: unit for name, unit in zip(names, units, strict=True) if name in curves}
    return GaitCycles(counts, curves, known_units, part)


def _spans(
    time: Float[np.ndarray, " t"], strikes: Float[np.ndarray, " k"], offs: Float[np.ndarray, " m"] | None, part: Part
) -> list[tuple[float, float]]:
    """First and last time [s] of each cycle of a side within the recording."""
    events = [GaitEvent("", STRIKE, float(at)) for at in strikes]
    events += [GaitEvent("", OFF, float(at)) for at in (np.zeros(0) if offs is None else offs)]
    found = [(each.start, each.end) for each in cycles_between(events, "", "", part)]
    return [(start, end) for start, end in found if time[0] <= start and end <= time[-1]]
