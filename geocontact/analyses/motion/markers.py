"""Recorded markers as the analyses of motion take them: read, with y up, and under their own names."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.marks import LengthUnit
from geocontact.analyses.frame.places import turned_axes
from geocontact.analyses.frame.quantities import named_file
from geocontact.data.errors import InputError
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.dynamics.exchanged_markers import Exchanged
from geocontact.dynamics.tilt import axes_upright, root_tilt
from geocontact.io.mocap.markers import marker_map_typed, read_marker_map, read_markers
from geocontact.io.opensim.osim_multibody import read_marker_set

TILTED = np.radians(60.0)
"""From upright, in half of the frames: who stands, walks or sits stays below; who lies or has other axes does not."""

NAMED = 3
"""Exchanged pairs that a question names; the map has all of them."""


def exchange_question(exchanged: Exchanged) -> str:
    """A question to whoever named the markers."""
    named = ", ".join(f"{one} and {other}" for one, other in exchanged.pairs[:NAMED])
    named += f" and {len(exchanged.pairs) - NAMED} more pairs" if len(exchanged.pairs) > NAMED else ""
    number = f"{1e3 * exchanged.after:.1f} mm in place of {1e3 * exchanged.before:.1f} mm"
    mapped = ",".join(f"{one}={other},{other}={one}" for one, other in exchanged.pairs)
    return f"are markers {named} exchanged? That would leave {number}: try `markers_map` {mapped}"


def warn_of_tilt(model: Multibody, values: Float[np.ndarray, "t n"], axes: str | None) -> None:
    """A warning where the root body is far from how the model stands by default, with the axes that would mend it."""
    tilt = root_tilt(model, values)
    if tilt is None or tilt.angle <= TILTED:
        return
    reserve(
        f"{tilt.body} is {np.degrees(tilt.angle):.0f} degrees from upright in half of the frames: gravity of "
        f"{model.name} does not point down in the recording; unless the subject lies, try `axes` "
        f"{axes_upright(tilt.up, model.up, turn_of(axes))}"
    )


LARGEST, SMALLEST, FEW = 20.0, 0.05, 5
"""Span of the markers in a frame [m] beyond which the unit is another, from so many markers on below."""


def turn_of(axes: str | None) -> Rotation | None:
    """Rotation by which `axes` turns what a file holds; None where the file is in the model's axes."""
    return None if axes is None else turned_axes(axes, "`axes`")


def markers_given(
    file: Path, axes: str | None, time: tuple[float, float] | None, c3d_unit: str | None
) -> MarkerTrajectories:
    """Markers of a file in the model's axes, between two times [s]; `c3d_unit` is that of a .c3d that has none."""
    seen = read_markers(file, c3d_unit)
    _refuse_absurd(seen)
    turn = turn_of(axes)
    if turn is not None:
        seen = seen.turned(turn)
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
        raise InputError(seen.source, "", "no marker is visible in any frame", "is it the right file?")
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
