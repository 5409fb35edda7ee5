"""Names of markers: maps, names that are nearly alike, subjects before a colon."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.mocap import c3d_markers
from geocontact.io.mocap.c3d_markers import read_c3d_markers
from geocontact.io.mocap.markers import marker_map_typed, read_marker_map
from geocontact.io.mocap.trc import without_subject
from geocontact.io.text.column_names import near_names


def test_names_alike_but_for_case_marks_and_a_letter() -> None:
    recorded = ("S1:R_HEEL", "lheel", "Sternum", "RASIS", "thigh2")
    wanted = ("R.Heel", "L.Heel", "Sternm", "L.ASIS", "Thigh1", "R.ASIS")
    near = {"R.Heel": "S1:R_HEEL", "L.Heel": "lheel", "Sternm": "Sternum", "R.ASIS": "RASIS"}
    assert near_names(wanted, recorded) == near, "left is never right, one is never two"
    lab = ("R_Toe", "R_ToeMedial", "R_ToeLateral", "R_Knee_Lateral")
    assert near_names(("R.Toe.Lat", "R.Knee.Lat"), lab) == {"R.Toe.Lat": "R_ToeLateral", "R.Knee.Lat": "R_Knee_Lateral"}


@pytest.mark.parametrize(
    "text",
    [
        "RHEE=R.Heel\nLHEE=L.Heel\n",
        "# laboratory A\nrecorded,model\nRHEE,R.Heel\n\nLHEE,L.Heel,\n",
        "RHEE\tR.Heel\nLHEE\tL.Heel\n",
        "lab;model\nRHEE;R.Heel\nLHEE;L.Heel\n",
    ],
    ids=["pairs", "commas", "tabs", "semicolons"],
)
def test_a_map_is_a_pair_in_each_line(tmp_path: Path, text: str) -> None:
    (tmp_path / "map.csv").write_text(text, encoding="utf-8")
    assert read_marker_map(tmp_path / "map.csv") == {"RHEE": "R.Heel", "LHEE": "L.Heel"}


def test_a_map_that_is_none_is_refused(tmp_path: Path) -> None:
    for text, said in (
        ("RHEE\n", "line 1: 'RHEE' is not a"),
        ("A=B\nA=C\n", "line 2: 'A' is named twice"),
        ("#\n", "no pair"),
    ):
        (tmp_path / "map.txt").write_text(text, encoding="utf-8")
        with pytest.raises(InputError, match=said):
            read_marker_map(tmp_path / "map.txt")
    with pytest.raises(InputError, match="`markers_map`: 'b=c=d' is not a recorded marker"):
        marker_map_typed("a=x,b=c=d", "`markers_map`")


def test_subjects_are_left_out_where_names_stay_different() -> None:
    assert without_subject(["S1:a", "S1:b", "c"]) == ["a", "b", "c"]
    assert without_subject(["S1:a", "S2:a"]) == ["S1:a", "S2:a"]


PLACES = np.arange(24.0).reshape(2, 4, 3) + 1.0
"""Of four markers in two frames [mm]."""


@pytest.mark.parametrize("labels", [["A", "B", "", ""], ["", "A", "", "B"], ["A", "B"]])
def test_markers_of_a_c3d_file_without_a_label_are_passed_over(
    labels: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Blank labels, and fewer of them than points: one warning, and no name moves to another marker's places."""
    read = {"frames": 2, "rate": 100.0, "start": 0.0, "positions": PLACES, "names": np.array(labels), "unit": "mm"}
    monkeypatch.setattr(c3d_markers, "read_apart", lambda *_, **__: read)
    with pytest.warns(InputWarning, match="2 markers without a name are passed over") as said:
        seen = read_c3d_markers("a.c3d")
    assert len(said) == 1 and seen.names == ("A", "B")
    at = [labels.index("A"), labels.index("B")]
    np.testing.assert_allclose(seen.positions, 1e-3 * PLACES[:, at])


def test_a_c3d_file_with_blank_labels_is_read(tmp_path: Path) -> None:
    ezc3d = pytest.importorskip("ezc3d")
    content = ezc3d.c3d()
    point = content["parameters"]["POINT"]
    point["LABELS"]["value"], point["RATE"]["value"], point["UNITS"]["value"] = ["A", "", "", "B"], [100.0], ["mm"]
    content["data"]["points"] = np.concatenate([np.moveaxis(PLACES, (0, 1, 2), (2, 1, 0)), np.ones((1, 4, 2))])
    content.write(str(tmp_path / "a.c3d"))
    with pytest.warns(InputWarning, match="2 markers without a name are passed over"):
        seen = read_c3d_markers(tmp_path / "a.c3d")
    np.testing.assert_allclose(seen.positions, 1e-3 * PLACES[:, [0, 3]], rtol=1e-6)
