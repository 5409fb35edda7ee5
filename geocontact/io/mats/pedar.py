"""pedar .asc (novel): two insoles of up to 99 sensors, one row per frame; pliance .asc: one mat.

Lines in the order of the export: file name and date, type of sensor, total time and scanning rate, `pressure values
in kPa`, the sensors of each insole under `mask definition`, then a row `time[secs] 1 2 ... 99 1 2 ... 99` and the
frames. A mask leaves sensors out of the lists and of the columns, so that columns are found by the lists, never by
their number. Where a sensor lies in an insole no file says: a layout places the sensors. The .asc of one mat (pliance)
has no such lists, and numbers after `time[secs]` or none: its sensors follow the layout's order, or its `sensors.mat`.
"""

from __future__ import annotations

import re
import warnings
from array import array
from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.frame_blocks import Growing
from geocontact.data.pressure_frames import PressureFrames
from geocontact.io.mats.cells import MatRecording, frames_of
from geocontact.io.mats.layout import LARGEST, SMALLEST, MatLayout, pressure_unit
from geocontact.io.mats.text import MatText, notation_of, shown

KIND = "pedar"

SENSORS = 99
"""Sensors of one insole, numbered from 1."""

_UNIT = re.compile(r"pressure values in\s+(?P<unit>\S+)", re.IGNORECASE)
_INSOLE = re.compile(r"(?P<side>left|right) insole:\s*(?P<ids>[\d,\s]*)", re.IGNORECASE)
_RATE = re.compile(r"scanning rate\s*\[Hz\]:\s*(?P<rate>[\d.,]+)", re.IGNORECASE)
_TOTAL = re.compile(r"total time\s*\[secs\]:\s*(?P<total>[\d.,]+)", re.IGNORECASE)
_LABELS = re.compile(r"time\s*\[\s*secs?\s*\]", re.IGNORECASE)


@dataclass(frozen=True)
class PedarHeader:
    """What stands above the frames.

    `sides` has each insole's sensors in the order of the columns, from 1; it is empty for one mat, whose `labels` are
    the numbers after time[secs], where there are any.
    """

    line: int
    unit: float | None
    rate: float | None
    total: float | None
    sides: dict[str, tuple[int, ...]]
    labels: tuple[int, ...] = ()


def is_pedar(text: MatText) -> bool:
    """Whether it says what its pressures are in, and has a row that begins with time[secs]."""
    return any(map(_UNIT.match, text.head)) and any(map(_LABELS.match, text.head))


def read_pedar(text: MatText, layout: MatLayout | None) -> tuple[PressureFrames, ...]:
    """One mat per insole, named "left" and "right", or one named "mat"."""
    rows = text.lines()
    header = _header(rows, text.file)
    notation = notation_of(("\t", *(row for row in text.head[header.line :] if row)), layout, text.file)
    if not header.sides:
        first = next((row for row in text.head[header.line :] if row), "")
        header = replace(header, sides={"mat": _one_mat(header, len(notation.cells(first)) - 1, layout, text.file)})
    else:
        _require_places(header, layout, text.file)
    width = 1 + sum(map(len, header.sides.values()))
    recorded, lines = Growing(), array("q")
    values = {side: Growing() for side in header.sides}
    for number, line in rows:
        cells = notation.cells(line)
        if len(cells) != width:
            what = f"{len(cells) - 1} values where the header names {width - 1} sensors"
            raise InputError(text.file, f"line {number}", what, "is the file cut off?")
        notation.add(cells[:1], recorded, text.file, number)
        start = 1
        for side, ids in header.sides.items():
            notation.add(cells[start : start + len(ids)], values[side], text.file, number)
            start += len(ids)
        lines.append(number)
    if not lines:
        raise InputError(text.file, f"line {header.line}", "no frames below the header", "is the export complete?")
    time = recorded.values()
    _check_end(header, time, text.file)
    return tuple(
        frames_of(
            MatRecording(
                text.file, side, time, lines, values[side], header.unit, [k - 1 for k in ids], rate=header.rate
            ),
            layout or MatLayout(),
        )
        for side, ids in header.sides.items()
    )


def _header(rows: Iterator[tuple[int, str]], file: str) -> PedarHeader:
    """Lines down to the labels of the columns."""
    unit = rate = total = None
    listed: dict[str, tuple[int, ...]] = {}
    for number, line in rows:
        if _LABELS.match(line):
            place = f"line {number}"
            labels = _labels(line, file, place)
            return PedarHeader(number, unit, rate, total, _sides(labels, listed, file, place), labels)
        if found := _UNIT.match(line):
            unit = pressure_unit(found["unit"])
            if unit is None:
                what = f"pressures are in '{shown(found['unit'])}', which is not a unit of pressure known here"
                raise InputError(file, f"line {number}", what, "export them in kPa")
        if found := _INSOLE.match(line):
            ids = tuple(int(word[:6]) for word in re.findall(r"\d+", found["ids"]))
            listed[found["side"].lower()] = ids
        rate = _number(found["rate"]) if (found := _RATE.search(line)) else rate
        total = _number(found["total"]) if (found := _TOTAL.search(line)) else total
    raise InputError(file, "", "no row that begins with time[secs]", "is the export complete?")


def _number(text: str) -> float | None:
    """A positive number; None for what is none."""
    try:
        value = float(text.replace(",", "."))
    except ValueError:
        return None
    return value if SMALLEST <= value <= LARGEST else None


def _labels(line: str, file: str, place: str) -> tuple[int, ...]:
    """Numbers after time[secs]."""
    words = line.split("\t")[1:] if "\t" in line else line.split()[1:]
    words = [word.strip() for word in words if word.strip()]
    if not all(re.fullmatch(r"\d{1,3}", word) for word in words):
        what = "columns are not named by numbers of sensors (means over masks?)"
        raise InputError(file, place, what, "export the pressure of every sensor")
    return tuple(int(word) for word in words)


def _sides(
    labels: tuple[int, ...], listed: dict[str, tuple[int, ...]], file: str, place: str
) -> dict[str, tuple[int, ...]]:
    """Sensors of each insole in the order of the columns, which the labels have to confirm; none of one mat."""
    sides = {side: ids for side, ids in listed.items() if ids}
    if not sides and len(set(labels)) < len(labels):
        what = "no line `left insole: 1,2,...` above the columns says whose sensors they are"
        raise InputError(file, place, what, "export the file with its mask definition")
    if sides and labels != tuple(number for ids in sides.values() for number in ids):
        counts = " and ".join(f"{len(ids)} {side}" for side, ids in sides.items())
        what = f"columns of {len(labels)} sensors do not follow the mask definition ({counts})"
        raise InputError(file, place, what, "export the file again")
    for side, ids in sides.items():
        if len(set(ids)) < len(ids) or not 1 <= min(ids) <= max(ids) <= SENSORS:
            what = f"sensors of the {side} insole are not numbers from 1 to {SENSORS}, each once"
            raise InputError(file, place, what, "export the file again")
    return sides


def _one_mat(header: PedarHeader, count: int, layout: MatLayout | None, file: str) -> tuple[int, ...]:
    """Sensors of a single mat in the order of its `count` columns, from 1; the layout says how they lie."""
    place = f"line {header.line}"
    if header.labels and len(header.labels) != count:
        what = f"{count} values below it where {len(header.labels)} sensors are named"
        raise InputError(file, place, what, "export the file again")
    if layout is None or layout.rows is None or layout.columns is None:
        what = f"is the .asc of one mat (pliance) with {count} sensors: how they lie is not in it"
        remedy = "give a layout file with rows, columns and pitch_mm; of two insoles export the mask definition as well"
        raise InputError(file, "", what, remedy)
    known = len(layout.sensors.get("mat", ())) or layout.rows * layout.columns
    numbers = header.labels or tuple(range(1, count + 1))
    if len(numbers) > known or (not header.labels and count != known) or not 1 <= min(numbers) <= max(numbers) <= known:
        what = f"{count} sensors, numbered to {max(numbers, default=0)}, where the layout has {known}"
        raise InputError(file, place, what, "correct rows and columns in the layout")
    return numbers


def _require_places(header: PedarHeader, layout: MatLayout | None, file: str) -> None:
    """An insole is no rectangle: without a table of its sensors there is no place for them."""
    for side in header.sides:
        if layout is None or side not in layout.sensors:
            what = f"where the sensors of the {side} insole lie is not in a .asc"
            remedy = f"give a layout file with rows, columns, pitch_mm and sensors.{side} = [[row, column], ...]"
            raise InputError(file, "", what, remedy)


def _check_end(header: PedarHeader, time: Float[np.ndarray, " t"], file: str) -> None:
    """Frames may stop before the total time that the header promises."""
    if header.total is None or header.rate is None or time[-1] >= header.total - 2.5 / header.rate:
        return
    what = f"the last frame is at {time[-1]:g} s of the {header.total:g} s in the header; is the file cut off?"
    warnings.warn(InputWarning(f"{file}: {what}"), stacklevel=3)
