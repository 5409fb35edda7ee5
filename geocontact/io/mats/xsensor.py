"""XSENSOR .csv: before every frame lines `Key:,"value"`, then its rows; two sensors may take turns.

Keys are read by name and stay in force until they are said again: Frame, Time, Sensor, Rows, Columns, Units, Sensel
Width, Sensel Height, Sensel Area with their unit in round brackets. Values may be quoted, `"1,25"`, with a decimal
comma. Other keys (Average Pressure, Contact Area (in²), COP Row …) are results of the maker's program and not used.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field

import numpy as np
from jaxtyping import Float

from geocontact.data.errors import InputError
from geocontact.data.frame_blocks import Growing, parts
from geocontact.data.pressure_frames import PressureFrames
from geocontact.io.mats.cells import MatRecording, frames_of
from geocontact.io.mats.layout import LARGEST, MOST_LINES, SMALLEST, MatLayout, area_unit, length_unit, pressure_unit
from geocontact.io.mats.text import MatText, Notation, notation_of, shown
from geocontact.io.text.csv_text import LONGEST_NAME

Said = tuple[int, str, str]
"""Line, unit in brackets and value of a key."""

Keys = dict[str, Said]
"""By key, in lower case."""

SIZES = ("sensel width", "sensel height", "sensel area")

SAME = 1e-3
"""Relative difference below which two sizes are one, rounded in two units."""


def size_of(keys: Keys, key: str, unit_of: Callable[[str], float | None], file: str) -> float | None:
    """A positive length or area in SI; None without the key."""
    if key not in keys:
        return None
    line, unit, text = keys[key]
    factor = unit_of(unit)
    if factor is None:
        what = f"{key.title()} is in '{shown(unit)}', which is not a unit known here"
        raise InputError(file, f"line {line}", what, "export it in cm or in")
    try:
        number = float(text.replace(",", "."))
    except ValueError:
        number = 0.0
    if not SMALLEST <= number <= LARGEST:
        raise InputError(file, f"line {line}", f"{key.title()} is '{shown(text)}'", "expected a positive number")
    return number * factor


def require_same_size(first: Keys, block: Keys, file: str) -> None:
    """The keys above a frame may not give its cells another size than those above the sensor's first frame."""
    for key, unit_of in zip(SIZES, (length_unit, length_unit, area_unit), strict=True):
        now, before = size_of(block, key, unit_of, file), size_of(first, key, unit_of, file)
        if now is not None and (before is None or not math.isclose(now, before, rel_tol=SAME)):
            had = "none" if before is None else shown(first[key][2])
            what = f"{key.title()} is {shown(block[key][2])} where the sensor's first frame has {had}"
            raise InputError(file, f"line {block[key][0]}", what, "export one size of cell")


def pascals(said: Said | None, file: str) -> float | None:
    """Per unit of pressure; None where nothing is said."""
    if said is None:
        return None
    line, _, text = said
    factor = pressure_unit(text)
    if factor is None:
        what = f"Units is '{shown(text)}', which is not a unit of pressure known here"
        raise InputError(file, f"line {line}", what, "export pressures, calibrated, in kPa")
    return factor


def in_one_unit(
    values: Float[np.ndarray, " n"], said: Sequence[Said | None], unit: float | None, file: str
) -> Float[np.ndarray, " n"]:
    """Values of all frames in the unit of the first, `unit` [Pa].

    Frames whose own keys name another unit are converted where every frame names its unit; where some do not, it is
    open which they are in, and the file is refused at the line of the first other unit.
    """
    factors = [pascals(each, file) for each in said]
    other = next((each for each, factor in zip(said, factors, strict=True) if factor not in (None, unit)), None)
    if other is None:
        return values
    silent = factors.count(None)
    if silent or unit is None:
        what = f"Units is {shown(other[2])} and was not before, and {silent} frames of the sensor name none"
        remedy = "export the recording in one unit, or with Units above every frame"
        raise InputError(file, f"line {other[0]}", what, remedy)
    scale = np.array(factors, float) / unit
    for frames, own in parts(values.reshape(len(said), -1), scale):
        frames *= own[:, None]
    return values


KIND = "xsensor"

MOST_SENSORS = 16

_KEY = re.compile(r'"?(?P<key>[^\W\d][^",;:(]{0,60})(?:\((?P<unit>[^()]{0,20})\))?:?"?[,;\t](?P<value>.*)')
_KEY_ALONE = re.compile(r'"?[^\W\d][^,;"]*"?[,;\t]*')
_CLOCK = re.compile(
    r"(?:\S{6,12}\s+)?(?P<h>\d{1,2}):(?P<m>\d{2}):(?P<s>\d{2}(?:[.,]\d+)?)\s*(?P<half>[AP]M)?", re.IGNORECASE
)
_DAY = 86400.0
_NEEDED = frozenset({"rows", "columns"})

Rows = list[tuple[int, str]]
"""Line and text of each row of a frame."""


@dataclass(eq=False)
class _Sensor:
    """What is gathered of one sensor while the file is read."""

    keys: Keys
    size: tuple[int, int]
    lines: list[int] = field(default_factory=list)
    frames: list[int | None] = field(default_factory=list)
    clock: list[float | None] = field(default_factory=list)
    units: list[tuple[int, str, str] | None] = field(default_factory=list)
    values: Growing = field(default_factory=Growing)


def is_xsensor(text: MatText) -> bool:
    """Whether it begins with lines `Key:,value`, Rows and Columns among them."""
    return {_key(found) for line in text.head[:200] if (found := _KEY.fullmatch(line))} >= _NEEDED


def read_xsensor(text: MatText, layout: MatLayout | None) -> tuple[PressureFrames, ...]:
    """One mat per sensor, named as the file names it; "mat" where it has no name."""
    layout = layout or MatLayout()
    sensors = _gathered(text, layout)
    first = next(iter(sensors.values()))
    start = first.clock[0] or 0.0, first.frames[0] or 0
    return tuple(frames_of(_recording(name, one, start, layout, text.file), layout) for name, one in sensors.items())


def _gathered(text: MatText, layout: MatLayout) -> dict[str, _Sensor]:
    """Frames of each sensor, in the order in which sensors appear."""
    sensors: dict[str, _Sensor] = {}
    notation = _notation(text, layout)
    said: Keys = {}
    for block, rows in _blocks(text):
        line = rows[0][0]
        said = said | block
        name = _name(block, sensors, line, text.file)
        if name not in sensors:
            sensors[name] = _new(said, len(sensors), layout, line, text.file)
        _begin(sensors[name], said, block, line, text.file)
        _add(rows, sensors[name], notation, text.file)
    if not sensors:
        raise InputError(text.file, "", "no frame", "is the export complete?")
    return sensors


def _blocks(text: MatText) -> Iterator[tuple[Keys, Rows]]:
    """Frame by frame the keys said anew and the rows below them."""
    block: Keys = {}
    rows: Rows = []
    for number, line in text.lines():
        if not line.strip('\t,;" '):
            continue
        found = _KEY.fullmatch(line)
        if found is None and not _KEY_ALONE.fullmatch(line):
            rows.append((number, line))
            if len(rows) > MOST_LINES:
                raise InputError(text.file, f"line {number}", f"more than {MOST_LINES} rows", "is this a mat's export?")
            continue
        if rows:
            yield block, rows
            block, rows = {}, []
        if found:
            block[_key(found)] = (number, found["unit"] or "", found["value"].strip(' \t,;"'))
    if rows:
        yield block, rows
    elif block.keys() & {"frame", "sensor", "time"}:
        raise InputError(text.file, f"line {number}", "a frame has no rows", "is the file cut off?")


def _add(rows: Rows, sensor: _Sensor, notation: Notation, file: str) -> None:
    """The rows of one frame, which are as many and as long as the sensor's keys say."""
    for number, line in rows:
        cells = notation.cells(line)
        if len(cells) != sensor.size[1]:
            what = f"{len(cells)} cells where Columns is {sensor.size[1]}"
            remedy = f"is the file cut off, or delimiter and decimal other than read here ({notation.words})?"
            raise InputError(file, f"line {number}", what, remedy)
        notation.add(cells, sensor.values, file, number)
    if len(rows) != sensor.size[0]:
        what = f"a frame of {len(rows)} rows where Rows is {sensor.size[0]}"
        raise InputError(file, f"line {rows[-1][0]}", what, "is the file cut off?")


def _key(found: re.Match[str]) -> str:
    return found["key"].strip().lower()


def _notation(text: MatText, layout: MatLayout) -> Notation:
    return notation_of((line for line in text.head if re.match(r'"?[-+]?\d', line)), layout, text.file)


def _name(block: Keys, sensors: dict[str, _Sensor], line: int, file: str) -> str:
    if "sensor" in block:
        return shown(block["sensor"][2], LONGEST_NAME) or "mat"
    if len(sensors) > 1:
        what = "a frame does not say of which sensor it is"
        raise InputError(file, f"line {line}", what, "export it with the key Sensor, or each sensor by itself")
    return next(iter(sensors), "mat")


def _new(keys: Keys, known: int, layout: MatLayout, line: int, file: str) -> _Sensor:
    if known >= MOST_SENSORS:
        raise InputError(file, f"line {line}", f"more than {MOST_SENSORS} sensors", "export each by itself")
    return _Sensor(keys, (_count(keys, "rows", layout.rows, file), _count(keys, "columns", layout.columns, file)))


def _begin(sensor: _Sensor, keys: Keys, block: Keys, line: int, file: str) -> None:
    """A frame of a sensor; its size and that of its cells may not differ from the sensor's first frame."""
    own = {key: block.get(key, sensor.keys.get(key)) for key in _NEEDED}
    for key, size in zip(("rows", "columns"), sensor.size, strict=True):
        if (said := own[key]) is not None and said[2] != str(size):
            what = f"{key.capitalize()} is {shown(said[2])} where the sensor's first frame has {size}"
            raise InputError(file, f"line {said[0]}", what, "export one size of frame")
    require_same_size(sensor.keys, block, file)
    sensor.units.append(block.get("units"))
    sensor.lines.append(line)
    number = keys.get("frame", (0, "", ""))[2].replace(",", "").replace(".", "")
    sensor.frames.append(int(number[:9]) if number.isdecimal() else None)
    sensor.clock.append(_seconds(keys["time"], file) if "time" in keys else None)


def _count(keys: Keys, key: str, declared: int | None, file: str) -> int:
    line, _, text = keys.get(key, (0, "", ""))
    if not line and declared is not None:
        return declared
    if not text.isdecimal() or len(text) > 9 or not 1 <= int(text) <= MOST_LINES:
        what = f"{key.capitalize()} is '{shown(text)}'" if line else f"no key {key.capitalize()}"
        place = f"line {line}" if line else ""
        raise InputError(file, place, what, f"expected a number from 1 to {MOST_LINES}, or {key} in the layout")
    return int(text)


def _seconds(said: tuple[int, str, str], file: str) -> float:
    """Seconds of a time of day with or without its date, 14:03:07.250 or 2:03:07,25 PM, or a number of seconds."""
    line, _, text = said
    if found := _CLOCK.fullmatch(text):
        hours = int(found["h"]) % 12 + 12 * (found["half"].upper() == "PM") if found["half"] else int(found["h"])
        return hours * 3600.0 + int(found["m"]) * 60.0 + float(found["s"].replace(",", "."))
    if re.fullmatch(r"\d{1,9}(?:[.,]\d{1,9})?", text):
        return float(text.replace(",", "."))
    raise InputError(file, f"line {line}", f"Time is '{shown(text)}'", "expected hours:minutes:seconds")


def _recording(name: str, sensor: _Sensor, start: tuple[float, int], layout: MatLayout, file: str) -> MatRecording:
    keys = sensor.keys
    width, height = (size_of(keys, key, length_unit, file) for key in SIZES[:2])
    unit = pascals(keys.get("units"), file)
    return MatRecording(
        file,
        name,
        _times(sensor, start, layout),
        sensor.lines,
        in_one_unit(sensor.values.values(), sensor.units, unit, file),
        unit,
        rows=sensor.size[0],
        columns=sensor.size[1],
        pitch=None if height is None or width is None else (height, width),
        cell_area=size_of(keys, SIZES[2], area_unit, file),
    )


def _times(sensor: _Sensor, start: tuple[float, int], layout: MatLayout) -> list[float] | None:
    """By the clock, or by the frames' numbers where it is missing or too coarse and the layout has a rate."""
    clock = [seconds for seconds in sensor.clock if seconds is not None]
    numbers = [number for number in sensor.frames if number is not None]
    counted = layout.rate_Hz is not None and len(numbers) == len(sensor.lines)
    if len(clock) == len(sensor.lines) and not (counted and len(set(clock)) < len(clock)):
        return _since(start[0], clock)
    return [(number - start[1]) / layout.rate_Hz for number in numbers] if counted and layout.rate_Hz else None


def _since(start: float, clock: list[float]) -> list[float]:
    """Seconds since `start`; where the clock falls by half a day it has passed midnight."""
    days, seconds, before = 0.0, [], start
    for now in clock:
        days += _DAY * (now < before - _DAY / 2)
        seconds.append(now + days - start)
        before = now
    return seconds
