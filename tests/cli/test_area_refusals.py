"""Input that cannot be used: exit 2, one line that names the file and the remedy, nothing left behind."""

from __future__ import annotations

import os
import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from meshes.simple_shapes import block, sphere
from meshes.stl import stl_bytes
from tests.cli.calls import KNEE, call, inventory, poses, storage, written

BALL = stl_bytes(*sphere(20.0, 4), "ball")
FLOOR = stl_bytes(*block(80.0, 80.0, 12.0, 8), "floor")
HTML = b"<!DOCTYPE html>\n<html><body>404 not found" + b" " * 500 + b"</body></html>\n"
HEAD = "time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz\n"
MAP = "rz=-knee_flexion,rx=-knee_adduction,ry=-knee_rotation,tx=knee_tx,ty=knee_ty,tz=knee_tz"
JOINT = {"--osim": str(KNEE), "--joint": "knee_r", "--motion": lambda folder: storage(folder)}
RIGID = "1 0 0 0\n0 1 0 0\n0 0 1 0\n"

Given = dict[str, object]
"""Options that differ from a call that works; None leaves one out, a function makes a file in the folder it is given."""


def file(name: str, content: str | bytes) -> Callable[[Path], Path]:
    return lambda folder: written(folder / name, content)


def folder(name: str) -> Callable[[Path], Path]:
    def made(parent: Path) -> Path:
        (parent / name).mkdir()
        return parent / name

    return made


def ball(content: bytes) -> Given:
    return {"MOVING": file("ball.stl", content)}


def motion(text: str, name: str = "poses.csv", **options: object) -> Given:
    return {"--motion": file(name, text), **{f"--{key}": value for key, value in options.items()}}


def edited(old: str, new: str, **options: object) -> Given:
    """The .mot of the shipped knee with a part replaced."""

    def changed(folder: Path) -> Path:
        plain = storage(folder)
        text = plain.read_text(encoding="utf-8")
        assert old in text
        return written(plain, text.replace(old, new))

    return {**JOINT, "--motion": changed, **{f"--{key}": value for key, value in options.items()}}


def placed(rows: str) -> Given:
    return {"--place-moving": file("place.txt", rows)}


def compared(text: str, **options: object) -> Given:
    return {"--compare": file("measured.csv", text), **{f"--{key}": value for key, value in options.items()}}


def sweep(text: str, axis: str | None = "0,0,0,0,0,1") -> Given:
    return {"--motion": None, "--sweep": text, "--axis": axis, **placed("1 0 0 0\n0 1 0 20\n0 0 1 0\n0 0 0 1\n")}


def vertex(value: float) -> bytes:
    at = 84 + 50 * 7 + 12
    return BALL[:at] + struct.pack("<f", value) + BALL[at + 4 :]


MESH_FILES: dict[str, tuple[Given, tuple[str, ...]]] = {
    "truncated STL": (ball(BALL[:-20]), ("ball.stl", "cut off or damaged", "export or download it again")),
    "padded STL": (ball(BALL + b"\0\0"), ("ball.stl", "cut off or damaged", "export or download it again")),
    "one face too many declared": (
        ball(BALL[:80] + struct.pack("<I", 321) + BALL[84:]), ("ball.stl", "declares 321 faces", "again")
    ),
    "huge count": (ball(BALL[:80] + b"\xff" * 4 + BALL[84:]), ("ball.stl", "declares 4294967295 faces", "again")),
    "truncated ASCII STL": (ball(b"solid x\nfacet normal 0 0 1\nouter loop\n"), ("ball.stl", "endsolid", "again")),
    "NaN vertex": (ball(vertex(np.nan)), ("ball.stl face 7", "not finite", "repair")),
    "infinite vertex": (ball(vertex(np.inf)), ("ball.stl face 7", "not finite", "repair")),
    "no faces": (ball(BALL[:80] + b"\0" * 4), ("ball.stl", "no faces", "export")),
    "empty file": (ball(b""), ("ball.stl", "empty", "again")),
    "HTML named .stl": (ball(HTML), ("ball.stl", "an HTML page", "download the file itself")),
    "PLY named .stl": (ball(b"ply\nformat ascii 1.0\nend_header\n"), ("ball.stl", "a PLY file", "name it .ply")),
    "STL named .ply": ({"FIXED": file("floor.ply", FLOOR)}, ("floor.ply", "not a PLY file", "export")),
    "unknown format": ({"MOVING": file("ball.step", BALL)}, ("ball.step", ".stl", "convert")),
    "no extension": ({"MOVING": file("ball", BALL)}, ("ball", ".stl", "convert")),
    "missing file": ({"FIXED": "nowhere/floor.stl"}, ("nowhere/floor.stl", "no such file", "check the path")),
    "folder as mesh": ({"MOVING": folder("ball.stl")}, ("ball.stl", "is a folder", "name a file")),
    "metres taken for mm": (
        ball(stl_bytes(*sphere(0.02, 4), "m")), ("ball.stl", "too small for an implant", "metres", "--unit m")
    ),
    "mm taken for metres": ({"--unit": "m"}, ("ball.stl", "too large", "millimetres", "--unit mm")),
}  # fmt: skip

MOTION_FILES: dict[str, tuple[Given, tuple[str, ...]]] = {
    "missing file": ({"--motion": "nowhere.csv"}, ("nowhere.csv", "No such file", "check the path")),
    "folder": ({"--motion": folder("poses.csv")}, ("poses.csv", "irectory", "check the path")),
    "unknown format": (motion(HEAD + "0,0,20,0,1,0,0,0\n", "poses.trc"), ("poses.trc", ".csv, .mot, .sto")),
    "pattern without a file": ({"--motion": "nowhere*.csv"}, ("nowhere*.csv", "matches no file", "check the pattern")),
    "two motions of one name": (
        {"--motion": lambda f: [poses(f, (0, 20, 0)), poses(folder("b")(f), (0, 20, 0))]}, ("two motions", "poses")
    ),
    "missing quaternion": (motion("time [s],tx [mm],ty [mm],tz [mm]\n0,0,20,0\n"), ("poses.csv", "qw, qx, qy, qz")),
    "missing translation": (
        motion(HEAD.replace(",ty [mm]", "") + "0,0,0,1,0,0,0\n"), ("poses.csv", "no column 'ty'", "columns are")
    ),
    "length without a unit": (motion(HEAD.replace("ty [mm]", "ty") + "0,0,20,0,1,0,0,0\n"), ("poses.csv", "ty [mm]")),
    "no rows": (motion(HEAD), ("poses.csv", "no rows")),
    "empty": (motion(""), ("poses.csv", "empty")),
    "NaN in a needed column": (
        motion(HEAD + "0,0,20,0,1,0,0,0\n1,0,nan,0,1,0,0,0\n"), ("poses.csv", "line 3", "column 'ty' is nan")
    ),
    "empty cell in a needed column": (
        motion(HEAD + "0,0,20,0,1,0,0,0\n1,0,20,0,1,,0,0\n"), ("poses.csv", "line 3", "column 'qx' is nan")
    ),
    "word in a cell": (motion(HEAD + "0,0,up,0,1,0,0,0\n"), ("poses.csv", "line 2", "'up'", "not a number")),
    "time stands": (
        motion(HEAD + "0,0,20,0,1,0,0,0\n0,0,20,0,1,0,0,0\n"), ("poses.csv", "line 3", "time must increase")
    ),
    "time runs back": (
        motion(HEAD + "0,0,20,0,1,0,0,0\n-1,0,20,0,1,0,0,0\n"), ("poses.csv", "line 3", "time must increase")
    ),
    "quaternion too long": (
        motion(HEAD + "0,0,20,0,1,0,0,0\n1,0,20,0,1.002,0,0,0\n"), ("poses.csv", "line 3", "length 1.002", "normalise")
    ),
    "quaternion of zeros": (motion(HEAD + "0,0,20,0,0,0,0,0\n"), ("poses.csv", "line 2", "length 0", "normalise")),
    "Euler columns without an order": (
        motion("time [s],tx [mm],ty [mm],tz [mm],rx [deg],ry [deg],rz [deg]\n0,0,20,0,0,0,0\n"),
        ("poses.csv", "order", "--order XYZ"),
    ),
    "nonsense order": (
        motion("time [s],tx [mm],ty [mm],tz [mm],rx [deg],ry [deg],rz [deg]\n0,0,20,0,0,0,0\n", order="XXY"),
        ("--order", "XXY", "each axis once"),
    ),
    "Euler angles without a unit": (
        motion("time [s],tx [mm],ty [mm],tz [mm],rx,ry,rz\n0,0,20,0,0,0,0\n", order="XYZ"), ("poses.csv", "--angles")
    ),
    "rows unlike declared": (edited("nRows=2", "nRows=7"), ("gait.mot", "nRows=7", "2 rows")),
    "contradictory angle units": (
        edited("inDegrees=yes\n", "inDegrees=no\nAngles are in degrees.\n"),
        ("gait.mot", "inDegrees=no but the text says degrees", "--angles deg or rad"),
    ),
    "no angle unit at all": (edited("inDegrees=yes\n", ""), ("gait.mot", "--angles deg or rad")),
    "degrees declared as radians": (
        {**JOINT, "--motion": lambda f: _far_flexed(f)},
        ("gait.mot", "too much for the radians", "--angles deg or rad"),
    ),
    "coordinates without a model": ({"--motion": JOINT["--motion"]}, ("gait.mot", "--osim and --joint", "--map")),
    "no coordinate of the joint": (edited("knee_", "hip_"), ("gait.mot", "no column for any coordinate", "hip_flexion")),
}  # fmt: skip


def _far(folder: Path) -> Path:
    file = storage(folder, [0])
    return written(file, file.read_text(encoding="utf-8").replace("-0.0306176748938", "-0.1306176748938"))


def _far_flexed(folder: Path) -> Path:
    text = storage(folder).read_text(encoding="utf-8").replace("inDegrees=yes", "inDegrees=no")
    return written(folder / "gait.mot", text.replace("6.603143", "66.03143"))


OPTIONS: dict[str, tuple[Given, tuple[str, ...]]] = {
    "missing --unit": ({"--unit": None}, ("--unit",)),
    "missing --out": ({"--out": None}, ("--out",)),
    "unknown unit": ({"--unit": "inch"}, ("--unit", "inch", "mm")),
    "missing mesh": ({"MOVING": None}, ("FIXED",)),
    "unknown option": ({"--treshold": "4"}, ("--treshold",)),
    "neither --motion nor --sweep": ({"--motion": None}, ("--motion", "--sweep")),
    "both --motion and --sweep": ({"--sweep": "a=0:1:1"}, ("--motion", "--sweep")),
    "threshold negative": ({"--threshold": "-1"}, ("--threshold", "-1", "negative")),
    "threshold a word": ({"--threshold": "four"}, ("--threshold", "'four'", "--threshold 4")),
    "threshold nan": ({"--threshold": "nan"}, ("--threshold", "nan", "--threshold 4")),
    "threshold infinite": ({"--threshold": "inf"}, ("--threshold", "inf", "--threshold 4")),
    "threshold empty": ({"--threshold": ""}, ("--threshold", "--threshold 4")),
    "threshold list with a hole": ({"--threshold": "1,,4"}, ("--threshold", "--threshold 4")),
    "threshold in an unknown unit": ({"--threshold": "4 furlong"}, ("--threshold", "4 furlong", "--threshold 4mm")),
    "threshold twice": ({"--threshold": "4,0.4cm"}, ("--threshold", "twice", "give each once")),
    "unknown joint": ({**JOINT, "--joint": "elbow"}, ("knee.osim", "'elbow'", "knee_r")),
    "--osim without --joint": ({**JOINT, "--joint": None}, ("--joint", "--osim")),
    "--joint without --osim": ({**JOINT, "--osim": None}, ("--osim", "--joint")),
    "missing model": ({**JOINT, "--osim": "nowhere.osim"}, ("nowhere.osim", "check the path")),
    "model is no XML": ({**JOINT, "--osim": file("knee.osim", "solid knee")}, ("knee.osim", "not a readable OpenSim model")),
    "unknown moving body": ({**JOINT, "--moving": "femur"}, ("--moving", "femur", "parent")),
    "map without columns": ({"--map": "rz", "--motion": JOINT["--motion"]}, ("--map", "target=column", "rz=knee_flexion")),
    "map to nowhere": ({"--map": "rw=knee_tx", "--motion": JOINT["--motion"]}, ("--map", "'rw'", "rx, ry, rz")),
    "map of an unknown column": ({"--map": "rz=hip", "--motion": JOINT["--motion"]}, ("gait.mot", "'hip'", "knee_flexion")),
    "map of a target twice": (
        {"--map": "tx=knee_tx,tx=knee_ty", "--motion": JOINT["--motion"]}, ("--map", "'tx'", "twice")
    ),
    "--convention without --side": ({"--convention": "grood-suntay"}, ("--side", "right or left")),
    "unknown convention": ({"--convention": "isb"}, ("--convention", "isb", "grood-suntay")),
    "region that cannot be read": ({"--region": "ny >"}, ("--region", "ny >", "ny>0.25")),
    "region with an unknown name": ({"--region": "nw > 0"}, ("--region", "'nw'", "nx, ny, nz")),
    "region that is a number": ({"--region": "ny + 1"}, ("--region", "ny + 1", "ny>0.25")),
    "region without a face of its own": ({"--region": "1 > 0"}, ("--region", "1 > 0", "ny>0.25")),
    "region that adds conditions": ({"--region": "(ny>0) + (nx>0)"}, ("--region", "and, or")),
    "region that runs code": ({"--region": "__import__('os').system('true')"}, ("--region", "not understood")),
    "region that looks behind": ({"--region": "().__class__"}, ("--region", "not understood")),
    "region with an index": ({"--region": "x[0] > 1"}, ("--region", "not understood")),
    "region with a lambda": ({"--region": "(lambda: x)() > 0"}, ("--region", "not understood")),
    "region with a text": ({"--region": "'a' * 10 > x"}, ("--region", "not understood")),
    "region of a huge power": ({"--region": "ny > 9**9**9"}, ("--region", "9**9**9")),
    "region that divides by zero": ({"--region": "ny > 1/0"}, ("--region", "1/0")),
    "region of a complex number": ({"--region": "ny > (0-1)**0.5"}, ("--region", "**0.5")),
    "region of a huge number": ({"--region": f"ny > {'9' * 400}"}, ("--region", "999")),
    "region of endless digits": ({"--region": f"ny > {'9' * 5000}"}, ("--region", "999")),
    "region nested without end": ({"--region": "not " * 3000 + "ny>0"}, ("--region",)),
    "region of brackets without end": ({"--region": "(" * 3000 + "ny>0" + ")" * 3000}, ("--region",)),
    "region empty": ({"--region": ""}, ("--region", "ny>0.25")),
    "region of no face": ({"--region": "x > 1e9"}, ("--region", "x > 1e9", "no face of floor.stl", "check")),
    "region of no face of MOVING": ({"--region-moving": "x > 1e9"}, ("--region-moving", "no face of ball.stl", "check")),
    "face number beyond the mesh": ({"--region": file("faces.txt", "0\n9999\n")}, ("faces.txt line 2", "9999", "start at 0")),
    "face number negative": ({"--region": file("faces.txt", "-1\n")}, ("faces.txt line 1", "-1")),
    "face number twice": ({"--region": file("faces.txt", "1 2 1\n")}, ("faces.txt line 1", "already", "once")),
    "face file of words": ({"--region": file("faces.txt", "all\n")}, ("faces.txt line 1", "'all'", "0-based")),
    "face file empty": ({"--region": file("faces.txt", "# none\n")}, ("faces.txt", "no faces")),
    "split along no axis": ({"--split": "w"}, ("--split", "'w'", "z=1.5")),
    "split at a word": ({"--split": "z=middle"}, ("--split", "middle")),
    "split at nan": ({"--split": "z=nan"}, ("--split", "nan")),
    "medial neither side": ({"--split": "z", "--medial": "left"}, ("--medial", "left")),
    "unknown rule": ({"--rule": "vertices"}, ("--rule", "vertices", "all-vertices")),
    "bounds zero": ({"--bounds": "0"}, ("--bounds", "not positive", "2%")),
    "bounds a word": ({"--bounds": "tight"}, ("--bounds", "tight", "2%")),
    "tolerance negative": ({"--tolerance": "-2%"}, ("--tolerance", "-2%", "not positive")),
    "workers negative": ({"--workers": "-2"}, ("--workers", "-2")),
    "workers a word": ({"--workers": "all"}, ("--workers", "all")),
    "sweep never arrives": (sweep("flexion=0:90:-1"), ("--sweep", "never arrives", "0:90:1")),
    "sweep with step 0": (sweep("flexion=0:90:0"), ("--sweep", "never arrives", "0:90:1")),
    "sweep of a million frames": (sweep("flexion=0:90:1e-5"), ("--sweep", "0:90:1")),
    "sweep of words": (sweep("flexion=straight:bent"), ("--sweep", "straight", "flexion=0:90:1")),
    "sweep of nan": (sweep("flexion=0:nan:1"), ("--sweep", "nan", "flexion=0:90:1")),
    "sweep without a name": (sweep("0:90:1"), ("--sweep", "0:90:1", "flexion=0:90:1")),
    "sweep of one number": (sweep("flexion=90"), ("--sweep", "flexion=90", "flexion=0:90:1")),
    "axis of five numbers": (sweep("a=0:1:1", "0,0,0,0,1"), ("--axis", "x,y,z,dx,dy,dz")),
    "axis without a direction": (sweep("a=0:1:1", "1,2,3,0,0,0"), ("--axis", "direction")),
    "axis of nan": (sweep("a=0:1:1", "0,0,nan,0,0,1"), ("--axis", "nan", "x,y,z,dx,dy,dz")),
    "axis of words": (sweep("a=0:1:1", "a,b,c,d,e,f"), ("--axis", "'a'", "x,y,z,dx,dy,dz")),
    "axis file of words": (
        {**sweep("a=0:1:1"), "--axis": file("axis.txt", "the knee's own")}, ("axis.txt", "x,y,z,dx,dy,dz")
    ),
    "axis of another fit": (
        {**sweep("a=0:1:1"), "--axis": file("fit.json", '{"radius_mm": 3}')}, ("fit.json", "fit.json of a cylinder fit")
    ),
    "placement of three rows": (placed(RIGID), ("place.txt", "4x4", "4 rows of 4 numbers")),
    "placement that scales": (placed("2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n"), ("place.txt", "orthonormal", "scale")),
    "placement that mirrors": (placed("1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n"), ("place.txt", "mirror", "mirror the mesh")),
    "placement of nan": (placed(RIGID.replace("0 0\n", "nan 0\n", 1) + "0 0 0 1\n"), ("place.txt", "finite")),
    "placement with a bad last row": (placed(RIGID + "0 0 0 2\n"), ("place.txt row 4", "0 0 0 1")),
    "placement file missing": ({"--place-moving": "nowhere.txt"}, ("nowhere.txt", "check the path")),
    "placement by an unknown body": ({"--place-fixed": f"{KNEE}:patella"}, ("knee.osim", "'patella'", "tibial_insert")),
    "placement by a missing model": ({"--place-fixed": "nowhere.osim:tibia"}, ("nowhere.osim", "check the path")),
    "comparison missing": ({"--compare": "nowhere.csv"}, ("nowhere.csv", "No such file")),
    "comparison empty": (compared(""), ("measured.csv", "area.csv")),
    "comparison without time": (compared("area_fixed [mm^2]\n1\n"), ("measured.csv", "'time [s]'")),
    "comparison without an area": (compared("time [s],force [N]\n0,1\n"), ("measured.csv", "area_fixed [mm^2]")),
    "comparison outside the time window": (
        compared("time [s],area_fixed [mm^2]\n7,100\n"), ("measured.csv", "time 7 lies outside 0 … 0")
    ),
    "comparison of an unknown column": (
        compared("time [s],area_patella [mm^2]\n0,100\n"), ("measured.csv", "area_patella [mm^2]", "area_fixed [mm^2]")
    ),
    "comparison of another threshold": (
        compared("time [s],threshold [mm],area_fixed [mm^2]\n0,3,100\n"), ("measured.csv", "3 mm", "--threshold")
    ),
    "comparison without a threshold": (
        compared("time [s],area_fixed [mm^2]\n0,100\n", threshold="1,4"), ("measured.csv", "threshold [mm]")
    ),
    "comparison of words": (compared("time [s],area_fixed [mm^2]\n0,large\n"), ("measured.csv", "number")),
    "comparison with a bad time": (compared("time [s],area_fixed [mm^2]\n0,1\nend,1\n"), ("measured.csv row 3", "time")),
    "--out is a file": ({"--out": file("result", "mine")}, ("result", "is a file", "--out names a folder")),
    "--out below a file": ({"--out": lambda f: written(f / "result", "mine") / "sub"}, ("result", "is a file", "--out")),
}  # fmt: skip

APART: dict[str, tuple[Given, tuple[str, ...]]] = {
    "poses": ({"--motion": lambda f: poses(f, (0, 55, 0), (0, 60, 0))}, ("35 mm apart in every frame", "check unit")),
    "joint": (
        {**JOINT, "--motion": lambda f: _far(f)}, ("99 mm apart in every frame", "wrong direction? try --moving parent")
    ),
    "joint the other way round": (
        {**JOINT, "--motion": lambda f: _far(f), "--moving": "parent"}, ("apart in every frame", "try --moving child")
    ),
}  # fmt: skip


def refused(folder: Path, changes: Given, *said: str) -> str:
    """The one line that refuses a call; the call is one that works but for `changes`."""
    inputs, place = folder / "inputs", folder / "place"
    inputs.mkdir()
    place.mkdir()
    given: Given = {
        "MOVING": file("ball.stl", BALL),
        "FIXED": file("floor.stl", FLOOR),
        "--motion": lambda f: poses(f, (0, 20, 0)),
        "--unit": "mm",
        "--out": place / "deep/out",
        **changes,
    }
    made = {key: value(inputs) if callable(value) else value for key, value in given.items() if value is not None}
    bodies = [made.pop(name) for name in ("MOVING", "FIXED") if name in made]
    options = [f"{key}={v}" for key, value in made.items() for v in (value if isinstance(value, list) else [value])]
    before = inventory(folder)
    result = call("area", *bodies, *options)
    assert result.code == 2, result.err
    (line,) = result.complaints
    assert "Traceback" not in line
    assert not [part for part in said if part not in line], line
    assert inventory(folder) == before, "something was left behind"
    return line


def cases(table: dict[str, tuple[Given, tuple[str, ...]]]) -> pytest.MarkDecorator:
    return pytest.mark.parametrize(("changes", "said"), table.values(), ids=table.keys())


def test_the_call_that_is_spoilt_here_works(tmp_path: Path) -> None:
    with pytest.raises(AssertionError, match="results in|assert 0 == 2"):
        refused(tmp_path, {})
    assert (tmp_path / "place/deep/out/area.csv").is_file()


@cases(MESH_FILES)
def test_damaged_meshes_are_refused(tmp_path: Path, changes: Given, said: tuple[str, ...]) -> None:
    refused(tmp_path, changes, *said)


@cases(MOTION_FILES)
def test_unusable_motions_are_refused(tmp_path: Path, changes: Given, said: tuple[str, ...]) -> None:
    refused(tmp_path, changes, *said)


@cases(OPTIONS)
def test_impossible_options_are_refused(tmp_path: Path, changes: Given, said: tuple[str, ...]) -> None:
    refused(tmp_path, changes, *said)


@cases(APART)
def test_bodies_that_never_meet_are_refused(tmp_path: Path, changes: Given, said: tuple[str, ...]) -> None:
    refused(tmp_path, changes, *said)


@pytest.mark.parametrize("option", ["--region", "--region-moving"])
@pytest.mark.parametrize("code", ["__import__('os').mkdir('{}')", "[].append(open('{}', 'w'))", "exec('open(chr(46))')"])
def test_code_in_a_region_is_not_run(tmp_path: Path, option: str, code: str) -> None:
    refused(tmp_path, {option: code.format(tmp_path / "proof")}, option, "not understood")


def test_a_folder_that_cannot_be_written_to_is_refused_at_once(tmp_path: Path) -> None:
    """/proc takes no files, not even from root."""
    if not Path("/proc/self").is_dir():
        pytest.skip("no /proc here")
    refused(tmp_path, {"--out": "/proc/geocontact-out"}, "/proc", "--out")


def test_a_read_only_parent_is_refused_at_once(tmp_path: Path) -> None:
    if not hasattr(os, "geteuid") or os.geteuid() == 0:
        pytest.skip("root may write everywhere")
    locked = tmp_path / "locked"
    locked.mkdir()
    locked.chmod(0o555)
    refused(tmp_path, {"--out": locked / "out"}, "locked", "choose another --out")


@pytest.mark.parametrize("tokens", [["aera"], ["aera", "--unit", "mm"], ["--unit", "mm"], ["area"]])
def test_unknown_commands_and_bare_ones_are_refused(tmp_path: Path, tokens: list[str]) -> None:
    result = call(*tokens)
    assert (result.code, len(result.complaints)) == (2, 1), result.err
    assert "--help" in result.err
