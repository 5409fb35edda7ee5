"""Marker trajectories of .trc files, as Motion Analysis' software and OpenSim write them.

Line 3 tells rate, counts and unit, line 4 the markers' names, line 5 the columns; then frame, time and x y z of each
marker between tabs. An empty cell is a marker that was not seen; so is one at exactly 0 0 0, which some exports write.
What stands before a colon in a name is the subject and is left out.
Times are often rounded to milliseconds, which would ruin accelerations; where frames and rate bear the times out to the
rounding, they count.
"""

from __future__ import annotations

import warnings
from os import PathLike, fspath

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.io.mocap.subject import without_subject
from geocontact.io.text.encoding import decoded
from geocontact.io.text.file_preflight import read_bytes
from geocontact.io.text.table_rows import read_rows
from geocontact.io.text.units import LENGTH, length_unit

_HEAD = 5
_ROUNDED = 0.51e-3
"""s that a time may be off the even one by rounding."""


def read_trc(path: str | PathLike[str]) -> MarkerTrajectories:
    """Markers of a .trc file, in metres; InputError where names, unit or times contradict the rows.

    A count of frames that does not fit is a warning: OpenSim reads on.
    """
    file = fspath(path)
    lines = decoded(read_bytes(path), path).splitlines()
    if len(lines) <= _HEAD or not lines[0].startswith("PathFileType"):
        raise InputError(file, "line 1", "does not begin with 'PathFileType'", "is it a complete .trc file?")
    declared = _declared(lines[1], lines[2])
    names = tuple(without_subject([word.strip() for word in lines[3].split("\t")[2:] if word.strip()]))
    if differs := _other_count(declared, "NumMarkers", len(names), "markers are named in line 4"):
        raise InputError(file, "line 3", differs, "is the file complete?")
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise InputError(file, "line 4", f"marker '{twice[0]}' is there {names.count(twice[0])} times", "rename one")
    written = declared.get("Units", "")
    unit = length_unit(written)
    if unit is None:
        raise InputError(file, "line 3", f"unit is '{written[:20]}'", f"expected one of {', '.join(LENGTH)}")
    columns = ("frame", "time", *(f"{name} {axis}" for name in names for axis in "xyz"))
    values, places = read_rows(iter(lines[_HEAD:]), _HEAD + 1, columns, file, _split)
    if differs := _other_count(declared, "NumFrames", len(values), "frames follow"):
        warnings.warn(InputWarning(f"{file} line 3: {differs}; all are read"), stacklevel=2)
    time = values[:, 1]
    late = np.flatnonzero(~(np.diff(time) > 0.0))
    if len(late) or not np.isfinite(time[0]):
        line = places[late[0] + 1] if len(late) else places[0]
        raise InputError(file, f"line {line}", "time does not increase", "every frame needs its own time")
    endless = np.flatnonzero(np.isinf(values[:, 2:]).any(axis=1))
    if len(endless):
        raise InputError(file, f"line {places[endless[0]]}", "a place is infinite", "leave missing cells empty")
    positions = LENGTH[unit] * values[:, 2:].reshape(len(values), len(names), 3)
    return MarkerTrajectories(_unrounded(time, values[:, 0], declared), _seen(file, positions), names, file)


def _declared(keys: str, values: str) -> dict[str, str]:
    """Values of line 3 by the keys of line 2: between tabs, where a cell may be empty, or between blanks."""
    names, cells = ([cell.strip() for cell in line.rstrip().split("\t")] for line in (keys, values))
    if len(names) == 1 or len(cells) == 1:
        names, cells = keys.split(), values.split()
    return dict(zip(names, cells, strict=False))


def _unrounded(
    time: Float[np.ndarray, " t"], frames: Float[np.ndarray, " t"], declared: dict[str, str]
) -> Float[np.ndarray, " t"]:
    """Times by frame and rate where they are those of the file but for rounding, else the file's."""
    try:
        step = 1.0 / float(declared.get("DataRate", "nan"))
    except (ValueError, ZeroDivisionError):
        return time
    even = (frames - frames[0]) * step
    even = even + np.median(time - even)
    return even if np.all(np.abs(even - time) < min(_ROUNDED, 0.5 * step)) else time


def _split(line: str, _separator: None, most: int) -> list[str]:
    """Cells of a line; those that are missing at its end are empty, tabs beyond the last are no cells."""
    if not line.strip():
        return []
    cells = line.rstrip("\r\n").split("\t")
    while len(cells) > most and not cells[-1].strip():
        cells.pop()
    return cells + [""] * (most - len(cells))


def _other_count(declared: dict[str, str], key: str, count: int, what: str) -> str:
    """In words how a count of line 3 differs from what follows; "" where it does not."""
    said = declared.get(key, "")
    return f"{key} is '{said[:20]}' but {count} {what}" if said and (not said.isdigit() or int(said) != count) else ""


def _seen(file: str, positions: Float[np.ndarray, "t m 3"]) -> Float[np.ndarray, "t m 3"]:
    zero = np.all(positions == 0.0, axis=2)
    if zero.any():
        message = f"{file}: {int(zero.sum())} markers at exactly 0 0 0 are taken as not seen"
        warnings.warn(InputWarning(message), stacklevel=3)
    lost = zero | np.any(np.isnan(positions), axis=2)
    return np.where(lost[..., None], np.nan, positions)
