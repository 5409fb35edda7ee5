"""Cells of a mat that cannot read what they read, in words, and right recordings of which nothing is said."""

from __future__ import annotations

import numpy as np

from geocontact.analyses.mat.goodness import beyond_saturation, odd_cells
from geocontact.data.pressure_frames import PressureFrames

COLUMNS, ROWS = 15, 10


def area(middle: float, half: float = 3.0, swell: float = 1.0) -> np.ndarray:
    """Frames × rows × columns [Pa] of a loaded area, a parabola across, about a column."""
    row, column = np.meshgrid(np.arange(ROWS), np.arange(COLUMNS), indexing="ij")
    shape = np.maximum(0.0, 1.0 - ((column - middle) / half) ** 2 - ((row - 4.5) / 5.0) ** 2)
    course = 0.5 + 0.5 * np.sin(np.linspace(0.3, 2.5, 20)) * swell
    return np.asarray(3e4 * course[:, None, None] * shape)


def read(pressure: np.ndarray, absent: int | None = None, saturation: float = np.inf) -> PressureFrames:
    """The frames of a mat; the cells of a column may be absent."""
    valid = np.ones(pressure.shape[1:], bool)
    if absent is not None:
        valid[:, absent] = False
    pressure = np.where(valid, pressure, np.nan)
    time = 0.02 * np.arange(len(pressure))
    return PressureFrames(time, pressure, (0.01, 0.01), valid, np.full(valid.shape, 1e-4), saturation)


def silent(frames: PressureFrames) -> list[str]:
    """What is said of lines that are never pressed."""
    return [line for line in odd_cells(frames, 1e3, 1.0) if "is ever pressed" in line]


def without(pressure: np.ndarray, column: int) -> np.ndarray:
    """The same with one column that reads nothing."""
    pressure = pressure.copy()
    pressure[:, :, column] = 0.0
    return pressure


def test_a_broken_line_across_one_area_is_named() -> None:
    """In its middle, beside it, and turned by 90 degrees."""
    for column in (6, 7, 8):
        (line,) = silent(read(without(area(7.0, 5.0), column)))
        assert line.startswith(f"no cell of column {column} is ever pressed") and "is its line broken" in line
    (line,) = silent(read(np.swapaxes(without(area(7.0, 5.0), 7), 1, 2)))
    assert line.startswith("no cell of row 7")


def test_a_column_without_cells_is_not_broken() -> None:
    assert not silent(read(area(7.0, 5.0), absent=7))


def test_a_gap_between_two_areas_is_not_broken() -> None:
    """Two thighs at once, equal or one heavier, and two feet one after the other."""
    left, right = area(4.0), area(10.0)
    assert (left[:, :, 6] > 1e3).any() and (right[:, :, 8] > 1e3).any()
    assert not silent(read(without(left + right, 7))) and not silent(read(without(left + 0.3 * right, 7)))
    first = np.arange(20)[:, None, None] < 10
    one_body = without(area(7.0, 5.0), 7)
    sides = np.arange(COLUMNS) < 7
    assert silent(read(one_body)) and not silent(read(np.where(first == sides, one_body, 0.0)))


def test_no_frames_say_nothing() -> None:
    empty = read(np.empty((0, ROWS, COLUMNS)), saturation=1e4)
    assert not [*odd_cells(empty, 1e3, 1.0), *beyond_saturation(empty)]


def test_one_line_for_a_cell_beyond_the_range() -> None:
    """The unit in which it would be within is named, and the cell; up to 5 per cent nothing is said."""
    pressure = np.minimum(area(7.0), 1e4)
    pressure[3, 4, 7] = 399.8e3
    frames = read(pressure, saturation=200e3)
    (line,) = [each for each in (*beyond_saturation(frames), *odd_cells(frames, 1e3, 1.0)) if "399.8" in each]
    assert "row 4 column 7 reads 399.8 kPa, and cells end at 200 kPa" in line and "53.3 kPa if they are in mmHg" in line
    assert not [*beyond_saturation(read(pressure, saturation=390e3))]
