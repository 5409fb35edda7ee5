"""A folder of results that is used again holds the results of the last run only, and whatever is not ours."""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Callable
from pathlib import Path
from unittest import mock

import pytest

from geocontact.analyses.frame.folder import digest
from tests.cli.calls import PLATE, SPHERE, Call, area, done, inventory, poses, written
from tests.contract import FILES

PLAIN = {"area.csv", "run.json"}
FILES_OF = {
    "--save-map": {"distances.npz"},
    "--parquet": {"area.parquet", "comparison.parquet"},
    "--compare": {"comparison.csv", "comparison.parquet"},
}
"""Files that are not there without an option."""

FULL = PLAIN.union(*FILES_OF.values())


def run(out: Path, *options: object, picture: bool = False) -> Call:
    """The sphere over the plate into `out`."""
    motion = () if "--motion" in options else ("--motion", poses(out.parent, (0, 20, 0)))
    return area(out, *options, *motion, moving=SPHERE, fixed=PLATE, picture=picture)


def everything(folder: Path) -> tuple[object, ...]:
    """Options with which every kind of file is written."""
    measured = written(folder / "measured.csv", "time [s],area_fixed [mm^2]\n0,500\n")
    return "--save-map", "--parquet", "--compare", measured, "--tolerance", "90%"


def for_viewers(folder: Path) -> set[str]:
    """Names of pictures and of the files for ParaView."""
    return {name for name in inventory(folder) if name.startswith(("still_", "paraview"))}


def several(folder: Path, *names: str) -> list[object]:
    """Motions of these names."""
    files = [poses(folder, (0, 20, 0.1 * k), name=f"{name}.csv") for k, name in enumerate(names)]
    return [word for file in files for word in ("--motion", file)]


@pytest.mark.slow
def test_every_file_of_a_run_may_be_removed_by_the_next(tmp_path: Path) -> None:
    out = tmp_path / "out"
    done(run(out, *everything(tmp_path), picture=True))
    assert set(inventory(out)) == FULL | FILES
    assert set(done(run(out)).record()["files"]) == set(inventory(out)) == PLAIN


@pytest.mark.slow
@pytest.mark.long  # with every change: the other files below, and tests/view/surfaces
def test_stills_and_the_paraview_series_come_and_go(tmp_path: Path) -> None:
    """Files of other people stay, in the folder of the series as well."""
    pytest.importorskip("pyvista")
    out = tmp_path / "out"
    first = done(run(out, "--paraview", "--stills", picture=True))
    stills = {f"still_{sign}_{axis}.png" for sign in ("plus", "minus") for axis in "xyz"}
    series = {"frames/fixed_000.vtp", "frames/moving_000.vtp", "both.pvd", "fixed.pvd", "moving.pvd"}
    files = stills | {f"paraview/{name}" for name in series}
    assert for_viewers(out) - {"paraview", "paraview/frames"} == files <= set(first.record()["files"])
    written(out / "paraview/notes.txt", "mine")
    done(run(out))
    assert for_viewers(out) == {"paraview", "paraview/notes.txt"}
    (out / "paraview/notes.txt").unlink()
    done(run(out, "--paraview"))
    done(run(out))
    assert for_viewers(out) == set()


@pytest.mark.parametrize("gone", sorted(FILES_OF))
def test_each_option_takes_its_file_with_it(tmp_path: Path, gone: str) -> None:
    """Without one option of all, exactly the files of the other options are there, and all of them are new."""
    out = tmp_path / "out"
    options = everything(tmp_path)
    done(run(out, *options))
    assert set(inventory(out)) == FULL
    parts = {"--save-map": options[:1], "--parquet": options[1:2], "--compare": options[2:]}
    done(run(out, "--threshold", "3", *(word for name, part in parts.items() if name != gone for word in part)))
    assert set(inventory(out)) == FULL - FILES_OF[gone]
    assert json.loads((out / "run.json").read_bytes())["options"]["threshold"] == "3"


def test_folders_of_motions_come_and_go(tmp_path: Path) -> None:
    out = tmp_path / "out"
    filled = {"slow": {"slow", *(f"slow/{name}" for name in PLAIN)}, "fast": {"fast", *(f"fast/{n}" for n in PLAIN)}}
    done(run(out))
    assert set(inventory(out)) == PLAIN
    done(run(out, "--save-map", *several(tmp_path, "slow", "fast")))
    assert set(inventory(out)) == {"run.json", "slow/distances.npz", "fast/distances.npz"}.union(*filled.values())
    written(out / "slow/notes.txt", "mine")
    done(run(out, *several(tmp_path, "fast", "late")))
    late = {"late", *(f"late/{name}" for name in PLAIN)}
    assert set(inventory(out)) == {"run.json", "slow", "slow/notes.txt"} | filled["fast"] | late
    done(run(out))
    assert set(inventory(out)) == PLAIN | {"slow", "slow/notes.txt"}


@pytest.mark.slow
def test_a_single_run_into_the_folder_of_one_motion(tmp_path: Path) -> None:
    """It is tidied like any other, and from then on it is not part of the run above it."""
    out = tmp_path / "out"
    done(run(out, "--save-map", *several(tmp_path, "slow", "fast")))
    done(run(out / "slow", "--parquet", "--motion", poses(tmp_path, (0, 20, 0))))
    mine = {"slow", "slow/area.parquet", *(f"slow/{name}" for name in PLAIN)}
    assert {p for p in inventory(out) if p.startswith("slow")} == mine
    done(run(out))
    assert set(inventory(out)) == PLAIN | mine
    done(run(out, *several(tmp_path, "slow", "late")))
    assert not (out / "slow/area.parquet").exists(), "the folder is filled again by the run above"


FAILURES: dict[str, dict] = {
    "disk full": {"side_effect": OSError(28, "No space left on device", "area.png")},
    "interrupted": {"side_effect": KeyboardInterrupt()},
    "something nobody thought of": {"side_effect": RuntimeError("no way")},
}


@pytest.mark.parametrize("failure", FAILURES)
def test_a_failing_run_leaves_the_old_results_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, failure: str
) -> None:
    out = tmp_path / "out"
    done(run(out, *everything(tmp_path), *several(tmp_path, "slow", "fast")))
    before = inventory(out)
    poses(tmp_path, (0, 20, 0))
    monkeypatch.setattr("geocontact.analyses.area.motion_outputs.area_figure", mock.Mock(**FAILURES[failure]))
    assert run(out, picture=True).code not in (0, 2)
    assert inventory(out) == before


@pytest.mark.parametrize("way", ["a folder where a file goes", "a file where a folder goes"])
def test_what_is_in_the_way_is_refused_before_anything_changes(tmp_path: Path, way: str) -> None:
    out = tmp_path / "out"
    done(run(out, *everything(tmp_path)))
    if "file goes" in way:
        (out / "area.csv").unlink()
        (out / "area.csv").mkdir()
        options: list[object] = []
    else:
        written(out / "slow", "mine")
        options = several(tmp_path, "fast", "slow")
    poses(tmp_path, (0, 20, 0))
    before = inventory(out)
    result = run(out, *options)
    assert (result.code, len(result.complaints)) == (2, 1), result.err
    assert "choose another --out" in result.err
    assert inventory(out) == before


def unlisted(out: Path) -> set[str]:
    """A file of one of our names that no run has written."""
    done(run(out))
    written(out / "comparison.csv", "mine")
    return {"comparison.csv"}


def without_a_record(out: Path) -> set[str]:
    """Files of our names in a folder that holds no results."""
    out.mkdir()
    for name in FULL - PLAIN:
        written(out / name, "mine")
    return FULL - PLAIN


def copied(out: Path) -> set[str]:
    """The user's copy of a motion's results."""
    done(run(out, *several(out.parent, "slow", "fast")))
    shutil.copytree(out / "slow", out / "slow_old")
    return {f"slow_old/{name}" for name in PLAIN}


def of_another_command(out: Path) -> set[str]:
    """Results of a command that writes other files."""
    out.mkdir()
    file = written(out / "distances.npz", "from the fit")
    told = {"command": "fit", "files": ["run.json", "distances.npz"], "sha256": {"distances.npz": digest(file)}}
    written(out / "run.json", json.dumps(told))
    return {"distances.npz"}


def changed(out: Path) -> set[str]:
    """A result that somebody has written into since."""
    done(run(out, "--save-map"))
    written(out / "distances.npz", "mine now")
    return {"distances.npz"}


@pytest.mark.parametrize("prepare", [unlisted, without_a_record, copied, of_another_command, changed])
def test_what_is_not_ours_stays(tmp_path: Path, prepare: Callable[[Path], set[str]]) -> None:
    out = tmp_path / "out"
    names = prepare(out)
    before = inventory(out)
    done(run(out))
    after = inventory(out)
    assert {name: after.get(name, "gone") for name in names} == {name: before[name] for name in names}


MINE = hashlib.sha256(b"mine").hexdigest()
"""Of the files that a lying record names: it knows what they hold."""

HOSTILE = {
    "paths upwards": {
        "sha256": dict.fromkeys(["../distances.npz", "sub/../../distances.npz", "..\\distances.npz"], MINE)
    },
    "absolute path": {"sha256": {"{parent}/distances.npz": MINE}},
    "no files": {"sha256": dict.fromkeys(["", ".", "..", "sub", "\0"], MINE)},
    "another content": {"sha256": {"notes.txt": "0" * 64, "sub/distances.npz": None}},
    "folder upwards": {"sha256": {}, "inputs": [{"folder": ".."}, {"folder": "../elsewhere"}]},
    "folder of others": {"sha256": {}, "inputs": [{"folder": "sub"}]},
    "no list": {"sha256": ["notes.txt"], "files": {"notes.txt": 1}, "inputs": 3},
    "only names": {"files": ["notes.txt", "sub/distances.npz"], "inputs": [["sub"], None]},
}


@pytest.mark.parametrize("told", [*HOSTILE.values(), "no JSON", "[1]", "[" * 100_000], ids=[*HOSTILE, "a", "b", "c"])
def test_a_record_that_lies_removes_nothing(tmp_path: Path, told: object) -> None:
    out = tmp_path / "out"
    (out / "sub").mkdir(parents=True)
    (tmp_path / "elsewhere").mkdir()
    for folder in (tmp_path, tmp_path / "elsewhere", out / "sub"):
        written(folder / "distances.npz", "mine")
    written(out / "notes.txt", "mine")
    text = told if isinstance(told, str) else json.dumps({"command": "area", **told}).replace("{parent}", str(tmp_path))
    written(out / "run.json", text)
    poses(tmp_path, (0, 20, 0))
    before = inventory(tmp_path)
    done(run(out))
    after = inventory(tmp_path)
    assert {name: after.get(name, "gone") for name in before} == before | {"out/run.json": after["out/run.json"]}


def test_a_linked_folder_is_not_followed(tmp_path: Path) -> None:
    out, elsewhere = tmp_path / "out", tmp_path / "elsewhere"
    done(run(out, *several(tmp_path, "slow", "fast")))
    shutil.move(out / "slow", elsewhere)
    try:
        (out / "slow").symlink_to(elsewhere, target_is_directory=True)
    except OSError:
        pytest.skip("no links here")
    before = inventory(elsewhere)
    done(run(out))
    assert inventory(elsewhere) == before
