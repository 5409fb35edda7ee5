"""Marker trajectories as the options of a command want them: turned into the model's axes, cut to a span."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from geocontact.analyses.frame.collector import add_input
from geocontact.analyses.frame.options import LengthUnit
from geocontact.analyses.frame.quantities import named_file, turned_axes
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.io.mocap.markers import marker_map_typed, read_marker_map, read_markers
from geocontact.io.opensim.osim_multibody import read_marker_set

LARGEST, SMALLEST, FEW = 20.0, 0.05, 5
"""Span of the markers in a frame [m] beyond which the unit is another, from so many markers on below."""


def markers_given(
    file: Path, axes: str | None, time: tuple[float, float] | None, c3d_unit: str | None
) -> MarkerTrajectories:
    """Markers of a file in the model's axes, between two times [s]; `c3d_unit` is that of a .c3d that has none."""
    seen = read_markers(file, c3d_unit)
    _refuse_absurd(seen)
    if axes is not None:
        seen = seen.turned(turned_axes(axes, "`axes`"))
    if time is None:
        return seen
    first, last = time
    part = seen.between(first, last)
    if not len(part):
        what = f"no frame between {first:g} and {last:g} s"
        raise InputError(seen.source, "`time`", what, f"the recording is from {seen.time[0]:g} to {seen.time[-1]:g} s")
    return part


def unit_of_c3d(stated: LengthUnit | None, *files: Path | None) -> LengthUnit | None:
    """What was stated for a study's .c3d files, of one trial; None where it has no such file."""
    return stated if any(file is not None and file.suffix.lower() == ".c3d" for file in files) else None


def _refuse_absurd(seen: MarkerTrajectories) -> None:
    """A body spans decimetres to metres; more or less is another unit than the file says."""
    places = seen.positions[np.isfinite(seen.positions).all(axis=2)]
    if not len(places):
        raise InputError(seen.source, "", "no marker is seen in any frame", "is it the right file?")
    first = next(frame for frame in seen.positions if np.isfinite(frame).all(axis=1).any())
    there = first[np.isfinite(first).all(axis=1)]
    size = float(np.linalg.norm(np.ptp(there, axis=0)))
    if size > LARGEST or (len(there) >= FEW and size < SMALLEST):
        likely = "mm" if size > LARGEST else "m"
        what = f"markers span {size:.3g} m in a frame"
        raise InputError(seen.source, "", what, f"is the unit in the file's head right? perhaps it is {likely}")


def renamed_as_told(seen: MarkerTrajectories, given: str | None) -> MarkerTrajectories:
    """Markers by new names, as `markers_map` says; InputError where one of them was not recorded."""
    if given is None:
        return seen
    file = named_file(given)
    names = marker_map_typed(given, "`markers_map`") if file is None else read_marker_map(file)
    if file is not None:
        add_input("`markers_map`", file, markers=len(names))
    lost = [name for name in names if name not in seen.names]
    if lost:
        what = f"{lost[0]} was not recorded"
        raise InputError(seen.source, "`markers_map`", what, f"recorded are {', '.join(seen.names[:30])}")
    try:
        return seen.renamed(names)
    except ValueError as error:
        raise InputError(seen.source, "`markers_map`", str(error), "map that one too, or leave it out") from error


def with_marker_set(model: Multibody, osim: Path, file: Path | None) -> Multibody:
    """The model with the markers of another file in place of its own."""
    if file is None:
        return model
    markers = read_marker_set(file, osim)
    add_input("`marker_set`", file, markers=len(markers))
    return replace(model, markers=markers)
