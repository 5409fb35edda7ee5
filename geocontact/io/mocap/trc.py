"""Marker trajectories as .trc files, as Motion Analysis' software and OpenSim read and write them.

Line 3 tells rate, counts and unit, line 4 the markers' names, line 5 the columns; then frame, time and x y z of each
marker between tabs. An empty cell is a marker that was not seen; so is one at exactly 0 0 0, which some exports write.
What stands before a colon in a name is the subject and is left out. Markers without a name, whose cells Cortex writes
between the named ones or behind them, are passed over; line 3 may count them or not.
Times are often rounded to milliseconds, which would ruin accelerations; where frames and rate bear the times out to the
rounding, they count.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from os import PathLike, fspath
from pathlib import Path

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.text import seconds
from geocontact.io.text.file_preflight import decoded, read_text_bytes
from geocontact.io.text.tables import read_rows
from geocontact.io.text.units import LENGTH, length_unit


def without_subject(labels: Sequence[str]) -> list[str]:
    """Labels without what stands before a colon, unless two different ones would then be alike."""
    short = [label.rpartition(":")[2] for label in labels]
    return short if len(set(short)) == len(set(labels)) else list(labels)


LARGEST_TRC = 512_000_000
"""Bytes; 100 markers at 100 Hz for half an hour."""
_HEAD = 5
_ROUNDED = 0.51e-3
"""s that a time may be off the even one by rounding."""
_RATES, _FEW = 0.05, 10
"""Share by which the declared rate may differ from that of the times, beside rounding; steps that say so."""


def read_trc(path: str | PathLike[str]) -> MarkerTrajectories:
    """Markers of a .trc file, in metres; InputError where names, unit or times contradict the rows.

    A count of frames that does not fit is a warning: OpenSim reads on.
    """
    file = fspath(path)
    lines = decoded(read_text_bytes(path, LARGEST_TRC, "cut it"), path).splitlines()
    if len(lines) <= _HEAD or not lines[0].startswith("PathFileType"):
        raise InputError(file, "line 1", "does not begin with 'PathFileType'", "is it a complete .trc file?")
    declared = _declared(lines[1], lines[2])
    names, slots = _named(lines[3], file)
    width = 2 + 3 * (max(slots) + 1)
    behind, cells = _behind(lines[_HEAD:], width, file)
    _require_count(declared, len(names), max(slots) + 1 + behind, (cells - 2) // 3, file)
    twice = [name for name in names if names.count(name) > 1]
    if twice:
        raise InputError(file, "line 4", f"marker '{twice[0]}' is there {names.count(twice[0])} times", "rename one")
    written = declared.get("Units", "")
    unit = length_unit(written)
    if unit is None:
        raise InputError(file, "line 3", f"unit is '{written[:20]}'", f"expected one of {', '.join(LENGTH)}")
    of_slot = dict(zip(slots, names, strict=True))
    columns = (
        "frame",
        "time",
        *(f"{of_slot.get(k, f'unnamed {k + 1}')} {axis}" for k in range(max(slots) + 1) for axis in "xyz"),
    )
    values, places = read_rows(iter(lines[_HEAD:]), _HEAD + 1, columns, file, _split)
    if unnamed := max(slots) + 1 + behind - len(names):
        what = "1 marker without a name is" if unnamed == 1 else f"{unnamed} markers without a name are"
        warnings.warn(InputWarning(f"{file}: {what} passed over"), stacklevel=2)
    if differs := _other_count(declared, "NumFrames", len(values), "frames follow"):
        warnings.warn(InputWarning(f"{file} line 3: {differs}; all are read"), stacklevel=2)
    time = values[:, 1]
    if differs := _other_rate(declared, time):
        warnings.warn(InputWarning(f"{file} line 3: {differs}; the times are read"), stacklevel=2)
    late = np.flatnonzero(~(np.diff(time) > 0.0))
    if len(late) or not np.isfinite(time[0]):
        line = places[late[0] + 1] if len(late) else places[0]
        raise InputError(file, f"line {line}", "time does not increase", "every frame needs its own time")
    endless = np.flatnonzero(np.isinf(values[:, 2:]).any(axis=1))
    if len(endless):
        raise InputError(file, f"line {places[endless[0]]}", "a coordinate is infinite", "leave missing cells empty")
    positions = LENGTH[unit] * values[:, 2:].reshape(len(values), -1, 3)[:, slots]
    return MarkerTrajectories(_unrounded(time, values[:, 0], declared), _without_zeros(file, positions), names, file)


def _declared(keys: str, values: str) -> dict[str, str]:
    """Values of line 3 by the keys of line 2: between tabs, where a cell may be empty, or between blanks.

    Some programs write several tabs between two values: then there are more cells than keys, and no empty one counts.
    """
    names, cells = ([cell.strip() for cell in line.rstrip().split("\t")] for line in (keys, values))
    if len(names) == 1 or len(cells) == 1 or len(cells) > len(names):
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


def _other_rate(declared: dict[str, str], time: Float[np.ndarray, " t"]) -> str:
    """How the rate of line 3 differs from that of the times, in words; empty where it does not, or is not there."""
    try:
        rate = float(declared.get("DataRate", "nan"))
    except ValueError:
        return ""
    steps = np.diff(time)
    if len(steps) < _FEW or not (steps > 0.0).all() or not rate > 0.0:
        return ""
    own = 1.0 / float(np.median(steps))
    if abs(own / rate - 1.0) <= _RATES + _ROUNDED * rate:
        return ""
    return f"DataRate is {rate:g} Hz, and the times of the frames have {own:.4g} in a second"


def _split(line: str, _separator: None, most: int) -> list[str]:
    """Cells of a line; those that are missing at its end are empty, those of markers behind the last are left out."""
    if not line.strip():
        return []
    cells = line.rstrip("\r\n").split("\t")[:most]
    return cells + [""] * (most - len(cells))


def _named(line: str, file: str) -> tuple[tuple[str, ...], list[int]]:
    """Names of line 4, and which marker of a row each is: every third cell has a name, or none."""
    words = [word.strip() for word in line.split("\t")[2:]]
    at = [k for k, word in enumerate(words) if word]
    if not at and "\t" not in line and len(line.split()) > 2:
        what = "has blanks between its columns, not tabs"
        raise InputError(file, "line 4", what, "export it with tabs: a marker that was not seen is an empty cell")
    if not at:
        raise InputError(file, "line 4", "names no marker", "name the markers where it was recorded")
    names = tuple(without_subject([words[k] for k in at]))
    return names, [k // 3 for k in at] if all(k % 3 == 0 for k in at) else list(range(len(at)))


def _behind(rows: list[str], width: int, file: str) -> tuple[int, int]:
    """Whole markers behind the named ones in the longest row, and cells of that row with empty ones counted."""
    behind = longest = 0
    for number, line in enumerate(rows, _HEAD + 1):
        cells = line.rstrip("\r\n").split("\t")
        longest = max(longest, len(cells))
        while len(cells) > width and not cells[-1].strip():
            cells.pop()
        beyond = len(cells) - width
        if beyond > 0 and beyond % 3:
            what = f"more cells where {width} columns are named, and the {beyond} behind these are not whole markers"
            raise InputError(file, f"line {number}", what, "rows must be as long as the header")
        behind = max(behind, beyond // 3)
    return behind, longest


def _require_count(declared: dict[str, str], named: int, present: int, cells: int, file: str) -> None:
    """NumMarkers counts the named markers, or with those without a name, seen or not, whose cells are there."""
    said = declared.get("NumMarkers", "")
    if said.isdigit() and int(said) in {named, present, *range(present, cells + 1)}:
        return
    if differs := _other_count(declared, "NumMarkers", named, "markers are named in line 4"):
        raise InputError(file, "line 3", differs, "is the file complete?")


def _other_count(declared: dict[str, str], key: str, count: int, what: str) -> str:
    """In words how a count of line 3 differs from what follows; "" where it does not."""
    said = declared.get(key, "")
    return f"{key} is '{said[:20]}' but {count} {what}" if said and (not said.isdigit() or int(said) != count) else ""


def _without_zeros(file: str, positions: Float[np.ndarray, "t m 3"]) -> Float[np.ndarray, "t m 3"]:
    zero = np.all(positions == 0.0, axis=2)
    if zero.any():
        message = f"{file}: {int(zero.sum())} markers at exactly 0 0 0 are taken as not seen"
        warnings.warn(InputWarning(message), stacklevel=3)
    lost = zero | np.any(np.isnan(positions), axis=2)
    return np.where(lost[..., None], np.nan, positions)


ASKED = (
    "DataRate",
    "CameraRate",
    "NumFrames",
    "NumMarkers",
    "Units",
    "OrigDataRate",
    "OrigDataStartFrame",
    "OrigNumFrames",
)


def write_trc(path: Path, markers: MarkerTrajectories) -> None:
    """Cells of a marker that was not seen are empty; the rate in the head is that of the mean step."""
    path.write_text(trc_text(path.name, markers), encoding="utf-8")


def trc_text(name: str, markers: MarkerTrajectories, decimals: int = 6) -> str:
    """The file's text, with so many decimals of a millimetre."""
    count, steps = len(markers.names), len(markers) - 1
    rate = steps / float(markers.time[-1] - markers.time[0]) if steps > 0 else 1.0
    told = (f"{rate:.6g}", f"{rate:.6g}", str(len(markers)), str(count), "mm", f"{rate:.6g}", "1", str(len(markers)))
    lines = [
        f"PathFileType\t4\t(X/Y/Z)\t{name}",
        "\t".join(ASKED),
        "\t".join(told),
        "Frame#\tTime\t" + "\t\t\t".join(markers.names),
        "\t\t" + "\t".join(f"{axis}{k + 1}" for k in range(count) for axis in "XYZ"),
        "",
    ]
    for k, (time, places) in enumerate(zip(markers.time, 1e3 * markers.positions, strict=True)):
        cells = ("" if np.isnan(value) else f"{value:.{decimals}f}" for value in places.ravel())
        lines.append("\t".join((str(k + 1), seconds(float(time), 9), *cells)))
    return "\n".join(lines) + "\n"
