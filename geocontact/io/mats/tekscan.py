"""Tekscan .asf and .csv: lines `KEY value`, then `ASCII_DATA @@`, frames, and `@@`.

Keys differ by version and are read by name: ROWS, COLS, ROW_SPACING, COL_SPACING, SENSEL_AREA, UNITS,
SECONDS_PER_FRAME, SATURATION_PRESSURE, START_FRAME, END_FRAME, MIRROR_ROW, MIRROR_COL. A frame is a line `Frame n`
and ROWS lines of COLS values, `B` where there is no sensel. Frame n is at (n - 1) SECONDS_PER_FRAME, so that an
excerpt keeps the clock of its recording.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from itertools import dropwhile, islice

from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import Growing
from geocontact.data.pressure_frames import PressureFrames
from geocontact.io.mats.cells import MatRecording, frames_of
from geocontact.io.mats.layout import (
    LARGEST,
    MOST_LINES,
    SMALLEST,
    MatLayout,
    Turned,
    area_unit,
    length_unit,
    pressure_unit,
)
from geocontact.io.mats.text import MatText, Notation, notation_of, shown

KIND = "tekscan"

NO_SENSEL = "B"

MIRRORS: dict[str, Turned] = {"MIRROR_ROW": "rows", "MIRROR_COL": "columns"}
"""Keys that name what runs backwards."""

_DATA = re.compile(r"ASCII_DATA\b")
_FRAME = re.compile(r"Frame\s+(?P<number>\d{1,9})\b", re.IGNORECASE)
_VALUE = re.compile(r"(?P<number>[-+]?[\d.,]+(?:[eE][-+]?\d+)?)\s*(?P<unit>.*)")
_UNCALIBRATED = ("raw", "counts", "")

Keys = dict[str, tuple[int, str]]
"""Line and value of each key."""


def is_tekscan(text: MatText) -> bool:
    """Whether a line says where the frames begin."""
    return any(_DATA.match(_bare(line)) for line in text.head)


def read_tekscan(text: MatText, layout: MatLayout | None) -> tuple[PressureFrames, ...]:
    """The one mat of the file."""
    layout = layout or MatLayout()
    rows = text.lines()
    keys = _keys(rows, text.file)
    layout = _seen_from_front(keys, layout, text.file)
    size = _count(keys, "ROWS", layout.rows, text.file), _count(keys, "COLS", layout.columns, text.file)
    numbers, lines, values = _frames(rows, size, _notation(text, layout), text.file)
    _check_count(keys, numbers, text.file)
    seconds = _quantity(keys, "SECONDS_PER_FRAME", None, text.file) or (layout.rate_Hz and 1.0 / layout.rate_Hz)
    unit = _unit(keys, text.file)
    spacing = [_quantity(keys, key, length_unit, text.file) for key in ("ROW_SPACING", "COL_SPACING")]
    found = MatRecording(
        text.file,
        "mat",
        None if seconds is None else [(number - 1) * seconds for number in numbers],
        lines,
        values,
        unit,
        rows=size[0],
        columns=size[1],
        pitch=None if spacing[0] is None or spacing[1] is None else (spacing[0], spacing[1]),
        cell_area=_quantity(keys, "SENSEL_AREA", area_unit, text.file),
        saturation=_quantity(keys, "SATURATION_PRESSURE", pressure_unit, text.file, unit),
        rate=None if seconds is None else 1.0 / seconds,
    )
    return (frames_of(found, layout),)


def _notation(text: MatText, layout: MatLayout) -> Notation:
    below = dropwhile(lambda line: not _DATA.match(_bare(line)), text.head)
    return notation_of(
        (line for line in islice(below, 1, None) if line and not _FRAME.match(_bare(line))), layout, text.file
    )


def _bare(line: str) -> str:
    """Without what a spreadsheet puts around it: quotes, empty cells to its right."""
    return line.strip(' \t,;"')


def _keys(rows: Iterator[tuple[int, str]], file: str) -> Keys:
    keys: Keys = {}
    for number, line in rows:
        text = _bare(line)
        if _DATA.match(text):
            return keys
        key, *value = re.split(r"[\s,;]+", text, maxsplit=1)
        keys.setdefault(key.upper(), (number, " ".join(value)))
    raise InputError(file, "", "no line ASCII_DATA @@", "is the export complete?")


def _frames(
    rows: Iterator[tuple[int, str]], size: tuple[int, int], notation: Notation, file: str
) -> tuple[list[int], list[int], Growing]:
    """Number and line of each frame, and all values one after the other."""
    numbers: list[int] = []
    lines: list[int] = []
    values = Growing()
    row = size[0]
    for number, line in rows:
        text = _bare(line)
        if not text and row in (0, size[0]):
            continue
        if text == "@@":
            break
        if start := _FRAME.match(text):
            _require_whole(row, size[0], numbers, file, number)
            numbers.append(int(start["number"]))
            lines.append(number)
            row = 0
            continue
        row += 1
        if row > size[0]:
            where = f"frame {numbers[-1]} has more than ROWS = {size[0]} rows" if numbers else "a row before any frame"
            raise InputError(file, f"line {number}", where, "frames begin with a line `Frame n`")
        cells = notation.cells(line)
        if len(cells) != size[1]:
            what = f"{len(cells)} cells where COLS is {size[1]}"
            remedy = f"is the file cut off, or delimiter and decimal other than read here ({notation.words})?"
            raise InputError(file, f"line {number}", what, remedy)
        notation.add(cells, values, file, number, NO_SENSEL)
    if not numbers:
        raise InputError(file, "", "no line `Frame n` below ASCII_DATA", "is the export complete?")
    _require_whole(row, size[0], numbers, file, lines[-1])
    return numbers, lines, values


def _require_whole(row: int, rows: int, numbers: list[int], file: str, line: int) -> None:
    if row != rows:
        what = f"frame {numbers[-1]} has {row} of {rows} rows"
        raise InputError(file, f"line {line}", what, "is the file cut off?")


def _check_count(keys: Keys, numbers: list[int], file: str) -> None:
    """The last frame announced has to be there."""
    line, text = keys.get("END_FRAME", (0, ""))
    if text.isdecimal() and numbers[-1] < int(text[:9]):
        what = f"END_FRAME is {shown(text)} but the last frame is {numbers[-1]}"
        raise InputError(file, f"line {line}", what, "is the file cut off?")


def _seen_from_front(keys: Keys, layout: MatLayout, file: str) -> MatLayout:
    """The layout, its `mirrored = true` made to mean what the file says of it.

    MIRROR_ROW is taken to say that each row runs backwards, MIRROR_COL that each column does. Whether the values of
    the export run so too, or only its picture on the screen, Tekscan does not publish: who made it knows.
    """
    named: list[Turned] = []
    for key, turned in MIRRORS.items():
        line, text = keys.get(key, (0, "0"))
        if text in ("0", ""):
            continue
        named.append(turned)
        if layout.mirrored is None:
            what = f"{key} is {shown(text)}: {turned} may run as seen from behind the mat"
            raise InputError(
                file, f"line {line}", what, f"say mirrored = true (turn {turned} back) or false in the layout"
            )
    if layout.mirrored is not True or not named:
        return layout
    return layout.model_copy(update={"mirrored": "both" if len(named) > 1 else named[0]})


def _count(keys: Keys, key: str, declared: int | None, file: str) -> int:
    if key not in keys:
        if declared is None:
            raise InputError(file, "", f"no key {key}", "say rows and columns in the layout")
        return declared
    line, text = keys[key]
    if not text.isdecimal() or len(text) > 9 or not 1 <= int(text) <= MOST_LINES:
        raise InputError(file, f"line {line}", f"{key} is '{shown(text)}'", f"expected a number from 1 to {MOST_LINES}")
    return int(text)


def _quantity(
    keys: Keys, key: str, unit_of: Callable[[str], float | None] | None, file: str, default: float | None = None
) -> float | None:
    """A positive number with its unit, in SI; None without the key, or without a unit where one is needed."""
    if key not in keys:
        return None
    line, text = keys[key]
    found = _VALUE.fullmatch(text)
    try:
        number = float(found["number"].replace(",", ".")) if found else 0.0
    except ValueError:
        number = 0.0
    if found is None or not SMALLEST <= number <= LARGEST:
        raise InputError(file, f"line {line}", f"{key} is '{shown(text)}'", "expected a positive number")
    if unit_of is None:
        return number
    if not found["unit"]:
        return None if default is None else number * default
    factor = unit_of(found["unit"])
    if factor is None:
        what = f"{key} is in '{shown(found['unit'])}', which is not a unit known here"
        raise InputError(file, f"line {line}", what, "export it in metric units")
    return number * factor


def _unit(keys: Keys, file: str) -> float | None:
    """Pascals per unit; None without the key."""
    line, text = keys.get("UNITS", (0, ""))
    if line and text.lower() in _UNCALIBRATED:
        raise InputError(file, f"line {line}", "values are raw counts of the sensor", "calibrate it before the export")
    factor = pressure_unit(text) if line else None
    if line and factor is None:
        what = f"UNITS is '{shown(text)}', which is not a unit of pressure known here"
        raise InputError(file, f"line {line}", what, "export pressures in kPa")
    return factor
