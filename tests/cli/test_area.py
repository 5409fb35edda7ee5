"""What `geocontact area` writes: files, run.json, exit codes, the folder; numbers are tested in tests/analyses/area."""

from __future__ import annotations

import hashlib
import json
import os
from importlib.metadata import version
from pathlib import Path
from unittest import mock

import numpy as np
import pytest

from geocontact import __version__
from geocontact.cli.main import main
from tests.cli.calls import (
    FEMUR,
    INSERT,
    PLATE,
    SPHERE,
    Call,
    area,
    corners,
    done,
    gait,
    inventory,
    poses,
    shifted,
    stl,
    written,
)
from tests.contract import COLUMNS, FILES


@pytest.fixture(scope="module")
def knee(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """The coarse knee at two frames and three thresholds, split, with its picture."""
    folder = tmp_path_factory.mktemp("knee")
    options = ("--threshold", "0.1,1,4", "--split", "z", "--side", "right")
    return done(area(folder / "out", *options, motion=gait(folder), picture=True))


def test_files_are_the_promised_ones(knee: Call) -> None:
    assert {p.name for p in knee.folder.iterdir()} == FILES
    assert knee.bytes("area.png").startswith(b"\x89PNG\r\n\x1a\n")
    assert b"<svg" in knee.bytes("area.svg")[:1000]
    assert all(name in knee.out for name in (*FILES, str(knee.folder)))


def test_page_names_the_inputs_and_not_where_they_lay(knee: Call) -> None:
    page = knee.bytes("report.html").decode()
    for entry in knee.record()["inputs"]:
        assert entry["sha256"] in page and Path(entry["file"]).name in page
    assert str(knee.folder.parent) not in page and str(FEMUR.parent) not in page


@pytest.mark.parametrize("style", ["repeated option", "shell glob", "quoted pattern"])
def test_several_motions_have_a_folder_each(tmp_path: Path, style: str) -> None:
    first, second = (poses(tmp_path, (0, y, 0), name=f"slow {name}.csv") for y, name in ((20, "walk"), (21, "run")))
    given = {
        "repeated option": ["--motion", first, "--motion", second],
        "shell glob": ["--motion", second, first],
        "quoted pattern": ["--motion", tmp_path / "slow*.csv"],
    }
    result = done(area(tmp_path / "out", *given[style], moving=SPHERE, fixed=PLATE))
    motions = {"slow walk": first, "slow run": second}
    files = {f"{name}/{file}" for name in motions for file in ("area.csv", "run.json")}
    assert set(inventory(result.folder)) == {"run.json", *motions, *files}
    for name, file in motions.items():
        alone = done(area(tmp_path / name, moving=SPHERE, fixed=PLATE, motion=file))
        assert result.bytes(f"{name}/area.csv") == alone.bytes()


def test_beyond_the_tolerance_is_exit_1_and_the_results_are_kept(tmp_path: Path) -> None:
    motion = poses(tmp_path, (0, 20, 0))
    measured = written(tmp_path / "measured.csv", "time [s],area_fixed [mm^2]\n0,500\n")
    given = ("--compare", measured, "--tolerance", "1%")
    result = area(tmp_path / "out", *given, moving=SPHERE, fixed=PLATE, motion=motion)
    assert (result.code, result.complaints) == (1, []), result.err
    assert set(inventory(result.folder)) == {"area.csv", "comparison.csv", "run.json"}
    assert "beyond the tolerance of 1.00%" in result.out


def test_reservations_are_lines_on_stderr_and_in_the_record(tmp_path: Path) -> None:
    points = corners(SPHERE)
    moving = written(tmp_path / "open.stl", stl(np.delete(points, np.argmax(points[:, :, 1].mean(axis=1)), axis=0)))
    result = done(area(tmp_path / "out", moving=moving, fixed=PLATE, motion=poses(tmp_path, (0, 20, 0))))
    assert len(result.warnings) == 1 and "open.stl is open" in result.warnings[0]
    assert result.record()["warnings"] == result.warnings


def test_options_of_two_spellings_are_recorded_as_typed_and_in_si(tmp_path: Path) -> None:
    given = ("--threshold", "1,4mm", "--medial", "+", "--split", "z", "--bounds", "5%", "--adduction", "x=2")
    result = done(area(tmp_path / "out", *given, moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, (0, 20, 0))))
    told = result.record()
    assert {name: told["options"][name] for name in ("threshold", "bounds", "adduction")} == {
        "threshold": "1,4mm",
        "bounds": "5%",
        "adduction": "x=2",
    }
    assert told["options_si"]["threshold [m]"] == [1e-3, 4e-3] and told["options_si"]["bounds"] == 0.05
    axis, angle = told["options_si"]["adduction [rad]"]
    assert (axis, angle) == ("x", pytest.approx(np.radians(2.0)))
    assert set(result.table()["adduction offset [deg]"]) == {2.0}


def test_empty_cells_stand_for_what_is_not_there(tmp_path: Path) -> None:
    """A sphere 1 mm above a plate: nothing within 0.5 mm, so no centroid."""
    done(area(tmp_path / "out", "--threshold", "0.5", moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, (3, 21, -2))))
    cells = (tmp_path / "out/area.csv").read_text(encoding="utf-8").splitlines()[1].split(",")
    first = COLUMNS.index("centroid_x [mm]")
    assert cells[2:4] == ["0", "0"] and cells[first : first + 3] == ["", "", ""]


def test_record_makes_the_result_reproducible(knee: Call) -> None:
    record = knee.record()
    files = {entry["role"]: entry for entry in record["inputs"]}
    for role, file in (("moving", FEMUR), ("fixed", INSERT), ("motion", knee.folder.parent / "gait.csv")):
        assert files[role]["file"] == str(file)
        assert files[role]["sha256"] == hashlib.sha256(file.read_bytes()).hexdigest()
    assert {name: record["versions"][name] for name in ("numpy", "numba")} == {
        n: version(n) for n in ("numpy", "numba")
    }
    assert record["geocontact"] == __version__
    options = record["options"]
    assert (options["threshold"], options["split"], options["unit"], options["rule"]) == (
        "0.1,1,4",
        "z",
        "mm",
        "refined",
    )
    assert record["warnings"] == [] and record["command"] == "area"
    assert 0.0 < record["seconds"] < 600.0


def test_record_lists_every_file_that_was_read(tmp_path: Path) -> None:
    place, up = shifted(tmp_path, (0, 0, 0)), shifted(tmp_path, (0, -30, 0), "up.txt")
    faces = written(tmp_path / "faces.txt", "0 1 2\n")
    axis = written(tmp_path / "axis.txt", "0 0 0 0 0 1\n")
    reference = written(tmp_path / "measured.csv", "time [s],area_moving [mm^2]\n0,1\n")
    options = ("--sweep", "flexion=0:1:1", "--axis", axis, "--place-moving", place, "--region", faces)
    result = area(tmp_path / "out", *options, "--place-fixed", up, "--compare", reference)
    given = {Path(entry["file"]).name: entry["sha256"] for entry in result.record()["inputs"]}
    for file in (place, faces, axis, reference, up):
        assert given.get(file.name) == hashlib.sha256(file.read_bytes()).hexdigest(), f"{file.name} is not in run.json"


def test_two_runs_write_the_same_bytes(tmp_path: Path, knee: Call) -> None:
    again = done(
        area(tmp_path / "out", "--threshold", "0.1,1,4", "--split", "z", "--side", "right", motion=gait(tmp_path))
    )
    assert again.bytes() == knee.bytes()


def test_an_existing_folder_keeps_its_other_files(tmp_path: Path) -> None:
    out = tmp_path / "out"
    (out / "sub").mkdir(parents=True)
    written(out / "sub/notes.txt", "mine")
    written(out / "area.csv", "from last time")
    result = done(area(out, moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, (0, 20, 0))))
    assert set(inventory(out)) == {"sub", "sub/notes.txt", "area.csv", "run.json"}
    assert (out / "sub/notes.txt").read_text(encoding="utf-8") == "mine"
    assert len(result.table()) == 1


def test_missing_parents_of_the_folder_are_made(tmp_path: Path) -> None:
    result = done(area(tmp_path / "a/b/c", moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, (0, 20, 0))))
    assert set(inventory(result.folder)) == {"area.csv", "run.json"}


FAILURES = {
    "a mesh that cannot be read": (2, {}, ("no.stl", "no such file")),
    "disk full": (1, {"side_effect": OSError(28, "No space left on device", "area.png")}, ("No space left on device",)),
    "interrupted": (130, {"side_effect": KeyboardInterrupt()}, ("interrupted",)),
    "something nobody thought of": (1, {"side_effect": RuntimeError("no\nway")}, ("RuntimeError: no way", "--debug")),
}


@pytest.mark.parametrize(("code", "picture", "said"), FAILURES.values(), ids=FAILURES.keys())
@pytest.mark.parametrize("there", [True, False], ids=["existing folder", "new folder"])
def test_a_failing_run_leaves_everything_as_it_was(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, there: bool, code: int, picture: dict, said: tuple[str, ...]
) -> None:
    out = tmp_path / "place/out"
    (out if there else out.parent).mkdir(parents=True)
    if there:
        written(out / "area.csv", "from last time")
        written(out / "run.json", "{}")
    before = inventory(out.parent)
    moving = SPHERE if picture else tmp_path / "no.stl"
    if picture:
        monkeypatch.setattr("geocontact.analyses.area.motion_outputs.area_figure", mock.Mock(**picture))
    result = area(out, moving=moving, fixed=PLATE, motion=poses(tmp_path, (0, 20, 0)), picture=True)
    assert (result.code, len(result.complaints)) == (code, 1), result.err
    assert all(part in result.err for part in said), result.err
    assert inventory(out.parent) == before


def test_debug_adds_the_traceback_before_the_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main(
            [
                "area",
                str(tmp_path / "no.stl"),
                str(PLATE),
                "--unit=mm",
                f"--out={tmp_path / 'out'}",
                "--sweep=a=0:1:1",
                "--debug",
            ]
        )
    lines = capsys.readouterr().err.splitlines()
    assert left.value.code == 2 and lines[0].startswith("Traceback") and "no such file" in lines[-1]


@pytest.mark.skipif(os.name != "posix", reason="permission bits are those of Unix")
def test_written_files_can_be_read_by_others(knee: Call) -> None:
    """A folder made for the results is an ordinary one, not the private one that the draft was."""
    mask = os.umask(0)
    os.umask(mask)
    assert (knee.folder.stat().st_mode & 0o777) == 0o777 & ~mask
    assert {p.stat().st_mode & 0o777 for p in knee.folder.iterdir()} == {0o666 & ~mask}
    json.loads(knee.bytes("run.json"))
