"""From numbers in the order of a file to cells on the grid of a mat: what every reader ends with."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TypeVar

import numpy as np
from jaxtyping import Bool, Float, Int

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.frame_blocks import Growing, parts, room
from geocontact.data.pressure_frames import PressureFrames
from geocontact.io.mats.layout import MatLayout, pressure_unit
from geocontact.io.text.units import DIMENSIONS

LEAST, MOST = 1e2, 2e6
"""Largest pressure of a recording [Pa]: less no mat resolves; more no skin bears, plantar peaks reach 1.5 MPa."""

LIKELY = ("kPa", "mmHg", "N/cm^2", "psi", "Pa", "MPa")
"""Units that makers of mats export, the usual one first."""


def warn_implausible(file: str, name: str, highest: float, unit: float) -> None:
    """Warn of a recording whose largest pressure [Pa] is none of a body's; `unit` is what one of the file's is [Pa]."""
    if not 0.0 < highest < math.inf or LEAST <= highest <= MOST:
        return
    read = next((each for each, factor in DIMENSIONS["Pa"].items() if math.isclose(factor, unit)), f"{unit:g} Pa")
    value = highest / unit
    meant = next((each for each in LIKELY if LEAST < value * DIMENSIONS["Pa"][each] < MOST), None)
    bound = f"more than {MOST * 1e-6:g} MPa" if highest > MOST else f"less than {LEAST:g} Pa"
    said = f"{file}: the largest pressure of '{name}' is {value:.4g} {read}, {bound}, implausible for skin under load"
    warnings.warn(InputWarning(f"{said}{f'; is the file in {meant}?' if meant else ''}"), stacklevel=5)


T = TypeVar("T", float, int)

_CLOSE = 1e-3
"""Relative difference below which a file and its layout say the same."""

_UNEVEN = 0.05
"""Relative difference of a rate and the frames' times below which they agree: times are rounded."""

_PITCH = 1e-4, 0.5
"""Smallest and largest distance of neighbouring cells [m]."""

_LATEST = 1e10
"""Seconds; 300 years."""

_CLIPPED = 1.0 - 1e-9
"""A level converted from another unit than the pressures may come out an ulp above them."""


@dataclass(frozen=True, eq=False)
class MatRecording:
    """Frames as one file has them, and what the file says of the mat; None for what it does not say.

    Parameters
    ----------
    file, name
        Path as given; name of the mat, for messages.
    time
        Of each frame [s]; None where the file has none.
    lines
        At which each frame begins.
    values
        Frame by frame, in the unit of the file; NaN where it has no value.
    unit
        Pascals per unit.
    ids
        Place of each value of a frame among the ids, from 0; None where they are complete and in order.
    pitch, cell_area, saturation
        SI.
    """

    file: str
    name: str
    time: Sequence[float] | Float[np.ndarray, " t"] | None
    lines: Sequence[int]
    values: Growing | Float[np.ndarray, " n"]
    unit: float | None = None
    ids: Sequence[int] | None = None
    rows: int | None = None
    columns: int | None = None
    pitch: tuple[float, float] | None = None
    cell_area: float | None = None
    saturation: float | None = None
    rate: float | None = None


def frames_of(found: MatRecording, layout: MatLayout, *, signed: bool = False) -> PressureFrames:
    """Cells on the grid, in SI; what the file leaves open is taken from the layout, what they disagree on is refused.

    Pressures below zero are kept, with one warning that counts them: the noise of an offset that may be taken off yet.
    `signed` values are shear stresses, which have either sign.
    """
    rows = _needed(found, "rows", found.rows, layout.rows)
    columns = _needed(found, "columns", found.columns, layout.columns)
    unit = _needed(found, "unit", found.unit, pressure_unit(layout.unit) if layout.unit else None)
    pitch, area = _sizes(found, layout)
    saturation = _settled(found, "saturation_kPa", found.saturation, layout.saturation)
    time = _times(found, layout)
    row, column = _places(found, layout, rows, columns)
    given = found.values.values() if isinstance(found.values, Growing) else found.values
    values = given.reshape(len(found.lines), -1)
    if np.array_equal(row * columns + column, np.arange(rows * columns)):  # no second copy of a long recording
        pressure = values.reshape(-1, rows, columns)
    else:
        pressure = room((len(values), rows, columns))
        for part, read in parts(pressure, values):
            part[:] = np.nan
            part[:, row, column] = read
    with np.errstate(over="ignore"):  # refused below as not finite
        for (part,) in parts(pressure):
            part *= unit
    valid = _valid(found, layout, pressure)
    for (part,) in parts(pressure):
        part[:, ~valid] = np.nan
    if not signed:
        _warn_negative(pressure, unit, found)
    highest = max(float(np.nanmax(np.abs(part) if signed else part)) for (part,) in parts(pressure))
    warn_implausible(found.file, found.name, highest, unit)
    areas = np.full((rows, columns), math.prod(pitch) if area is None else area[0])
    if area is not None and len(area) > 1:
        areas[row, column] = area if found.ids is None else [area[each] for each in found.ids]
    level = math.inf if saturation is None else saturation * _CLIPPED
    return PressureFrames(time, pressure, pitch, valid, areas, level, found.name)


def _settled(found: MatRecording, key: str, said: T | None, declared: T | None) -> T | None:
    """What the file says or the layout declares; they may not disagree."""
    if said is not None and declared is not None and not math.isclose(said, declared, rel_tol=_CLOSE):
        what = f"the file says {said:g} where the layout says {declared:g} (SI)"
        raise InputError(found.file, key, what, f"correct {key} in the layout, or leave it out")
    return declared if said is None else said


def _needed(found: MatRecording, key: str, said: T | None, declared: T | None) -> T:
    value = _settled(found, key, said, declared)
    if value is None:
        raise InputError(found.file, "", f"does not say the {key} of the mat", f"write {key} in the layout file")
    return value


def _sizes(found: MatRecording, layout: MatLayout) -> tuple[tuple[float, float], tuple[float, ...] | None]:
    """Pitch [m] and areas [m^2] of the cells: one for all, one for each value, or None for what the pitch gives."""
    areas = tuple(area * 1e-6 for area in layout.cell_area_mm2)
    if len(areas) < 2:
        area = _settled(found, "cell_area_mm2", found.cell_area, areas[0] if areas else None)
        areas = () if area is None else (area,)
    side = math.sqrt(areas[0]) if areas else None
    square: tuple[float | None, float | None] = side, side
    declared: tuple[float | None, float | None] = layout.pitch or (None, None)
    said = found.pitch or (square if layout.pitch is None else (None, None))
    rows, columns = (_needed(found, "pitch_mm", said[k], declared[k]) for k in (0, 1))
    if not (_PITCH[0] <= min(rows, columns) and max(rows, columns) <= _PITCH[1]):
        what = f"a pitch of {rows * 1e3:g} x {columns * 1e3:g} mm is not that of a mat"
        raise InputError(found.file, "", what, "is its unit right?")
    if len(areas) == 1 and not 0.01 <= (part := areas[0] / (rows * columns)) <= 1.05:
        what = (
            f"a cell of {areas[0] * 1e6:g} mm^2 fills {part:.3g} of the pitch of {rows * 1e3:g} x {columns * 1e3:g} mm"
        )
        raise InputError(found.file, "", what, "are their units right?")
    return (rows, columns), areas or None


def _times(found: MatRecording, layout: MatLayout) -> Float[np.ndarray, " t"]:
    if found.time is None:
        return np.arange(len(found.lines)) / _needed(found, "rate_Hz", found.rate, layout.rate_Hz)
    time = np.asarray(found.time, dtype=np.float64)
    unusable = np.flatnonzero(~(np.abs(time) <= _LATEST))
    if len(unusable):
        line = found.lines[int(unusable[0])]
        raise InputError(found.file, f"line {line}", "the frame has no time", "every frame needs one")
    late = np.flatnonzero(np.diff(time) <= 0.0)
    if len(late):
        i = late[0]
        what = f"time {time[i + 1]:.9g} s does not follow {time[i]:.9g} s"
        raise InputError(found.file, f"line {found.lines[i + 1]}", what, "time must increase from frame to frame")
    rate = _settled(found, "rate_Hz", found.rate, layout.rate_Hz)
    if rate is not None and len(time) > 1:
        steps = rate * float(np.median(np.diff(time)))  # more than one where frames were left out
        if abs(steps - max(round(steps), 1)) > _UNEVEN:
            what = f"the rate is {rate:g} Hz but frames are {steps / rate:.6g} s apart"
            raise InputError(found.file, "", what, "correct the one that is wrong")
    return time


def _places(
    found: MatRecording, layout: MatLayout, rows: int, columns: int
) -> tuple[Int[np.ndarray, " n"], Int[np.ndarray, " n"]]:
    """Row and column of each value of a frame in the returned grid."""
    count = len(found.values) // max(len(found.lines), 1)
    if not count:
        raise InputError(found.file, "", "holds no frames", "is the export complete?")
    ids = np.arange(count) if found.ids is None else np.asarray(found.ids)
    table = layout.sensors.get(found.name)
    if layout.sensors and table is None:
        what = f"sensors of the layout places no cell of '{found.name}'"
        raise InputError(found.file, "", what, f"write sensors.{found.name}, or leave sensors out")
    known = rows * columns if table is None else len(table)
    if ids.max() >= known:
        what = f"has cell {ids.max() + layout.first_id} where the layout places {known}"
        raise InputError(found.file, "", what, "correct rows, columns, first_id or sensors in the layout")
    if len(layout.cell_area_mm2) not in (0, 1, count):
        what = f"cell_area_mm2 of the layout has {len(layout.cell_area_mm2)} areas for {count} cells"
        raise InputError(found.file, "", what, "give one for all, or one for each cell of the file")
    if found.ids is not None and count < known:
        message = (
            f"{found.file}: {known - count} of {known} cells of '{found.name}' are not in the file; taken as absent"
        )
        warnings.warn(InputWarning(message), stacklevel=4)
    if table is not None:
        places = np.array(table, dtype=np.int64)[ids]
        return _within(places[:, 0], places[:, 1], rows, columns, found)
    row, column = np.divmod(ids, columns) if layout.order == "row" else np.divmod(ids, rows)[::-1]
    if layout.serpentine and layout.order == "row":
        column = np.where(row % 2, columns - 1 - column, column)
    elif layout.serpentine:
        row = np.where(column % 2, rows - 1 - row, row)
    below = layout.origin.startswith("bottom") != layout.columns_turned
    aside = layout.origin.endswith("right") != layout.rows_turned
    return rows - 1 - row if below else row, columns - 1 - column if aside else column


def _within(
    row: Int[np.ndarray, " n"], column: Int[np.ndarray, " n"], rows: int, columns: int, found: MatRecording
) -> tuple[Int[np.ndarray, " n"], Int[np.ndarray, " n"]]:
    if row.max() >= rows or column.max() >= columns:
        what = f"sensors.{found.name} of the layout leaves the {rows} x {columns} grid"
        raise InputError(found.file, "", what, "rows and columns are counted from 0")
    return row, column


def _valid(found: MatRecording, layout: MatLayout, pressure: Float[np.ndarray, "t r c"]) -> Bool[np.ndarray, "r c"]:
    """Cells that have a value in every frame and that the layout takes for sound; gaps in a recording are refused."""
    valid: Bool[np.ndarray, "r c"] = ~np.all([np.isnan(part).all(axis=0) for (part,) in parts(pressure)], axis=0)
    for row, column in (*layout.masked, *layout.dead):
        if row >= valid.shape[0] or column >= valid.shape[1]:
            what = f"masked or dead cell [{row}, {column}] of the layout is outside the {valid.shape} grid"
            raise InputError(found.file, "", what, "rows and columns are counted from 0")
        valid[row, column] = False
    if gap := _first(np.isnan, pressure, valid):
        frame, row, column = gap
        what = f"frame {frame + 1} has no value in cell [{row}, {column}], which other frames have"
        remedy = "list the cell under dead in the layout, or export the recording again"
        raise InputError(found.file, f"line {found.lines[frame]}", what, remedy)
    if infinite := _first(np.isinf, pressure, valid):
        frame, row, column = infinite
        what = f"cell [{row}, {column}] of frame {frame + 1} is not finite"
        raise InputError(found.file, f"line {found.lines[frame]}", what, "list the cell under dead in the layout")
    if not valid.any():
        raise InputError(found.file, "", f"no cell of '{found.name}' has a value", "is the export complete?")
    return valid


def _first(
    kind: Callable[[np.ndarray], np.ndarray], pressure: Float[np.ndarray, "t r c"], valid: Bool[np.ndarray, "r c"]
) -> tuple[int, int, int] | None:
    """Frame, row and column of the first value of a valid cell that is of a kind."""
    before = 0
    for (part,) in parts(pressure):
        marked = kind(part) & valid
        if marked.any():
            frame, row, column = np.unravel_index(int(marked.argmax()), marked.shape)
            return before + int(frame), int(row), int(column)
        before += len(part)
    return None


def _warn_negative(pressure: Float[np.ndarray, "t r c"], unit: float, found: MatRecording) -> None:
    """Say once how many are below zero; mostly negative pressures are refused."""
    below = sum(int((part < 0.0).sum()) for (part,) in parts(pressure))
    if not below:
        return
    ends = [(np.nanmin(part), np.nanmax(part)) for (part,) in parts(pressure)]
    lowest, highest = float(min(each for each, _ in ends)), float(max(each for _, each in ends))
    if -lowest > highest:
        what = f"pressures of '{found.name}' run from {lowest / unit:g} to {highest / unit:g} of the file's unit"
        raise InputError(found.file, "", what, "is their sign turned, or an offset subtracted twice?")
    message = (
        f"{found.file}: {below} pressures of '{found.name}' below 0 (lowest {lowest / unit:g} "
        f"of the file's unit): an offset, or noise about it"
    )
    warnings.warn(InputWarning(message), stacklevel=4)
