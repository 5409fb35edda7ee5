"""Every cell of one recording per format; the numbers are those one reads in the text."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputWarning
from geocontact.io.mats.catalogue import READERS, read_mat
from tests.io.mats.samples import (
    GRID,
    GRID_LAYOUT,
    PEDAR,
    PEDAR_LAYOUT,
    PLIANCE,
    TEKSCAN,
    XSENSOR,
    layout,
    write,
)

GAP = math.nan
MMHG = 133.322387415
PSI = 6894.757293168361


def test_every_kind_has_its_sample() -> None:
    assert set(READERS) == {"grid", "pedar", "tekscan", "xsensor"}


def test_grid(tmp_path: Path) -> None:
    (mat,) = read_mat(write(tmp_path, GRID), layout(tmp_path, GRID_LAYOUT))
    np.testing.assert_array_equal(mat.time, [0.0, 0.02])
    np.testing.assert_allclose(mat.pressure[0], [[500, 1000, 1500], [2000, 2500, 3000]], rtol=1e-15)
    np.testing.assert_allclose(mat.pressure[1], [[10e3, 20e3, 30e3], [40e3, 50e3, 60e3]], rtol=1e-15)
    assert mat.pitch == pytest.approx((0.010, 0.020), rel=1e-15)
    assert mat.valid.all()
    np.testing.assert_allclose(mat.cell_area, 2e-4, rtol=1e-12)
    assert mat.saturation == math.inf
    assert mat.force == pytest.approx([10.5e3 * 2e-4, 210e3 * 2e-4], rel=1e-12)


@pytest.mark.parametrize("labels", ["", "\t1\t2\t3\t4\t5\t6"])
def test_the_asc_of_one_mat_follows_the_order_of_the_layout(labels: str, tmp_path: Path) -> None:
    file = write(tmp_path, PLIANCE.replace("time[secs]", f"time[secs]{labels}"), "pliance.asc")
    (mat,) = read_mat(file, layout(tmp_path, GRID_LAYOUT + "serpentine = true\n"))
    assert mat.name == "mat"
    np.testing.assert_allclose(mat.time, [0.0, 0.02])
    np.testing.assert_allclose(mat.pressure[0], [[1e3, 2e3, 3e3], [6e3, 5e3, 4e3]], rtol=1e-15)
    np.testing.assert_allclose(mat.pressure[1], [[0, 10e3, 0], [0.5e3, 0, 0]], rtol=1e-15)


def test_numbers_of_one_mat_leave_sensors_out(tmp_path: Path) -> None:
    text = PLIANCE.replace("time[secs]", "time[secs]\t1\t2\t3\t4\t5\t7")
    grid = GRID_LAYOUT.replace("columns = 3", "columns = 4")
    places = "[sensors]\nmat = [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [0, 3], [1, 2]]\n"
    with pytest.warns(InputWarning, match="1 of 7 cells of 'mat' are not in the file"):
        (mat,) = read_mat(write(tmp_path, text, "p.asc"), layout(tmp_path, grid + places))
    np.testing.assert_allclose(mat.pressure[0], [[1e3, 2e3, 3e3, GAP], [4e3, 5e3, 6e3, GAP]], rtol=1e-15)


def test_pedar_has_two_insoles_of_masked_sensors(tmp_path: Path) -> None:
    with pytest.warns(InputWarning) as caught:
        left, right = read_mat(write(tmp_path, PEDAR, "walk.asc"), layout(tmp_path, PEDAR_LAYOUT))
    assert [str(w.message).split(": ", 1)[1] for w in caught] == [
        "1 of 5 cells of 'left' are not in the file; taken as absent",
        "2 of 5 cells of 'right' are not in the file; taken as absent",
    ]
    assert (left.name, right.name) == ("left", "right")
    np.testing.assert_allclose(left.time, [0.01, 0.02], rtol=1e-15)
    np.testing.assert_allclose(left.pressure[0], [[GAP, GAP, 20e3], [32.5e3, 40e3, 0]], rtol=1e-15)
    np.testing.assert_allclose(left.pressure[1], [[GAP, GAP, 22.5e3], [35e3, 42.5e3, 2.5e3]], rtol=1e-15)
    np.testing.assert_allclose(right.pressure[0], [[GAP, GAP, 72.5e3], [GAP, 105e3, 25e3]], rtol=1e-15)
    np.testing.assert_allclose(right.pressure[1], [[GAP, GAP, 75e3], [GAP, 107.5e3, 27.5e3]], rtol=1e-15)
    np.testing.assert_array_equal(left.valid, [[False, False, True], [True, True, True]])
    np.testing.assert_array_equal(right.valid, [[False, False, True], [False, True, True]])
    np.testing.assert_allclose(left.cell_area, 150e-6, rtol=1e-12)


def test_tekscan(tmp_path: Path) -> None:
    (mat,) = read_mat(write(tmp_path, TEKSCAN, "seat.asf"))
    np.testing.assert_allclose(mat.time, [0.10, 0.12], rtol=1e-15)
    np.testing.assert_allclose(
        mat.pressure[0], 1e3 * np.array([[GAP, 1, 2.5, GAP], [3, 4, 5, 6], [7, 8, 9, 207]]), rtol=1e-15
    )
    np.testing.assert_allclose(
        mat.pressure[1], 1e3 * np.array([[GAP, 11, 12.5, GAP], [13, 14, 15, 16], [17, 18, 19, 0]]), rtol=1e-15
    )
    np.testing.assert_array_equal(mat.valid[0], [False, True, True, False])
    assert mat.valid[1:].all()
    assert mat.pitch == pytest.approx((0.01016, 0.00508), rel=1e-12)
    np.testing.assert_allclose(mat.cell_area, 51.6128e-6, rtol=1e-12)
    assert np.argwhere(mat.saturated).tolist() == [[0, 2, 3]]


def test_xsensor_alternates_between_two_sensors_across_midnight(tmp_path: Path) -> None:
    seat, back = read_mat(write(tmp_path, XSENSOR))
    assert (seat.name, back.name) == ("Seat", "Back")
    np.testing.assert_allclose(seat.time, [0.0, 0.1], atol=1e-9)
    np.testing.assert_array_equal(back.time, seat.time)
    np.testing.assert_allclose(seat.pressure[0], MMHG * np.array([[0, 1.25, 2.5], [3.75, 5, 6.25]]), rtol=1e-12)
    np.testing.assert_allclose(seat.pressure[1], MMHG * np.array([[10, 11.25, 12.5], [13.75, 15, 16.25]]), rtol=1e-12)
    np.testing.assert_allclose(back.pressure, PSI * np.array([[[0.5, 1.5]], [[2.5, 3.5]]]), rtol=1e-12)
    assert seat.pitch == pytest.approx((0.4 * 0.0254, 0.5 * 0.0254), rel=1e-12)
    np.testing.assert_allclose(seat.cell_area, 0.2 * 0.0254**2, rtol=1e-12)


def test_xsensor_of_an_older_program_is_in_windows_1252(tmp_path: Path) -> None:
    old, new = write(tmp_path, XSENSOR.encode("cp1252"), "old.csv"), write(tmp_path, XSENSOR, "new.csv")
    for one, other in zip(read_mat(old), read_mat(new), strict=True):
        np.testing.assert_array_equal(one.pressure, other.pressure)
        np.testing.assert_array_equal(one.cell_area, other.cell_area)


@pytest.mark.parametrize("end", ["\r\n", "\r"])
def test_line_ends_do_not_matter(tmp_path: Path, end: str) -> None:
    (plain,) = read_mat(write(tmp_path, TEKSCAN, "a.asf"))
    (other,) = read_mat(write(tmp_path, "\ufeff" + TEKSCAN.replace("\n", end), "b.asf"))
    np.testing.assert_array_equal(plain.pressure, other.pressure)
    np.testing.assert_array_equal(plain.time, other.time)


def test_tekscan_as_a_spreadsheet_saves_it(tmp_path: Path) -> None:
    """Quotes, empty cells to the right of every line, semicolons and decimal commas."""
    head, body = TEKSCAN.split("ASCII_DATA @@")
    padded = "\n".join(f'"{line}";;;' for line in head.splitlines()) + "\nASCII_DATA @@;;;\n"
    padded += "\n".join(
        line.replace(",", ";").replace(".", ",") if "," in line else f"{line};;;" for line in body.splitlines()[1:]
    )
    (plain,) = read_mat(write(tmp_path, TEKSCAN, "a.asf"))
    (other,) = read_mat(write(tmp_path, padded, "b.csv"))
    np.testing.assert_array_equal(plain.pressure, other.pressure)
    np.testing.assert_array_equal(plain.time, other.time)
    assert plain.pitch == other.pitch
