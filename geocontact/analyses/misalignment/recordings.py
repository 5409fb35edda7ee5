"""Recordings of the elbow as the options name them: read and filtered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import Any, Literal

import numpy as np

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.motion.checked_trial import check_trial
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.data.text import same_place
from geocontact.identify.signals.filters import at_times, even_times, zero_lag
from geocontact.io.recordings import elbow_recording as channels
from geocontact.io.recordings.elbow_recording import read_elbow_recording
from geocontact.io.text.columns import parse_map
from geocontact.trial_checks.recorded import RecordedChannel, TrialInputs
from geocontact.trial_checks.twice import same_recordings

SMOOTHED, KEPT = ("displacement", "torque", "moment", "alpha"), ("pressure", "target")
"""Channels beside angle and force that a filter smooths, and that it only takes to even times."""


SLID = 0.5e-3
"""m; a locked joint does not move as far."""


def recordings(
    role: str,
    paths: Sequence[Path],
    mapping: str | None,
    angles: Literal["deg", "rad"] | None,
    unit: str | None,
    cutoff: float | None,
    needed: tuple[str, ...] = (channels.FORCE,),
) -> list[ElbowRecording]:
    """The recordings of one role; they need names of their own."""
    columns = {} if mapping is None else parse_map(mapping, channels.CHANNELS)
    found: list[ElbowRecording] = []
    for path in paths:
        if same_place([*(r.name for r in found), path.stem]):
            raise InputError(path, "", f"is the second recording named {path.stem!r}", "rename one")
        raw = read_elbow_recording(path, columns, angles, unit, needed)
        add_input(role, path, samples=len(raw.time))
        _check(raw, path)
        found.append(raw if cutoff is None else _filtered(path, raw, cutoff))
    return found


FROZEN, TURNED = 10, np.radians(10.0)
"""Samples for which a channel has one value, and how far the hinge turns meanwhile, from which that is no measurement:
10 degrees are twice what a step of the converter lasts for in slow recordings."""


def _check(r: ElbowRecording, path: Path) -> None:
    """Rate and sizes of the channels, as of every trial; a channel that stands still while the angle changes."""
    units = {"force": "N", "moment": "N m", "torque": "N m", "displacement": "m", "alpha": "rad"}
    channels = {name: own for name in units if (own := getattr(r, name)) is not None and own.any()}
    for one, own, other in (("beta", r.beta, "alpha"), ("force", r.force, "moment")):
        if (beside := getattr(r, other)) is not None and same_recordings({one: own, other: beside}):
            what = f"{other} has the values of {one}, sample by sample"
            raise InputError(path, "", what, "name each its own column, or leave it out: see `map`")
    check_trial(
        TrialInputs(
            channels=tuple(RecordedChannel(name, units[name], r.time, own, str(path)) for name, own in channels.items())
        )
    )
    for name in [each for each in channels if each != "displacement"]:  # a joint rests at the ends of its stroke
        held = np.flatnonzero(np.diff(np.r_[np.nan, channels[name], np.nan]) != 0.0)
        for start, stop in pairwise(held):
            if stop - start >= FROZEN and np.ptp(r.beta[start:stop]) > TURNED:
                when = f"from {r.time[start]:.2f} to {r.time[stop - 1]:.2f} s"
                turned = f"while the hinge turns by {np.degrees(np.ptp(r.beta[start:stop])):.0f} degrees"
                reserve(f"{path}: {name} has one value {when}, {turned}: is it clipped, or was its sensor off?")
                break


FOLLOWS, LOST, LEVER = 0.8, 0.5, 0.4
"""Correlation of moment and force in the other trials from which one of another sign, or of less than that share of it,
is spoken of; and m, of the lever between them: cuffs are 0.05 to 0.2 m from the link's end."""


def doubt_moments(paths: Sequence[Path], found: Sequence[ElbowRecording]) -> None:
    """A warning for a measured moment that goes with its force in another way than in the other trials.

    Both are of one cuff: the moment over the force is a lever, which is one in all trials.
    """
    known = [(path, r.force, r.moment) for path, r in zip(paths, found, strict=True) if r.moment is not None]
    known = [each for each in known if np.ptp(each[1]) > 0.0 and np.ptp(each[2]) > 0.0]
    alike = [float(np.corrcoef(force, moment)[0, 1]) for _, force, moment in known]
    levers = [abs(float(np.polyfit(force, moment, 1)[0])) for _, force, moment in known]
    if known and np.median(np.abs(alike)) > FOLLOWS and np.median(levers) > LEVER:
        what = f"its moment over its force is a lever of {np.median(levers):.2g} m (median of the trials)"
        reserve(f"{known[0][0]}: {what}: are moment and force in N m and N?", cause=True)
    for k, (path, _, _) in enumerate(known):
        others = np.array(alike[:k] + alike[k + 1 :])
        if not len(others) or np.min(np.abs(others)) < FOLLOWS or len(set(np.sign(others))) > 1:
            continue
        share = alike[k] / float(np.median(others))
        if share < LOST:
            what = (
                f"its moment goes with its force by a correlation of {alike[k]:.2f}, in the others by {others[0]:.2f}"
            )
            cause = "is its sign turned in this trial?" if share < -LOST else "is it of this trial, on its clock?"
            reserve(f"{path}: {what}: {cause}", cause=True)


def _filtered(path: Path, r: ElbowRecording, cutoff: float) -> ElbowRecording:
    """Channels without what lies above the cut-off, at even times; pressure and target as they were."""
    time, step = even_times(r.time)

    def smooth(values: np.ndarray) -> np.ndarray:
        even = at_times(r.time, values, time, step)
        if np.isnan(even).any():
            raise InputError(path, "", "has gaps that a filter cannot cross", "cut it, or leave `cutoff` out")
        try:
            return zero_lag(even, step, cutoff)
        except ValueError as error:
            raise InputError(path, "", str(error), "give another `cutoff`") from error

    beside: dict[str, Any] = {name: smooth(own) for name in SMOOTHED if (own := getattr(r, name)) is not None}
    beside |= {name: at_times(r.time, own, time, step) for name in KEPT if (own := getattr(r, name)) is not None}
    return replace(
        r,
        time=time,
        beta=smooth(r.beta),
        force=smooth(r.force),
        **beside,
    )
