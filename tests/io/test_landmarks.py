"""Files of landmarks: as a page saves them, as hands and spreadsheets change them, and what is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.io.recordings.landmarks import read_landmarks

SHA = "0123456789abcdef" * 4
SAVED = (
    f"# landmarks picked by hand\n# mesh = femur, left.stl\n# mesh_sha256 = {SHA}\n# unit = mm\n"
    "# frame = that of the mesh file (LPS: x to the left, y to the back, z up)\n"
    'id,x [mm],y [mm],z [mm]\nL1,1.5,-2.25,1013.7001953\n"epicondyle, medial",0,0,-1e-3\n'
)


def spreadsheet(text: str, separator: str = ",") -> str:
    """The same cells as a spreadsheet saves them: rows of one length, Windows line ends."""
    rows = [line + separator * 3 if line.startswith("#") else line for line in text.splitlines()]
    return "".join(f"{row}\r\n" for row in rows)


WAYS = {
    "as saved": SAVED.encode(),
    "Windows line ends": SAVED.replace("\n", "\r\n").encode(),
    "byte order mark": b"\xef\xbb\xbf" + SAVED.encode(),
    "spreadsheet": spreadsheet(SAVED).encode(),
    "no line end at the end": SAVED.rstrip("\n").encode(),
    "blank rows at the end": (SAVED + "\n,,,\n").encode(),
    "upper case": SAVED.replace("x [mm]", "X [mm]").encode(),
}


@pytest.mark.parametrize("way", WAYS)
def test_the_same_points_however_it_was_saved(tmp_path: Path, way: str) -> None:
    (tmp_path / "picked.csv").write_bytes(WAYS[way])
    found = read_landmarks(tmp_path / "picked.csv")
    assert found.names == ("L1", "epicondyle, medial")
    assert found.points == pytest.approx(np.array([[1.5e-3, -2.25e-3, 1.0137001953], [0.0, 0.0, -1e-6]]), rel=1e-15)
    assert (found.mesh, found.sha256, found.unit) == ("femur, left.stl", SHA, "mm")
    assert found.frame.startswith("that of the mesh file (LPS:")
    assert found.point("L1").tolist() == found.points[0].tolist()


def test_semicolons_and_decimal_commas(tmp_path: Path) -> None:
    rows = "id;x [cm];y [cm];z [cm]\nA;1,5;-2,25;0,5\n"
    (tmp_path / "picked.csv").write_text(spreadsheet(f"# mesh_sha256 = {SHA}\n# unit = cm\n", ";") + rows)
    found = read_landmarks(tmp_path / "picked.csv")
    assert found.points[0] == pytest.approx([1.5e-2, -2.25e-2, 0.5e-2], rel=1e-15)
    assert (found.unit, found.sha256) == ("cm", SHA)


def test_a_table_by_hand_says_nothing_of_its_mesh(tmp_path: Path) -> None:
    (tmp_path / "mine.csv").write_text("id,x [m],y [m],z [m]\nA,1,2,3\n")
    found = read_landmarks(tmp_path / "mine.csv")
    assert (found.mesh, found.sha256, found.unit, found.frame) == ("", "", "", "")
    assert found.points.tolist() == [[1.0, 2.0, 3.0]]


REFUSED = {
    "a name twice": (SAVED + "L1,1,1,1\n", "id L1 occurs twice"),
    "a name twice by a space": (SAVED + " L1 ,1,1,1\n", "id L1 occurs twice"),
    "no name": (SAVED + ",1,1,1\n", "line 9"),
    "no z": (SAVED.replace(",z [mm]", ",w [mm]"), "line 6: no column z with a unit of length"),
    "no unit": (SAVED.replace("z [mm]", "z"), "line 6: no column z"),
    "an angle": (SAVED.replace("z [mm]", "z [deg]"), "line 6: no column z"),
    "another unit in the columns": (SAVED.replace("[mm]", "[m]"), "line 6: the columns are in m, and the mesh in mm"),
    "another unit of one column": (SAVED.replace("y [mm]", "y [cm]"), "the columns are in cm"),
    "an unknown unit": (SAVED.replace("unit = mm", "unit = furlong"), "line 4: unit is 'furlong'"),
    "a short hash": (SAVED.replace(SHA, SHA[:-1]), "line 3: mesh_sha256 is"),
    "not a number": (SAVED.replace("-2.25", "?"), "line 7"),
    "not finite": (SAVED.replace("-2.25", "nan"), "line 7"),
    "an empty coordinate": (SAVED.replace("-2.25", ""), "line 7"),
    "no rows": (SAVED[: SAVED.index("L1")], "no rows below the column names"),
    "nothing": ("", "the file is empty"),
}


@pytest.mark.parametrize("what", REFUSED)
def test_refused_in_one_line(tmp_path: Path, what: str) -> None:
    text, words = REFUSED[what]
    (tmp_path / "picked.csv").write_text(text)
    with pytest.raises(InputError) as caught:
        read_landmarks(tmp_path / "picked.csv")
    said = str(caught.value)
    assert words in said and "picked.csv" in said
    assert "\n" not in said


def test_a_landmark_that_is_not_there_names_those_that_are(tmp_path: Path) -> None:
    (tmp_path / "picked.csv").write_text(SAVED)
    with pytest.raises(InputError, match=r"has no landmark 'L2'.*L1"):
        read_landmarks(tmp_path / "picked.csv").point("L2")


def test_a_sheet_keeps_what_stands_above_its_table(tmp_path: Path) -> None:
    openpyxl = pytest.importorskip("openpyxl")
    book = openpyxl.Workbook()
    for row in (
        [f"# mesh_sha256 = {SHA}"],
        ["# unit = mm"],
        ["id", "x [mm]", "y [mm]", "z [mm]"],
        ["A", 1.0, 2.0, 3.5],
    ):
        book.active.append(row)
    book.save(tmp_path / "picked.xlsx")
    found = read_landmarks(tmp_path / "picked.xlsx")
    assert (found.sha256, found.unit) == (SHA, "mm")
    assert found.points[0] == pytest.approx([1e-3, 2e-3, 3.5e-3], rel=1e-15)
