"""What `geocontact area` writes: the table's columns and rows, run.json, the figure; the folder they appear in."""

from __future__ import annotations

import hashlib
import json
import os
import tomllib
from importlib.metadata import version
from pathlib import Path
from unittest import mock

import numpy as np
import pytest

from geocontact import __version__
from geocontact.cli.main import main
from tests.cli.calls import (
    FEMUR,
    FRAMES,
    INSERT,
    MESHES,
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
from tests.contract import COLUMNS, FILES, SPLIT

THRESHOLDS = [0.1, 1.0, 4.0]


@pytest.fixture(scope="module")
def knee(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """The coarse knee at two frames and three thresholds, split, with its picture."""
    folder = tmp_path_factory.mktemp("knee")
    options = ("--threshold", "0.1,1,4", "--split", "z")
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


def test_columns_are_those_of_the_contract_in_their_order(knee: Call) -> None:
    assert list(knee.table().columns)[: len(COLUMNS) + 2] == COLUMNS + SPLIT


def test_columns_without_a_split_have_no_sides(tmp_path: Path) -> None:
    columns = list(done(area(tmp_path / "out", motion=gait(tmp_path, [0]))).table().columns)
    assert columns[: len(COLUMNS)] == COLUMNS and not {*SPLIT} & {*columns}


def test_frames_are_outer_and_thresholds_inner(knee: Call) -> None:
    table = knee.table()
    assert list(table["threshold [mm]"]) == THRESHOLDS * len(FRAMES)
    assert list(table["time [s]"]) == [k / 100 for k in FRAMES for _ in THRESHOLDS]


def test_areas_equal_the_reference_of_the_shipped_pair(tmp_path: Path) -> None:
    """meshes/manifest.toml: areas of these very triangles, converged with libigl distances."""
    manifest = tomllib.loads((MESHES / "manifest.toml").read_text(encoding="utf-8"))
    pair = next(p for p in manifest["pair"] if (p["fixed"], p["moving"]) == (INSERT.name, FEMUR.name))
    pose = next(p for p in pair["pose"] if "frame" in p)
    known = [a for a in pose["area"] if a["surface"] == "triangulated"]
    levels = ",".join(str(a["threshold_mm"]) for a in known)
    table = done(area(tmp_path / "out", "--threshold", levels, motion=gait(tmp_path, [pose["frame"]]))).table()
    for side in ("fixed", "moving"):
        np.testing.assert_allclose(table[f"area_{side} [mm^2]"], [a[f"area_{side}_mm2"] for a in known], rtol=1e-3)
    lowest, highest = pose["min_distance_mm"]
    assert lowest - 1e-3 <= table["min_distance [mm]"][0] <= highest + 1e-6


def test_medial_and_lateral_add_up(knee: Call) -> None:
    table = knee.table()
    np.testing.assert_allclose(table[SPLIT].sum(axis=1), table["area_fixed [mm^2]"], rtol=1e-9)
    assert (table[SPLIT].to_numpy()[2::3] > 500.0).all(), "both condyles carry at 4 mm"


def test_bounds_enclose_the_area_and_areas_grow_with_the_threshold(knee: Call) -> None:
    table = knee.table()
    assert (table["area_fixed_lower [mm^2]"] <= table["area_fixed [mm^2]"]).all()
    assert (table["area_fixed [mm^2]"] <= table["area_fixed_upper [mm^2]"]).all()
    assert (np.diff(table["area_fixed [mm^2]"].to_numpy().reshape(-1, 3), axis=1) > 0).all()


def test_penetration_and_distance_belong_together(knee: Call) -> None:
    """Both bodies closed: FIXED's depth is at most the overlap, and separation is the same at every threshold."""
    table = knee.table()
    assert (table.groupby("time [s]")[["min_distance [mm]", "max_penetration_fixed [mm]"]].nunique() == 1).all(
        axis=None
    )
    assert (table["max_penetration_fixed [mm]"] >= 0.0).all()
    assert (table["max_penetration_fixed [mm]"] <= np.maximum(0.0, -table["min_distance [mm]"]) + 1e-9).all()


def test_centroid_is_empty_where_the_area_is_zero(tmp_path: Path) -> None:
    """A sphere 1 mm above a plate: nothing within 0.5 mm, at 4 mm a disc under the centre."""
    table = done(
        area(tmp_path / "out", "--threshold", "0.5,4", moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, (3, 21, -2)))
    ).table()
    cells = (tmp_path / "out/area.csv").read_text(encoding="utf-8").splitlines()[1].split(",")
    first = COLUMNS.index("centroid_x [mm]")
    assert cells[2:4] == ["0", "0"] and cells[first : first + 3] == ["", "", ""]
    np.testing.assert_allclose(
        table[["centroid_x [mm]", "centroid_y [mm]", "centroid_z [mm]"]].loc[1], [3, 0, -2], atol=0.02
    )


def test_nothing_in_contact_is_a_result(tmp_path: Path) -> None:
    """10 mm apart in the only frame: zero areas, a distance, and a picture all the same."""
    result = done(area(tmp_path / "out", moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, (0, 30, 0)), picture=True))
    table = result.table()
    assert table["area_fixed [mm^2]"][0] == table["area_moving [mm^2]"][0] == table["area_fixed_upper [mm^2]"][0] == 0.0
    assert table["min_distance [mm]"][0] == pytest.approx(10.0, abs=0.02)
    assert (result.folder / "area.png").stat().st_size > 10_000


def opened(folder: Path, mesh: Path, direction: int) -> Path:
    """The mesh without the face that lies farthest out along z, in `direction`: away from any contact here."""
    points = corners(mesh)
    away = np.argmax(direction * points[:, :, 2].mean(axis=1))
    return written(folder / f"open_{mesh.name}", stl(np.delete(points, away, axis=0)))


@pytest.mark.parametrize(
    ("moving_open", "fixed_open", "word"),
    [(False, False, "both"), (False, True, "fixed"), (True, False, "moving"), (True, True, "none")],
)
def test_signed_says_which_areas_are_signed(tmp_path: Path, moving_open: bool, fixed_open: bool, word: str) -> None:
    """area_fixed is signed when MOVING is closed; an unsigned area misses what lies deeper than the threshold."""
    moving = opened(tmp_path, SPHERE, 1) if moving_open else SPHERE
    fixed = opened(tmp_path, PLATE, 1) if fixed_open else PLATE
    result = area(
        tmp_path / "out", "--threshold", "0.1", moving=moving, fixed=fixed, motion=poses(tmp_path, (0, 19.5, 0))
    )
    table = done(result).table()
    assert list(table["signed"]) == [word]
    disc, ring = (np.pi * ((20 + t) ** 2 - 19.5**2) for t in (0.1, -0.1))
    expected = disc - ring if moving_open else disc
    assert table["area_fixed [mm^2]"][0] == pytest.approx(expected, rel=0.06), (
        "facets of the sphere cost a few per cent"
    )
    assert np.isnan(table["max_penetration_fixed [mm]"][0]) == moving_open
    assert table["min_distance [mm]"][0] == pytest.approx(0.0 if word == "none" else -0.5, abs=0.02)
    assert len(result.warnings) == moving_open + fixed_open


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
    again = done(area(tmp_path / "out", "--threshold", "0.1,1,4", "--split", "z", motion=gait(tmp_path)))
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
        monkeypatch.setattr("geocontact.analyses.area.write.draw_areas", mock.Mock(**picture))
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
