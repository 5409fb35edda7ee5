"""Recorded markers as the analyses of motion take them: read, with y up, and of which side."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.analyses.frame.collector import add_input, reserve
from geocontact.analyses.frame.options import LengthUnit
from geocontact.analyses.frame.quantities import named_file, turned_axes
from geocontact.data.errors import InputError
from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import GROUND, Multibody
from geocontact.io.mocap.markers import marker_map_typed, read_marker_map, read_markers
from geocontact.io.opensim.osim_multibody import read_marker_set

RIGHT, LEFT = "right", "left"
_SIDED = re.compile(r"(?P<stem>.+)_(?P<end>r|l|right|left)|(?P<begin>r|l|right|left)_(?P<rest>.+)", re.IGNORECASE)


def stem_and_side(name: str) -> tuple[str, str]:
    """`hip_flexion_r` to `hip_flexion` and "right"; "" for a name without a side."""
    found = _SIDED.fullmatch(name)
    if found is None:
        return name, ""
    side = (found["end"] or found["begin"]).lower()
    return found["stem"] or found["rest"], RIGHT if side.startswith("r") else LEFT


TILTED = np.radians(60.0)
"""From upright, in half of the frames: who stands, walks or sits stays below; who lies or has other axes does not."""

FREE = 6
"""Coordinates of a joint that leaves a body free of the ground."""


def warn_of_tilt(model: Multibody, values: Float[np.ndarray, "t n"], axes: str | None) -> None:
    """A warning where the root body is far from how the model stands by default, with the axes that would mend it."""
    root = next((j for j in model.joints if j.parent == GROUND and len(j.coordinates) == FREE), None)
    if root is None or not np.any(model.gravity):
        return
    up, ups = -model.gravity / np.linalg.norm(model.gravity), _ups(model, root, values)
    tilt = np.arccos(np.clip(ups @ up, -1.0, 1.0))
    if not len(tilt) or np.median(tilt) <= TILTED:
        return
    meant = axes_upright(ups.mean(axis=0), up, axes)
    reserve(
        f"{root.child} is {np.degrees(np.median(tilt)):.0f} degrees from upright in half of the frames: gravity of "
        f"{model.name} does not point down in the recording; unless the subject lies, try `axes` {meant}"
    )


def _ups(model: Multibody, root: JointModel, values: Float[np.ndarray, "t n"]) -> Float[np.ndarray, "s 3"]:
    """Where what is up in the body by default points, in the frames that tell the root's coordinates."""
    names = [c.name for c in model.coordinates]
    own = [names.index(c.name) for c in root.coordinates]
    known = values[np.isfinite(values[:, own]).all(axis=1)][:, own]
    default = np.array([[c.default for c in root.coordinates]])
    first, *rest = (
        root.pose(dict(zip((c.name for c in root.coordinates), rows.T, strict=True)), len(rows))
        for rows in (default, known)
    )
    up = -model.gravity / np.linalg.norm(model.gravity)
    inner = first.rotation.inv().apply(up)
    return np.asarray(rest[0].rotation.apply(inner)).reshape(-1, 3)


def axes_upright(found: Float[np.ndarray, " 3"], up: Float[np.ndarray, " 3"], axes: str | None) -> str:
    """Axes, as the option takes them, that turn the coordinate axis next to `found` into the one next to `up`.

    The shortest turn, after the one that was asked for: which way the subject faces is not known from this.
    """
    start, end = _nearest_axis(found), _nearest_axis(up)
    turn = np.eye(3)
    if np.array_equal(start, -end):  # half a turn about any axis across it
        across = np.roll(np.abs(end), 1)
        turn = 2.0 * np.outer(across, across) - np.eye(3)
    elif not np.array_equal(start, end):
        pivot = np.cross(start, end)
        turn = np.outer(end, start) - np.outer(start, end) + np.outer(pivot, pivot)
    given = np.eye(3) if axes is None else turned_axes(axes, "`axes`").as_matrix()
    rows = np.rint(turn @ given).astype(int)
    return ",".join(f"{'-' if row.min() < 0 else ''}{'xyz'[int(np.argmax(np.abs(row)))]}" for row in rows)


def _nearest_axis(direction: Float[np.ndarray, " 3"]) -> Float[np.ndarray, " 3"]:
    """Unit vector along the coordinate axis that a direction is nearest to."""
    found = np.zeros(3)
    largest = int(np.argmax(np.abs(direction)))
    found[largest] = np.sign(direction[largest]) or 1.0
    return found


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
