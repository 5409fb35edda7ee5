"""`geocontact rerun run.json` runs again as recorded and says what differs; a folder is overwritten unless told not."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

import geocontact as gc
from geocontact.analyses.frame.folder import digest
from geocontact.analyses.frame.rerun import differing
from tests.cli.calls import PLATE, SPHERE, Call, area, call, done, inventory, poses, written


def first(folder: Path, *options: object) -> Call:
    motion = poses(folder, (0, 20, 0), (0, 21, 0))
    return done(area(folder / "out", *options, moving=SPHERE, fixed=PLATE, motion=motion, picture=True))


def test_the_same_inputs_give_the_same_files(tmp_path: Path) -> None:
    out = first(tmp_path, "--threshold", "1,4", "--parquet", "--netcdf").folder
    before = inventory(out)
    result = done(call("rerun", out / "run.json", "--out", tmp_path / "again"))
    assert result.out.splitlines()[-2:] == [
        "the inputs are the same",
        f"6 of 6 files of the results are equal; new ones in {tmp_path / 'again'}",
    ]
    again = inventory(tmp_path / "again")
    assert {**again, "run.json": None} == {**before, "run.json": None} and inventory(out) == before
    told = [json.loads(each["run.json"])["options"] for each in (before, again)]
    assert told[1] == {**told[0], "out": str(tmp_path / "again")}


@pytest.mark.drawn
def test_an_input_that_has_changed_is_named_and_so_is_what_differs(tmp_path: Path) -> None:
    out = first(tmp_path).folder
    motion = poses(tmp_path, (0, 20, 0), (0, 22, 0))
    result = call("rerun", out)
    assert result.code == 1 and result.err == ""
    lines = result.out.splitlines()
    assert f"input has changed: {motion}" in lines and "area.csv differs" in lines
    assert lines[-1] == "0 of 4 files of the results are equal"


def test_what_python_wrote_is_run_again_too(tmp_path: Path) -> None:
    result = gc.area(SPHERE, PLATE, unit="mm", motion=poses(tmp_path, (0, 20, 0)), threshold=gc.mm(4), rule="clip")
    result.write(tmp_path / "out", netcdf=True)
    assert done(call("rerun", tmp_path / "out")).out.splitlines()[-1] == "5 of 5 files of the results are equal"


@pytest.mark.slow
def test_several_motions_are_compared_folder_by_folder(tmp_path: Path) -> None:
    motions = [poses(tmp_path, (0, 20, 0), name=f"{name}.csv") for name in ("slow", "fast")]
    out = tmp_path / "out"
    done(area(out, *(f"--motion={each}" for each in motions), moving=SPHERE, fixed=PLATE, picture=True))
    assert done(call("rerun", out)).out.splitlines()[-1] == "8 of 8 files of the results are equal"


@pytest.mark.parametrize("time", ["seconds", "cpu_seconds", "frames_per_second"])
def test_the_time_a_run_took_is_no_difference(time: str, tmp_path: Path) -> None:
    """In files of JSON and in columns of tables; every other value is one, and a column that one run has not."""
    old, new = tmp_path / "old", tmp_path / "new"
    tables = {"c.csv": "x,wall [s]\n1,{}\n", "d.csv": "x,wall [s]\n{},2\n", "e.csv": "x,cpu [s],z{}\n1,2,3\n"}
    for folder, seconds, value in ((old, 1.0, 3), (new, 2.0, 3)):
        folder.mkdir()
        written(folder / "a.json", json.dumps({time: seconds, "value": value}))
        written(folder / "b.json", json.dumps({time: seconds, "value": seconds}))
        for name, text in tables.items():
            written(folder / name, text.format(seconds))
    hashes = [{name: digest(folder / name) for name in ("a.json", "b.json", *tables)} for folder in (old, new)]
    assert differing(*hashes, old, new) == ["b.json", "d.csv", "e.csv"]


def test_angles_of_markers_are_equal_though_the_machine_is_slower(tmp_path: Path) -> None:
    """`ik.json` has the frames per second of the machine."""
    done(call("markers", "meshes/leg_swing.mot", "--model", "meshes/leg.osim", "--out", tmp_path / "m"))
    done(call("ik", tmp_path / "m" / "markers.trc", "--model", "meshes/leg.osim", "--out", tmp_path / "ik"))
    kept = json.loads((tmp_path / "ik" / "ik.json").read_text("utf-8"))["frames_per_second"]
    result = done(call("rerun", tmp_path / "ik", "--out", tmp_path / "again"))
    again = json.loads((tmp_path / "again" / "ik.json").read_text("utf-8"))["frames_per_second"]
    assert kept != again and "differs" not in result.out


REFUSED = {
    "no file": ("", "there is no such file"),
    "no JSON": ("area", "is not JSON; name the run.json that a command or `Result.write` left"),
    "other JSON": ('{"a": 1}', "is not a run.json of geocontact"),
    "unknown command": ('{"command": "aera", "options": {}, "inputs": []}', "'aera' is not a command here"),
    "no analysis": ('{"command": "doctor", "options": {}, "inputs": []}', "'doctor' is not an analysis"),
    "input gone": ('{"command": "area", "options": {}, "inputs": [{"file": "gone.stl"}]}', "gone.stl: is not there"),
}


@pytest.mark.parametrize(("text", "line"), REFUSED.values(), ids=REFUSED.keys())
def test_what_cannot_be_run_again_is_refused_in_one_line(text: str, line: str, tmp_path: Path) -> None:
    if text:
        written(tmp_path / "run.json", text)
    result = call("rerun", tmp_path / "run.json")
    assert result.code == 2 and len(result.complaints) == 1 and line in result.err


def test_results_are_kept_when_told_so(tmp_path: Path) -> None:
    out = first(tmp_path).folder
    before = inventory(out)
    motion = poses(tmp_path, (0, 23, 0))
    kept = area(out, "--no-overwrite", moving=SPHERE, fixed=PLATE, motion=motion)
    assert kept.code == 2 and kept.complaints == [
        f"{out}: holds results already (run.json); choose another --out, or allow it to be overwritten"
    ]
    assert inventory(out) == before
    written(tmp_path / "notes.txt", "mine")
    done(area(tmp_path, "--no-overwrite", moving=SPHERE, fixed=PLATE, motion=motion))
    with pytest.raises(gc.InputError, match="holds results already"):
        gc.area(SPHERE, PLATE, unit="mm", motion=motion).write(out, overwrite=False)
