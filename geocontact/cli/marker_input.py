"""Marker trajectories as the options of a command want them: turned into the model's axes, cut to a span."""

from __future__ import annotations

from pathlib import Path

from geocontact.cli.quantities import time_span, turned_axes
from geocontact.data.errors import InputError
from geocontact.data.marker_trajectories import MarkerTrajectories
from geocontact.io.markers import read_markers


def markers_given(file: Path, axes: str | None, time: str | None) -> MarkerTrajectories:
    """Markers of a file with `--axes` and `--time` heeded."""
    seen = read_markers(file)
    if axes is not None:
        seen = seen.turned(turned_axes(axes, "--axes"))
    if time is None:
        return seen
    first, last = time_span(time)
    part = seen.between(first, last)
    if not len(part):
        what = f"no frame between {first:g} and {last:g} s"
        raise InputError(seen.source, "--time", what, f"the recording is from {seen.time[0]:g} to {seen.time[-1]:g} s")
    return part
