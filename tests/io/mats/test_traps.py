"""What exports of mats go wrong with is read right, warned of, or refused in one line that names the place."""

from __future__ import annotations

import csv
import random
import warnings
from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.mats import text as mat_text
from geocontact.io.mats.catalogue import READERS, read_mat
from tests.io.mats.samples import GRID, GRID_LAYOUT, PEDAR, PEDAR_LAYOUT, PLIANCE, TEKSCAN, XSENSOR, layout, write

SAMPLES = {
    "grid": (GRID, GRID_LAYOUT),
    "pedar": (PEDAR, PEDAR_LAYOUT),
    "tekscan": (TEKSCAN, ""),
    "xsensor": (XSENSOR, ""),
}


def refusal(folder: Path, recording: str | bytes, declared: str = "", kind: str | None = None) -> str:
    """The line that a recording is refused with, without its path."""
    path = write(folder, recording)
    said = layout(folder, declared) if declared else None
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        with pytest.raises(InputError) as caught:
            read_mat(path, said, kind)
    line = str(caught.value)
    assert "\n" not in line and line.isprintable() and len(line) < 500
    assert line.startswith(str(path)), "the file is named"
    return line.removeprefix(str(path)).strip(": ")


# Kind, what is replaced by what in its sample, how the line begins.
EDITS = {
    "no time in a row": ("grid", "0.02,10", ",10", "line 4: time is ''"),
    "time in words": ("grid", "0.02", "soon", "line 4: time is 'soon'"),
    "time in minutes": ("grid", "time [s]", "time [min]", "line 2: time is in 'min'"),
    "time goes back": ("grid", "0.02,", "-0.02,", "line 4: time -0.02 s does not follow 0 s"),
    "time stands": ("grid", "0.02,", "0.00,", "line 4: time 0 s does not follow 0 s"),
    "cut row": ("grid", ",50,60", ",5", "line 4: 6 cells where 7 columns are named"),
    "decimal commas between commas": ("grid", "0.5,1.0", "0,5,1,0", "line 3: 9 cells where 7 columns are named"),
    "a word": ("grid", "2.5", "n/a", "line 3: 'n/a' in cell 5 is not a number with a decimal point"),
    "underscore": ("grid", "2.5", "2_5", "line 3: '2_5' in cell 5 is not a number"),
    "gap": ("grid", "2.5", "", "line 3: frame 1 has no value in cell [1, 1], which other frames have"),
    "infinite": ("grid", "2.5", "inf", "line 3: cell [1, 1] of frame 1 is not finite"),
    "overflow": ("grid", "2.5", "1e306", "line 3: cell [1, 1] of frame 1 is not finite"),
    "id twice": ("grid", "5,6", "5,5", "line 2: cell 5 occurs twice"),
    "id 0": ("grid", ",1,2,", ",0,2,", "line 2: there is a cell 0; say first_id = 0"),
    "id too large": ("grid", "5,6", "5,7", "has cell 7 where the layout places 6"),
    "column without id": ("grid", "5,6", "5,force", "line 2: column 'force' is neither time nor a cell"),
    "two units": ("grid", "5,6", "5 [kPa],6 [psi]", "line 2: cells are in '', 'kPa', 'psi'"),
    "another unit than the layout's": (
        "grid",
        "1,2,3,4,5,6",
        ",".join(f"{i} [psi]" for i in range(1, 7)),
        "unit: the file says 6894.76 where the layout says 1000 (SI)",
    ),
    "header only": ("grid", GRID[GRID.index("0.00") :], "", "line 2: no rows below the header"),
    "sign turned": ("grid", "60", "-600", "pressures of 'mat' run from -600 to 50"),
    "pedar cut row": (
        "pedar",
        "\t 27.500\t107.500\t 75.000\t",
        "\t 27.5",
        "line 12: 5 values where the header names 7",
    ),
    "pedar unit": ("pedar", "kPa", "volts", "line 4: pressures are in 'volts'"),
    "pedar without labels": ("pedar", "time[secs]", "secs", "no row that begins with time[secs]"),
    "pedar without masks": (
        "pedar",
        "left insole: 1,2,3,5,\nright insole: 1,2,4,\n",
        "\n\n",
        "line 10: no line `left insole: 1,2,...`",
    ),
    "pedar other mask": ("pedar", "1,2,4,", "1,2,3,", "line 10: columns of 7 sensors do not follow the mask"),
    "pedar mask means": ("pedar", "      4\n", " heel\n", "line 10: columns are not named by numbers of sensors"),
    "pedar rate": ("pedar", "[Hz]:   100", "[Hz]:   50", "the rate is 50 Hz but frames are 0.01 s apart"),
    "pedar time": ("pedar", "0.02000\t 35", "0.01000\t 35", "line 12: time 0.01 s does not follow 0.01 s"),
    "tekscan without ROWS": ("tekscan", "ROWS 3\n", "", "no key ROWS; say rows and columns in the layout"),
    "tekscan without UNITS": (
        "tekscan",
        "UNITS KPa\n",
        "",
        "does not say the unit of the mat; write unit in the layout",
    ),
    "tekscan without time": ("tekscan", "SECONDS_PER_FRAME 0.02\n", "", "does not say the rate_Hz of the mat"),
    "tekscan ROWS in words": ("tekscan", "ROWS 3", "ROWS many", "line 5: ROWS is 'many'"),
    "tekscan ROWS huge": ("tekscan", "ROWS 3", "ROWS 999999999", "line 5: ROWS is '999999999'"),
    "tekscan more columns": ("tekscan", "COLS 4", "COLS 5", "line 24: 4 cells where COLS is 5"),
    "tekscan more rows": ("tekscan", "ROWS 3", "ROWS 4", "line 28: frame 6 has 3 of 4 rows"),
    "tekscan fewer rows": ("tekscan", "ROWS 3", "ROWS 2", "line 26: frame 6 has more than ROWS = 2 rows"),
    "tekscan raw": ("tekscan", "UNITS KPa", "UNITS Raw", "line 18: values are raw counts of the sensor"),
    "tekscan unit": ("tekscan", "UNITS KPa", "UNITS lbs", "line 18: UNITS is 'lbs'"),
    "tekscan spacing": ("tekscan", "10.16 mm", "0 mm", "line 7: ROW_SPACING is '0 mm'"),
    "tekscan spacing unit": ("tekscan", "10.16 mm", "10.16 cubits", "line 7: ROW_SPACING is in 'cubits'"),
    "tekscan mirrored": ("tekscan", "MIRROR_ROW 0", "MIRROR_ROW 1", "line 19: MIRROR_ROW is 1: rows may run as seen"),
    "tekscan columns mirrored": (
        "tekscan",
        "MIRROR_COL 0",
        "MIRROR_COL 1",
        "line 20: MIRROR_COL is 1: columns may run as seen from behind the mat; say mirrored = true (turn columns",
    ),
    "tekscan cut": ("tekscan", TEKSCAN[TEKSCAN.index("13,14") :], "", "line 28: frame 7 has 1 of 3 rows"),
    "tekscan cut inside a row": ("tekscan", TEKSCAN[TEKSCAN.index(",15,16") :], "", "line 30: 2 cells where COLS is 4"),
    "tekscan frame missing": (
        "tekscan",
        "END_FRAME 7",
        "END_FRAME 9",
        "line 17: END_FRAME is 9 but the last frame is 7",
    ),
    "tekscan frame twice": ("tekscan", "Frame 7", "Frame 6", "line 17: END_FRAME is 7 but the last frame is 6"),
    "tekscan frames go back": ("tekscan", "Frame 6", "Frame 8", "line 28: time 0.12 s does not follow 0.14 s"),
    "tekscan B in one frame": ("tekscan", "13,14", "13,B", "line 28: frame 2 has no value in cell [1, 1]"),
    "tekscan no frame": ("tekscan", TEKSCAN[TEKSCAN.index("\nFrame 6") :], "", "no line `Frame n` below ASCII_DATA"),
    "tekscan pitch in m": ("tekscan", "10.16 mm", "10.16 m", "a pitch of 10160 x 5.08 mm is not that of a mat"),
    "tekscan tiny pitch": ("tekscan", "10.16 mm", "1e-200 mm", "line 7: ROW_SPACING is '1e-200 mm'"),
    "tekscan area in cm2": ("tekscan", "51.6128 mm2", "51.6128 cm2", "a cell of 5161.28 mm^2 fills 100 of the pitch"),
    "tekscan tiny interval": ("tekscan", "FRAME 0.02", "FRAME 1e-320", "line 11: SECONDS_PER_FRAME is '1e-320'"),
    "time beyond reason": ("grid", "0.02,", "1e308,", "line 4: the frame has no time"),
    "tekscan area": ("tekscan", "51.6128 mm2", "51.6128 mm", "line 9: SENSEL_AREA is in 'mm'"),
    "xsensor other size": (
        "xsensor",
        '"2"\nTime',
        '"2"\nRows:,"3"\nTime',
        "line 28: Rows is 3 where the sensor's first",
    ),
    "xsensor cut": (
        "xsensor",
        '"13,75","15,00","16,25"\n',
        "",
        "line 30: a frame of 1 rows where Rows is 2; is the file cut off?",
    ),
    "xsensor cut at the end": ("xsensor", '"2,5","3,5"\n', "", "line 33: a frame has no rows; is the file cut off?"),
    "xsensor more rows": (
        "xsensor",
        '"2,5","3,5"\n',
        '"2,5","3,5"\n' * 2,
        "line 35: a frame of 2 rows where Rows is 1",
    ),
    "xsensor short row": ("xsensor", '"10,00","11', '"11', "line 30: 2 cells where Columns is 3"),
    "xsensor mixed marks": (
        "xsensor",
        '"11,25"',
        '"11.25"',
        "line 30: '11.25' in cell 2 is not a number with a decimal",
    ),
    "xsensor thousands": ("xsensor", '"11,25"', '"1.111,25"', "line 30: '1.111,25' in cell 2 is not a number"),
    "xsensor frame of nobody": (
        "xsensor",
        'Sensor:,"Seat"\n"10',
        '"10',
        "line 29: a frame does not say of which sensor",
    ),
    "xsensor time": ("xsensor", "00:00:00,000", "noon", "line 28: Time is 'noon'"),
    "xsensor time stands": ("xsensor", "00:00:00,000", "23:59:59,900", "line 30: time 0 s does not follow 0 s"),
    "xsensor unit": ("xsensor", '"psi"', '"counts"', "line 24: Units is 'counts'"),
    "xsensor other number of columns": (
        "xsensor",
        '"2"\nTime',
        '"2"\nColumns:,"2"\nTime',
        "line 28: Columns is 2 where the sensor's first frame has 3",
    ),
    "xsensor other cell": (
        "xsensor",
        '"2"\nTime',
        '"2"\nSensel Width (cm):,"1,0"\nTime',
        "line 28: Sensel Width is 1,0 where the sensor's first frame has 0,5; export one size of cell",
    ),
    "xsensor width": ("xsensor", 'Width (in):,"0,5"', 'Width (px):,"0,5"', "line 7: Sensel Width is in 'px'"),
    "xsensor rows": ("xsensor", 'Rows:,"2"', 'Rows:,"two"', "line 5: Rows is 'two'"),
}


@pytest.mark.parametrize("case", EDITS)
def test_damage_is_refused_where_it_is(tmp_path: Path, case: str) -> None:
    kind, old, new, expected = EDITS[case]
    sample, declared = SAMPLES[kind]
    assert old in sample
    line = refusal(tmp_path, sample.replace(old, new, 1), declared, kind)
    assert line.startswith(expected), line


FILES = {
    "empty": (b"", "the file is empty"),
    "blank": (b" \n\n", "the file is empty"),
    "HTML": (b"<!DOCTYPE html>\n<html>ROWS 3</html>", "is not the recording of a mat: it looks like an HTML page"),
    "zip": (b"PK\x03\x04" + bytes(90), "is not the recording of a mat: it looks like an archive"),
    "UTF-16": (("\ufeff" + TEKSCAN).encode("utf-16-le"), "is not the recording of a mat: it looks like UTF-16 text"),
    "binary": (b"ROWS 3\0\1\2", "is not the recording of a mat: it looks like binary data"),
    "prose": (b"Once upon a time there was a mat.\n", "is not a recording of a mat that is known here"),
}


@pytest.mark.parametrize("case", FILES)
def test_files_that_are_no_recordings(tmp_path: Path, case: str) -> None:
    data, expected = FILES[case]
    assert refusal(tmp_path, data).startswith(expected)


def test_missing_file_and_unknown_kind(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="there is no such file"):
        read_mat(tmp_path / "none.csv")
    with pytest.raises(InputError, match="is a folder"):
        read_mat(tmp_path)
    with pytest.raises(InputError, match="'emed' is not a kind of recording; kinds are tekscan, pedar"):
        read_mat(write(tmp_path, GRID), None, "emed")


def test_a_layout_is_asked_for_where_the_file_does_not_place_its_cells(tmp_path: Path) -> None:
    assert refusal(tmp_path, GRID).endswith("give a layout file with rows, columns and pitch_mm")
    assert "sensors.left = [[row, column], ...]" in refusal(tmp_path, PEDAR)
    assert refusal(tmp_path, PEDAR, "rows = 2\ncolumns = 3").startswith("where the sensors of the left insole lie")


def test_the_asc_of_one_mat_asks_for_its_layout(tmp_path: Path) -> None:
    said = refusal(tmp_path, PLIANCE)
    assert said.startswith("is the .asc of one mat (pliance) with 6 sensors: how they lie is not in it; give a layout")
    assert refusal(tmp_path, PLIANCE, GRID_LAYOUT.replace("rows = 2", "rows = 3")).startswith(
        "line 7: 6 sensors, numbered to 6, where the layout has 9; correct rows and columns"
    )
    assert refusal(tmp_path, PLIANCE.replace("\t0.5", ""), GRID_LAYOUT).startswith("line 9: 5 values where the header")


def test_layout_and_file_may_not_disagree(tmp_path: Path) -> None:
    assert refusal(tmp_path, TEKSCAN, "rows = 4").startswith("rows: the file says 3 where the layout says 4")
    assert refusal(tmp_path, TEKSCAN, "pitch_mm = 10").startswith("pitch_mm: the file says 0.01016 where the")
    assert refusal(tmp_path, TEKSCAN, 'unit = "psi"').startswith("unit: the file says 1000")
    assert refusal(tmp_path, TEKSCAN, "saturation_kPa = 100").startswith("saturation_kPa: the file says 207000")
    assert refusal(tmp_path, TEKSCAN, "rate_Hz = 100").startswith("rate_Hz: the file says 50 where the layout says 100")
    assert refusal(tmp_path, TEKSCAN, "dead = [[3, 0]]").startswith(
        "masked or dead cell [3, 0] of the layout is outside"
    )
    (mat,) = read_mat(write(tmp_path, TEKSCAN), layout(tmp_path, "rows = 3\nrate_Hz = 50\nsaturation_kPa = 207"))
    assert mat.rows == 3


def test_places_of_sensors_are_never_taken_from_another_mat(tmp_path: Path) -> None:
    line = refusal(tmp_path, GRID, GRID_LAYOUT + "sensors.left = [[0,0],[0,1],[0,2],[1,0],[1,1],[1,2]]")
    assert line.startswith("sensors of the layout places no cell of 'mat'; write sensors.mat")


def test_a_layout_says_what_a_tekscan_file_leaves_out(tmp_path: Path) -> None:
    bare = "ASCII_DATA @@\n\nFrame 3\n1,2\n3,4\n\nFrame 5\n5,6\n7,8\n"
    said = 'rows = 2\ncolumns = 2\npitch_mm = 5\nunit = "bar"\nrate_Hz = 10\nsaturation_kPa = 700'
    (mat,) = read_mat(write(tmp_path, bare), layout(tmp_path, said))
    np.testing.assert_allclose(mat.pressure, 1e5 * np.arange(1.0, 9.0).reshape(2, 2, 2), rtol=1e-15)
    np.testing.assert_allclose(mat.time, [0.2, 0.4], rtol=1e-15)
    assert mat.saturated.sum() == 2


def test_readings_below_zero_are_kept_with_one_warning(tmp_path: Path) -> None:
    text = GRID.replace("0.5,1.0", "-0.5,-1.25")
    with pytest.warns(InputWarning) as caught:
        (mat,) = read_mat(write(tmp_path, text), layout(tmp_path, GRID_LAYOUT))
    assert [str(w.message).split(": ", 1)[1] for w in caught] == [
        "2 pressures of 'mat' below 0 (lowest -1.25 of the file's unit): an offset, or noise about it"
    ]
    np.testing.assert_allclose(mat.pressure[0], [[-500, -1250, 1500], [2000, 2500, 3000]], rtol=1e-15)


def test_pedar_that_ends_early_is_warned_of(tmp_path: Path) -> None:
    text = PEDAR.replace("total time [secs]:  0.020", "total time [secs]:  9.000")
    with pytest.warns(InputWarning) as caught:
        read_mat(write(tmp_path, text), layout(tmp_path, PEDAR_LAYOUT))
    ends = [str(w.message) for w in caught if "cut off" in str(w.message)]
    assert [line.split(": ", 1)[1] for line in ends] == [
        "the last frame is at 0.02 s of the 9 s in the header; is the file cut off?"
    ]


def test_xsensor_with_a_coarse_clock_follows_its_frames_and_a_rate(tmp_path: Path) -> None:
    text = XSENSOR.replace("23:59:59,900", "10:00:00").replace("00:00:00,000", "10:00:00")
    seat, back = read_mat(write(tmp_path, text), layout(tmp_path, "rate_Hz = 25"))
    np.testing.assert_allclose(seat.time, [0.0, 0.04], rtol=1e-12)
    np.testing.assert_array_equal(back.time, seat.time)


def test_xsensor_without_quotes_and_with_points(tmp_path: Path) -> None:
    text = "\n".join(
        ",".join(cell.replace(",", ".") for cell in next(csv.reader([line]))) for line in XSENSOR.splitlines()[:17]
    )
    (seat,) = read_mat(write(tmp_path, text.replace("Width (in):", "Width (in)").replace("23:59", "2026-02-03 23:59")))
    (quoted, _) = read_mat(write(tmp_path, XSENSOR))
    np.testing.assert_array_equal(seat.pressure, quoted.pressure[:1])
    assert seat.pitch == quoted.pitch


def test_xsensor_that_names_its_unit_above_every_frame_may_change_it(tmp_path: Path) -> None:
    """1 psi is 51.7149 mmHg; the second frame holds the same pressures in psi."""
    names = 'Sensor:,"Seat"\n"10,00","11,25","12,50"\n"13,75","15,00","16,25"'
    in_psi = 'Sensor:,"Seat"\nUnits:,"psi"\n"0,1","0,2","0,3"\n"0,4","0,5","0,6"'
    assert names in XSENSOR
    seat, back = read_mat(write(tmp_path, XSENSOR.replace(names, in_psi)))
    np.testing.assert_allclose(
        seat.pressure[1], 6894.757293168361 * np.array([[0.1, 0.2, 0.3], [0.4, 0.5, 0.6]]), rtol=1e-12
    )
    np.testing.assert_allclose(seat.pressure[0, 1], 133.322387415 * np.array([3.75, 5.0, 6.25]), rtol=1e-12)
    np.testing.assert_allclose(back.pressure[1], 6894.757293168361 * np.array([[2.5, 3.5]]), rtol=1e-12)


ONE_FRAME = '"1","1","1"\n"1","1","1"\n'
SEAT = XSENSOR.split("\n\nSensor:", 1)[0]


@pytest.mark.parametrize(
    ("first", "later", "declared", "expected"),
    [
        ("mmHg", ("psi", None), "", "line 19: Units is psi and was not before, and 1 frames of the sensor name none"),
        (None, ("psi", "psi"), 'unit = "mmHg"', "line 18: Units is psi and was not before, and 1 frames of the"),
        ("mmHg", ("psi", "counts"), "", "line 24: Units is 'counts', which is not a unit of pressure"),
    ],
)
def test_xsensor_whose_unit_changes_where_frames_name_none_is_refused(
    tmp_path: Path, first: str | None, later: tuple[str | None, ...], declared: str, expected: str
) -> None:
    text = SEAT if first else SEAT.replace('Units:,"mmHg"\n', "")
    for k, unit in enumerate(later):
        text += f'\nTime:,"00:00:0{k},500"\n' + (f'Units:,"{unit}"\n' if unit else "") + ONE_FRAME
    line = refusal(tmp_path, text, declared)
    assert line.startswith(expected), line


def test_xsensor_may_say_the_same_again_in_other_words(tmp_path: Path) -> None:
    text = XSENSOR.replace('"2"\nTime', '"2"\nUnits:,"MMHG"\nSensel Width (cm):,"1,27"\nTime')
    assert text != XSENSOR
    for one, other in zip(read_mat(write(tmp_path, text)), read_mat(write(tmp_path, XSENSOR)), strict=True):
        np.testing.assert_array_equal(one.pressure, other.pressure)


def test_clock_of_twelve_hours(tmp_path: Path) -> None:
    text = XSENSOR.replace("23:59:59,900", "11:59:59.5 AM").replace("00:00:00,000", "12:00:01.5 PM")
    seat, _ = read_mat(write(tmp_path, text))
    np.testing.assert_allclose(seat.time, [0.0, 2.0], rtol=1e-12)


def test_values_beyond_the_limit_are_refused_before_they_are_kept(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mat_text, "MOST_VALUES", 20)
    assert refusal(tmp_path, TEKSCAN).startswith("line 31: more than the 20 values that are read")
    monkeypatch.setattr(mat_text, "LARGEST_RECORDING", 100)
    assert refusal(tmp_path, TEKSCAN).endswith("that are read; export it in parts")


@pytest.mark.parametrize("line", ["a" + " " * 900_000, '"' * 900_000, "Sensor (" * 90_000, "time " + " " * 900_000])
def test_long_lines_do_not_hang(tmp_path: Path, line: str) -> None:
    for kind in READERS:
        refusal(tmp_path, f"{line}\n{line}\n", GRID_LAYOUT, kind)
    refusal(tmp_path, f"{line}\n", GRID_LAYOUT)


def _damaged(data: bytes, chance: random.Random) -> bytes:
    """A file with one to four bytes changed, taken out or doubled, or cut off."""
    damaged = bytearray(data)
    for _ in range(chance.randint(1, 4)):
        place = chance.randrange(len(damaged))
        match chance.randrange(4):
            case 0:
                damaged[place] = chance.choice(b'0123456789,.;\t\n"-eB@ \xb2\xff')
            case 1:
                del damaged[place + 1 : place + chance.randint(2, 30)]
            case 2:
                damaged[place:place] = damaged[place : place + chance.randint(1, 60)]
            case _:
                del damaged[max(place, 1) :]
    return bytes(damaged)


@pytest.mark.parametrize("kind", SAMPLES)
def test_damaged_files_give_finite_frames_or_one_line(tmp_path: Path, kind: str) -> None:
    sample, declared = SAMPLES[kind]
    said = layout(tmp_path, declared) if declared else None
    chance = random.Random(7)
    read, refusals = 0, []
    for _ in range(400):
        path = write(tmp_path, _damaged(sample.encode(), chance) or b"x")
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            warnings.simplefilter("ignore", InputWarning)
            try:
                mats = read_mat(path, said, kind)
            except InputError as error:
                refusals.append(str(error))
                continue
        read += 1
        for mat in mats:
            assert len(mat.time)
            assert mat.valid.any()
            assert np.isfinite(mat.pressure[:, mat.valid]).all()
    assert all(line.isprintable() for line in refusals)
    assert len(refusals) > 50
    assert read > 20


TABBED = "time [s]\t1\t2\t3\t4\t5\t6\n0\t0\t1,234\t15\t12,500\t3\t{}\n1\t0\t1\t2\t3\t4\t5\n"


def test_commas_that_may_part_thousands_are_not_guessed(tmp_path: Path) -> None:
    """1,234 is 1234 Pa or 1.234 kPa; a cell as 0,125 or 1,25 shows that the comma is a decimal one."""
    said = refusal(tmp_path, TABBED.format("7"), GRID_LAYOUT)
    assert said.startswith("'1,234' may be thousands or have a decimal comma, as every cell with a comma; say decimal")
    for shows, value in (("0,125", 0.125), ("1,25", 1.25)):
        (found,) = read_mat(write(tmp_path, TABBED.format(shows)), layout(tmp_path, GRID_LAYOUT), None)
        assert found.pressure[0, 0, 1] == pytest.approx(1234.0) and found.pressure[0, 1, 2] == pytest.approx(
            1e3 * value
        )
    declared = GRID_LAYOUT + 'decimal = ","\n'
    (found,) = read_mat(write(tmp_path, TABBED.format("7")), layout(tmp_path, declared), None)
    assert found.pressure[0, 0, 1] == pytest.approx(1234.0)
