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
from geocontact.identify.signals.filters import at_times, even_times, zero_lag
from geocontact.io.recordings import elbow_recording as channels
from geocontact.io.recordings.elbow_recording import read_elbow_recording
from geocontact.io.text.columns import parse_map
from geocontact.trial_checks.recorded import RecordedChannel, TrialInputs

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
        if path.stem in [r.name for r in found]:
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
