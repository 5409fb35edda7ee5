"""Recordings of the elbow as the options name them: read and filtered."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np

from geocontact.analyses.frame.collector import add_input
from geocontact.data.elbow_recording import ElbowRecording
from geocontact.data.errors import InputError
from geocontact.identify.signals.filters import at_times, even_times, zero_lag
from geocontact.io.recordings import elbow_recording as channels
from geocontact.io.recordings.elbow_recording import read_elbow_recording
from geocontact.io.text.columns import parse_map


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
    """Angle, force and displacement without what lies above the cut-off, at even times."""
    time, step = even_times(r.time)

    def smooth(values: np.ndarray) -> np.ndarray:
        even = at_times(r.time, values, time, step)
        if np.isnan(even).any():
            raise InputError(path, "", "has gaps that a filter cannot cross", "cut it, or leave `cutoff` out")
        try:
            return zero_lag(even, step, cutoff)
        except ValueError as error:
            raise InputError(path, "", str(error), "give another `cutoff`") from error

    return replace(
        r,
        time=time,
        beta=smooth(r.beta),
        force=smooth(r.force),
        displacement=None if r.displacement is None else smooth(r.displacement),
        pressure=None if r.pressure is None else at_times(r.time, r.pressure, time, step),
        torque=None if r.torque is None else smooth(r.torque),
    )
