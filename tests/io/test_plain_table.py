"""Tables as spreadsheets of half the world write them give the numbers of the same table with commas and points."""

from __future__ import annotations

import csv
import sys
from collections.abc import Callable
from io import StringIO
from pathlib import Path

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.cases.trial_table import read_trial
from geocontact.io.motion.motion import read_motion
from geocontact.io.recordings.area_table import read_area_table, read_force_curves, read_radius_profile
from geocontact.io.recordings.elbow_recording import read_elbow_recording
from geocontact.io.recordings.load_cells import read_cycle_table, read_load_cells
from geocontact.io.recordings.spheres import read_spheres
from geocontact.io.text.column_names import ColumnNames
from geocontact.io.text.plain_table import open_plain
from geocontact.io.text.side_table import LARGEST_RESULT, read_side_table
from geocontact.io.text.tables import read_table

TABLES: dict[str, tuple[Callable[[Path], object], str]] = {
    "poses": (
        lambda path: read_motion(path).poses.as_matrix(),
        "time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz\n0.05,1.25,0.5,3.1,1,0,0,0\n0.5,2.5,0.5,3.1,0,1,0,0\n",
    ),
    "forces": (
        lambda path: read_force_curves(path, None, {}).forces["total"],
        "time [s],medial [N],lateral [N]\n0.05,300.5,200\n0.5,310.5,220\n",
    ),
    "load cells": (
        lambda path: read_load_cells(path, ("AM", "PL"), "lbf", {}).forces,
        "time [s],AM,PL\n0.05,30.5,20\n0.5,31.5,22\n",
    ),
    "elbow": (
        lambda path: read_elbow_recording(path, {}, None, None).force,
        "time [s],beta [deg],force [N]\n0.05,10.5,2.5\n0.5,60.5,3.5\n1.5,90.5,1.5\n",
    ),
    "trial": (
        lambda path: read_trial(path).signals.column("beta"),
        "time [s],beta [deg],force [N]\n0.05,10.5,2.5\n0.5,60.5,\n",
    ),
    "spheres": (
        lambda path: read_spheres(path).centre,
        "px [m],py [m],pz [m],radius [m],zone\n0.05,0.02,0.015,0.02,heel\n0.15,0.02,0.015,0.02,toe\n",
    ),
    "areas": (
        lambda path: read_area_table([path]).areas["total"],
        "time [s],threshold [mm],area_fixed [mm^2]\n" + "".join(f"{k / 8},4,{100.5 + k}\n" for k in range(8)),
    ),
    "profile": (
        lambda path: read_radius_profile(path)["whole"].radius,
        "side,flexion [deg],radius [mm]\nwhole,0.5,33.5\nwhole,10.5,30.5\n",
    ),
    "cycles": (
        lambda path: read_cycle_table(path)[0].end,
        "style,recording,start [s],end [s]\nnormal,a,0.05,1.25\n",
    ),
}
EVERY = pytest.mark.parametrize(("reader", "text"), TABLES.values(), ids=TABLES.keys())


def written(folder: Path, text: str, name: str = "table.csv") -> Path:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def semicolons(text: str) -> str:
    return text.replace(",", ";").replace(".", ",")


def capitals(text: str) -> str:
    """Names in capitals, units as they are."""
    head, _, rest = text.partition("\n")
    cells = [name.upper() + unit for name, _, unit in (cell.partition(" ") for cell in head.split(","))]
    return ",".join(c.replace("[", " [") for c in cells) + "\n" + rest


@EVERY
def test_semicolons_and_decimal_commas_give_the_same(reader: Callable, text: str, tmp_path: Path) -> None:
    plain, other = written(tmp_path, text), written(tmp_path, "\ufeff" + semicolons(text), "german.csv")
    np.testing.assert_array_equal(reader(other), reader(plain))


@EVERY
def test_empty_rows_at_the_end_are_none(reader: Callable, text: str, tmp_path: Path) -> None:
    width = text.partition("\n")[0].count(",")
    more = text + ("," * width + "\n") * 3 + "\n"
    expected = reader(written(tmp_path, text))
    for name, each in (("a.csv", more), ("b.csv", semicolons(more)), ("c.csv", more.replace("\n", "\r\n"))):
        (tmp_path / name).write_bytes(each.encode())
        np.testing.assert_array_equal(reader(tmp_path / name), expected)


@EVERY
def test_names_are_found_without_regard_to_case(reader: Callable, text: str, tmp_path: Path) -> None:
    expected = reader(written(tmp_path, text))
    np.testing.assert_array_equal(reader(written(tmp_path, capitals(text))), expected)


@EVERY
def test_workbooks_give_the_same(reader: Callable, text: str, tmp_path: Path) -> None:
    pytest.importorskip("openpyxl", reason="reads .xlsx")
    book = workbook(tmp_path / "table.xlsx", text)
    np.testing.assert_array_equal(reader(book), reader(written(tmp_path, text)))


def workbook(file: Path, text: str, *more: str) -> Path:
    """A workbook of these tables, one sheet each."""
    import openpyxl

    book = openpyxl.Workbook()
    for k, each in enumerate((text, *more)):
        sheet = book.active if k == 0 else book.create_sheet()
        for row in csv.reader(StringIO(each)):
            sheet.append([float(cell) if cell.replace(".", "").isdigit() else cell or None for cell in row])
    book.save(file)
    return file


def test_other_sheets_are_told_of(tmp_path: Path) -> None:
    pytest.importorskip("openpyxl", reason="reads .xlsx")
    text = TABLES["forces"][1]
    with pytest.warns(InputWarning, match="sheet 'Sheet' is read, not Sheet1"):
        read_table(workbook(tmp_path / "two.xlsx", text, text))


def test_a_workbook_that_is_none(tmp_path: Path) -> None:
    pytest.importorskip("openpyxl", reason="reads .xlsx")
    with pytest.raises(InputError, match=r"table.xlsx: cannot be read as a workbook .*; save it again, or as .csv"):
        read_table(written(tmp_path, "no workbook", "table.xlsx"))


def test_without_what_reads_workbooks_it_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "openpyxl", None)
    with pytest.raises(InputError, match=r"x.xlsx: reading .xlsx needs openpyxl; pip install openpyxl, or save"):
        read_table(written(tmp_path, "", "x.xlsx"))


DOUBTS = {
    "points as well": ("time [s];a [N]\n0,05;1.5\n", "line 2: '0,05' has a comma and '1.5' in line 2 a point"),
    "thousands": ("time [s];a [N]\n1;1,150\n2;1,250\n", "line 2: '1,150' may be thousands or have a decimal comma"),
    "both in one": ("time [s];a [N]\n0,5;1.234,5\n", "line 2: '1.234,5' has a comma and a point"),
}


@pytest.mark.parametrize(("text", "message"), DOUBTS.values(), ids=DOUBTS.keys())
def test_what_may_mean_two_things_is_refused(text: str, message: str, tmp_path: Path) -> None:
    with pytest.raises(InputError) as caught:
        read_table(written(tmp_path, text))
    assert f"table.csv {message}" in str(caught.value)


def test_one_cell_that_can_only_be_a_decimal_comma_settles_it(tmp_path: Path) -> None:
    table = read_table(written(tmp_path, "time [s];a [N]\n0,000;1,150\n0,010;1,250\n"))
    np.testing.assert_array_equal(table.needed("a"), [1.15, 1.25])


def test_notes_above_the_header_are_passed_over(tmp_path: Path) -> None:
    text = "# synthetic, made 2026\n# and more\n" + TABLES["trial"][1]
    assert read_trial(written(tmp_path, text)).signals.channels == ("beta", "force")
    with pytest.raises(InputError, match="line 5: 'sixty' in column 'beta' is not a number"):
        read_trial(written(tmp_path, text.replace("60.5", "sixty")))


def test_words_keep_their_commas(tmp_path: Path) -> None:
    file = written(tmp_path, 'zone;px [m]\nheel, medial;0,5\n"a;b";1,5\n')
    table = read_side_table(file)
    assert table["zone"].tolist() == ["heel, medial", "a;b"] and table["px [m]"].tolist() == [0.5, 1.5]


def test_lines_keep_their_numbers(tmp_path: Path) -> None:
    file = written(tmp_path, "# point_mm = 1, 2, 3\n\ntime [s];a [N]\n0,5;1\n1,5;eleven\n".replace("\n\n", "\n"))
    with pytest.raises(InputError, match="line 4: 'eleven' in column 'a' is not a number"):
        read_table(file)
    with open_plain(file) as stream:
        assert stream.readline() == "# point_mm = 1, 2, 3\n"


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], deadline=None, max_examples=50)
@given(st.lists(st.tuples(st.floats(-1e6, 1e6), st.floats(-1e6, 1e6)), min_size=2, max_size=5))
def test_numbers_survive_the_comma_exactly(tmp_path: Path, rows: list[tuple[float, float]]) -> None:
    lines = [f"0,{k}5;" + ";".join(repr(float(value)).replace(".", ",") for value in row) for k, row in enumerate(rows)]
    table = read_table(written(tmp_path, "time [s];a [N];b [N]\n" + "\n".join(lines) + "\n"))
    np.testing.assert_array_equal(table.values, np.array(rows))


def test_a_name_as_written_comes_before_one_that_is_alike() -> None:
    names = ColumnNames(("X", "x", "Force", "A", "a"))
    assert (names.index("X"), names.index("x"), names.index("force")) == (0, 1, 2)
    assert "FORCE" in names and "y" not in names
    assert ColumnNames(("Fx", "FX")).count("fx") == 2
    with pytest.raises(ValueError, match="not in tuple"):
        ColumnNames(("Fx", "FX")).index("fx")


def test_results_of_an_hour_at_a_hundred_hertz_are_read(tmp_path: Path) -> None:
    """12 MB, of the 45 MB of an arm's results: more than small tables have, numbers in 8 bytes each."""
    row = ",".join(["0.123456789"] * 10)
    file = tmp_path / "arm.csv"
    head = ",".join(["time [s]", *(f"c{k} [deg]" for k in range(10)), "zone"])
    file.write_text(head + "\n" + "".join(f"{0.01 * k:.2f},{row},a\n" for k in range(90_000)), "utf-8")
    table = read_side_table(file, (), LARGEST_RESULT)
    assert file.stat().st_size > 11e6 and table.shape == (90_000, 12)
    assert table["time [s]"].iloc[-1] == pytest.approx(899.99, abs=1e-9)
    assert table["c9 [rad]"].iloc[-1] == pytest.approx(np.deg2rad(0.123456789), rel=1e-15)
    assert (table["zone"] == "a").all()
