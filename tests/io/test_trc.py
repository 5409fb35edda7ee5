"""Marker files: units, gaps, counts that do not fit."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.mocap.trc import read_trc

HEAD = (
    "PathFileType\t4\t(X/Y/Z)\twalk.trc\n"
    "DataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\tOrigDataRate\tOrigDataStartFrame\tOrigNumFrames\n"
    "100\t100\t3\t2\tmm\t100\t1\t3\n"
    "Frame#\tTime\tHeel\t\t\tR.Toe Tip\t\t\t\n"
    "\t\tX1\tY1\tZ1\tX2\tY2\tZ2\t\n"
    "\n"
)
ROWS = "1\t0.00\t1\t2\t3\t4\t5\t6\t\n2\t0.01\t\t\t\t7\t8\t9\n3\t0.02\t10\t20\t30\n"
GOOD = HEAD + ROWS


def written(folder: Path, text: str) -> Path:
    file = folder / "walk.trc"
    file.write_text(text, encoding="utf-8")
    return file


def test_markers_in_metres_and_gaps(tmp_path: Path) -> None:
    seen = read_trc(written(tmp_path, GOOD))
    assert seen.names == ("Heel", "R.Toe Tip")
    np.testing.assert_allclose(seen.time, [0.0, 0.01, 0.02])
    np.testing.assert_allclose(seen.positions[0], [[0.001, 0.002, 0.003], [0.004, 0.005, 0.006]])
    assert np.isnan(seen.positions[1, 0]).all()
    np.testing.assert_allclose(seen.positions[1, 1], [0.007, 0.008, 0.009])
    assert np.isnan(seen.positions[2, 1]).all()  # cells that are missing at the end of a line


def test_values_between_which_there_are_several_tabs(tmp_path: Path) -> None:
    """As older programs of motion capture wrote line 3, with blanks beside the numbers."""
    line = "  100.0\t\t  100.0\t\t      3\t\t      2\t\t mm\t  100.0\t      1\t      3"
    seen = read_trc(written(tmp_path, GOOD.replace("100\t100\t3\t2\tmm\t100\t1\t3", line)))
    np.testing.assert_array_equal(seen.positions, read_trc(written(tmp_path, GOOD)).positions)


def test_metres_stay_metres(tmp_path: Path) -> None:
    seen = read_trc(written(tmp_path, GOOD.replace("\tmm\t", "\tm\t")))
    np.testing.assert_allclose(seen.positions[0, 0], [1.0, 2.0, 3.0])


def test_half_a_marker_is_none(tmp_path: Path) -> None:
    seen = read_trc(written(tmp_path, GOOD.replace("\t7\t8\t9", "\t7\t\t9")))
    assert np.isnan(seen.positions[1, 1]).all()


def test_zeros_are_said_to_be_gaps(tmp_path: Path) -> None:
    with pytest.warns(InputWarning, match="1 markers at exactly 0 0 0 are taken as not seen"):
        seen = read_trc(written(tmp_path, GOOD.replace("\t4\t5\t6", "\t0\t0\t0")))
    assert np.isnan(seen.positions[0, 1]).all()


def test_frames_and_markers_are_chosen(tmp_path: Path) -> None:
    seen = read_trc(written(tmp_path, GOOD))
    assert len(seen.between(0.005, 0.02)) == 2
    of = seen.of(("R.Toe Tip", "none such"))
    np.testing.assert_allclose(of[0, 0], [0.004, 0.005, 0.006])
    assert np.isnan(of[:, 1]).all()


BAD = {
    "another file": ("time,x\n0,1\n", "line 1: does not begin with 'PathFileType'"),
    "markers are missing": (GOOD.replace("100\t3\t2\tmm", "100\t3\t4\tmm"), "line 3: NumMarkers is '4' but 2 markers"),
    "a unit nobody knows": (GOOD.replace("\tmm\t", "\tft\t"), "line 3: unit is 'ft'; expected one of m, cm, mm"),
    "time runs back": (GOOD.replace("0.02", "0.005"), "line 9: time does not increase"),
    "a word for a number": (GOOD.replace("\t7\t8\t9", "\tseven\t8\t9"), "line 8"),
    "too many cells": (GOOD.replace("\t5\t6\t\n", "\t5\t6\t7\n"), "line 7: more cells where 8 columns"),
}


@pytest.mark.parametrize(("text", "message"), BAD.values(), ids=BAD.keys())
def test_what_contradicts_itself_is_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError) as error:
        read_trc(written(tmp_path, text))
    assert message in str(error.value)


def test_a_count_of_frames_that_does_not_fit_is_told(tmp_path: Path) -> None:
    """As OpenSim reads it: all rows, whatever the head says; units in capitals too."""
    text = (HEAD + ROWS.splitlines()[0] + "\n").replace("\tmm\t", "\tMM\t")
    with pytest.warns(InputWarning, match="line 3: NumFrames is '3' but 1 frames follow; all are read"):
        assert len(read_trc(written(tmp_path, text))) == 1


def test_a_name_that_is_there_twice_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="marker 'Heel' is there 2 times"):
        read_trc(written(tmp_path, GOOD.replace("R.Toe Tip", "Heel")))


def test_times_rounded_to_milliseconds_are_even_again(tmp_path: Path) -> None:
    """60 Hz in milliseconds is 0.017, 0.033 …; what is off by more than rounding stays as the file has it."""
    rows = "".join(f"{k + 31}\t{(k + 30) / 60:.3f}\t1\t2\t3\t4\t5\t6\n" for k in range(7))
    text = (HEAD + rows).replace("100\t100\t3\t", "60\t60\t7\t", 1)
    np.testing.assert_allclose(read_trc(written(tmp_path, text)).time, (30 + np.arange(7)) / 60, atol=1e-12)
    late = text.replace("0.533", "0.531")
    assert read_trc(written(tmp_path, late)).time[2] == 0.531


TRUE = np.arange(1.0, 19.0).reshape(3, 2, 3)
"""mm, frame by frame of two named markers."""


def with_unnamed(counted: int, *, between: bool = False, seen: bool = True) -> str:
    """Two named markers and two without a name behind them, or between: every row has cells of all four."""
    names = ["Heel", "", "", "Toe"] if between else ["Heel", "Toe", "", ""]
    rows = []
    for k, (heel, toe) in enumerate(TRUE):
        others = [[900.0 + k] * 3 if seen else [""] * 3] * 2
        places = [heel, *others, toe] if between else [heel, toe, *others]
        rows.append("\t".join([f"{k + 1}", f"{k / 100:.2f}", *(str(x) for place in places for x in place)]))
    head = HEAD.replace("\t3\t2\tmm", f"\t3\t{counted}\tmm").replace(
        "Heel\t\t\tR.Toe Tip", "\t\t\t".join(names).rstrip()
    )
    return head + "\n".join(rows) + "\n"


@pytest.mark.parametrize("counted", [2, 4])
@pytest.mark.parametrize("between", [False, True])
def test_markers_without_a_name_are_passed_over(counted: int, between: bool, tmp_path: Path) -> None:
    """As Cortex writes them, counted in line 3 or not; those between the named ones shift no column."""
    with pytest.warns(InputWarning, match="2 markers without a name are passed over") as said:
        seen = read_trc(written(tmp_path, with_unnamed(counted, between=between)))
    assert len(said) == 1
    assert seen.names == ("Heel", "Toe")
    np.testing.assert_allclose(seen.positions, TRUE * 1e-3)


def test_unnamed_markers_that_were_never_seen_may_be_counted(tmp_path: Path) -> None:
    seen = read_trc(written(tmp_path, with_unnamed(4, seen=False)))
    np.testing.assert_allclose(seen.positions, TRUE * 1e-3)


def test_a_count_above_all_that_is_there_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="line 3: NumMarkers is '7' but 2 markers are named"):
        read_trc(written(tmp_path, with_unnamed(7)))


def test_blanks_for_tabs_are_named_as_such(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="line 4: has blanks between its columns, not tabs; export it with tabs"):
        read_trc(written(tmp_path, GOOD.replace("\t", " ")))


def test_a_file_without_any_name_is_refused_as_such(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="line 4: names no marker; name the markers where it was recorded"):
        read_trc(written(tmp_path, GOOD.replace("Heel\t\t\tR.Toe Tip", "")))
