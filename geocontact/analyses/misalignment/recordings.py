"""Recordings of the elbow as the options name them: read and filtered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Literal

import numpy as np

from geocontact.analyses.frame.collector import add_input
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.signals.filters import at_times, even_times, zero_lag
from geocontact.io.recordings import elbow_recording as channels
from geocontact.io.recordings.elbow_recording import read_elbow_recording
from geocontact.io.text.columns import parse_map

SMOOTHED, KEPT = ("displacement", "torque", "moment", "alpha"), ("pressure", "target")
"""Channels beside angle and force that a filter smooths, and that it only takes to even times."""


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
        found.append(raw if cutoff is None else _filtered(path, raw, cutoff))
    return found


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
