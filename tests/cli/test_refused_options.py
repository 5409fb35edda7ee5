"""Options that make no sense: exit 2, one line that names the option and the remedy, nothing left behind."""

from __future__ import annotations

import os
import re
from pathlib import Path

import pytest

from tests.cli.calls import KNEE, call, written
from tests.cli.spoilt import JOINT, Cases, Given, each, file, placed, refuse, sweep

RIGID = "1 0 0 0\n0 1 0 0\n0 0 1 0\n"


def compared(text: str, **options: str) -> Given:
    """Measured areas of this text."""
    return {"--compare": file("measured.csv", text), **{f"--{key}": value for key, value in options.items()}}


OPTIONS: Cases = {
    "missing --unit": ({"--unit": None}, ("--unit", "no unit", "mm, cm, m or in")),
    "missing --out": ({"--out": None}, ("--out",)),
    "unknown unit": ({"--unit": "inch"}, ("--unit", "inch", "mm")),
    "missing mesh": ({"MOVING": None}, ("FIXED",)),
    "unknown option": ({"--treshold": "4"}, ("--treshold",)),
    "neither --motion nor --sweep": ({"--motion": None}, ("--motion", "--sweep")),
    "both --motion and --sweep": ({"--sweep": "a=0:1:1"}, ("--motion", "--sweep")),
    "threshold negative": ({"--threshold": "-1"}, ("--threshold", "-1", "negative")),
    "threshold with a decimal comma": (
        {"--threshold": "0,5"},
        ("--threshold: '0,5'", "decimal comma", "write --threshold 0.5", "0mm,5"),
    ),
    "threshold in metres": ({"--threshold": "4m"}, ("--threshold: 4000 mm cannot be", "0 to 200 mm", "is 4 mm meant?")),
    "threshold a word": ({"--threshold": "four"}, ("--threshold", "'four'", "--threshold 4")),
    "threshold nan": ({"--threshold": "nan"}, ("--threshold", "nan", "--threshold 4")),
    "threshold infinite": ({"--threshold": "inf"}, ("--threshold", "inf", "--threshold 4")),
    "threshold empty": ({"--threshold": ""}, ("--threshold", "--threshold 4")),
    "threshold list with a hole": ({"--threshold": "1,,4"}, ("--threshold", "--threshold 4")),
    "threshold in an unknown unit": ({"--threshold": "4 furlong"}, ("--threshold", "4 furlong", "--threshold 4mm")),
    "threshold option twice": ({"--threshold": ["1", "4"]}, ("--threshold",)),
    "flag with a word": ({"--save-map": "maybe"}, ("--save-map", "maybe")),
    "threshold twice": ({"--threshold": "4,0.4cm"}, ("--threshold", "twice", "give each once")),
    "unknown joint": ({**JOINT, "--joint": "elbow"}, ("knee.osim", "'elbow'", "knee_r")),
    "--osim without --joint": ({**JOINT, "--joint": None}, ("--joint", "--osim")),
    "--joint without --osim": ({**JOINT, "--osim": None}, ("--osim", "--joint")),
    "missing model": ({**JOINT, "--osim": "nowhere.osim"}, ("nowhere.osim", "check the path")),
    "model is no XML": (
        {**JOINT, "--osim": file("knee.osim", "solid knee")},
        ("knee.osim", "not a readable OpenSim model"),
    ),
    "unknown moving body": ({**JOINT, "--moving": "femur"}, ("--moving", "femur", "parent")),
    "map without columns": (
        {"--map": "rz", "--motion": JOINT["--motion"]},
        ("--map", "target=column", "rz=knee_flexion"),
    ),
    "map to nowhere": ({"--map": "rw=knee_tx", "--motion": JOINT["--motion"]}, ("--map", "'rw'", "rx, ry, rz")),
    "map of an unknown column": (
        {"--map": "rz=hip", "--motion": JOINT["--motion"]},
        ("gait.mot", "'hip'", "knee_flexion"),
    ),
    "map of a target twice": (
        {"--map": "tx=knee_tx,tx=knee_ty", "--motion": JOINT["--motion"]},
        ("--map", "'tx'", "twice"),
    ),
    "unknown convention": ({"--convention": "isb"}, ("--convention", "isb", "grood-suntay")),
    "region that cannot be read": ({"--region": "ny >"}, ("--region", "ny >", "ny>0.25")),
    "region with an unknown name": ({"--region": "nw > 0"}, ("--region", "'nw'", "nx, ny, nz")),
    "region that is a number": ({"--region": "ny + 1"}, ("--region", "ny + 1", "ny>0.25")),
    "region that says nothing of the faces": ({"--region": "1 > 0"}, ("--region", "1 > 0", "ny>0.25")),
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
    "region of no face of MOVING": (
        {"--region-moving": "x > 1e9"},
        ("--region-moving", "no face of ball.stl", "check"),
    ),
    "face number beyond the mesh": (
        {"--region": file("faces.txt", "0\n9999\n")},
        ("faces.txt line 2", "9999", "start at 0"),
    ),
    "face number negative": ({"--region": file("faces.txt", "-1\n")}, ("faces.txt line 1", "-1")),
    "face number twice": ({"--region": file("faces.txt", "1 2 1\n")}, ("faces.txt line 1", "already", "once")),
    "face file of words": ({"--region": file("faces.txt", "all\n")}, ("faces.txt line 1", "'all'", "0-based")),
    "face file empty": ({"--region": file("faces.txt", "# none\n")}, ("faces.txt", "no faces")),
    "split along no axis": ({"--split": "w", "--side": "left"}, ("--split", "'w'", "z=1.5")),
    "split at a word": ({"--split": "z=middle", "--side": "left"}, ("--split", "middle")),
    "split at nan": ({"--split": "z=nan", "--side": "left"}, ("--split", "nan")),
    "medial neither side": ({"--split": "z", "--medial": "left"}, ("--medial", "left")),
    "unknown rule": ({"--rule": "vertices"}, ("--rule", "vertices", "all-vertices")),
    "bounds zero": ({"--bounds": "0"}, ("--bounds", "'0'", "2%")),
    "bounds a word": ({"--bounds": "tight"}, ("--bounds", "tight", "2%")),
    "tolerance negative": ({"--tolerance": "-2%"}, ("--tolerance", "'-2%'", "2%")),
    "tolerance empty": ({"--tolerance": ""}, ("--tolerance", "''", "2%")),
    "workers negative": ({"--workers": "-2"}, ("--workers",)),
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
        {**sweep("a=0:1:1"), "--axis": file("axis.txt", "the knee's own")},
        ("axis.txt", "x,y,z,dx,dy,dz"),
    ),
    "axis of another fit": (
        {**sweep("a=0:1:1"), "--axis": file("fit.json", '{"radius_mm": 3}')},
        ("fit.json", "fit.json of a cylinder fit"),
    ),
    "placement of three rows": (placed(RIGID), ("place.txt", "4x4", "4 rows of 4 numbers")),
    "placement that scales": (placed("2 0 0 0\n0 2 0 0\n0 0 2 0\n0 0 0 1\n"), ("place.txt", "orthonormal", "scale")),
    "placement that mirrors": (
        placed("1 0 0 0\n0 1 0 0\n0 0 -1 0\n0 0 0 1\n"),
        ("place.txt", "mirror", "mirror the mesh"),
    ),
    "placement of nan": (placed(RIGID.replace("0 0\n", "nan 0\n", 1) + "0 0 0 1\n"), ("place.txt", "finite")),
    "placement with a bad last row": (placed(RIGID + "0 0 0 2\n"), ("place.txt", "last row", "0 0 0 1")),
    "placement file missing": ({"--place-moving": "nowhere.txt"}, ("nowhere.txt", "check the path")),
    "placement by an unknown body": ({"--place-fixed": f"{KNEE}:patella"}, ("knee.osim", "'patella'", "tibial_insert")),
    "placement by a missing model": ({"--place-fixed": "nowhere.osim:tibia"}, ("nowhere.osim", "check the path")),
    "comparison missing": ({"--compare": "nowhere.csv"}, ("nowhere.csv", "there is no such file")),
    "comparison empty": (compared(""), ("measured.csv", "is empty")),
    "comparison without time": (compared("area_fixed [mm^2]\n1\n"), ("measured.csv", "'time [s]'")),
    "comparison without an area": (compared("time [s],force [N]\n0,1\n"), ("measured.csv", "area_fixed [mm^2]")),
    "comparison outside the time window": (
        compared("time [s],area_fixed [mm^2]\n7,100\n"),
        ("measured.csv", "time 7 lies outside 0 … 0"),
    ),
    "comparison of an unknown column": (
        compared("time [s],area_patella [mm^2]\n0,100\n"),
        ("measured.csv", "area_patella [mm^2]", "area_fixed [mm^2]"),
    ),
    "comparison of another threshold": (
        compared("time [s],threshold [mm],area_fixed [mm^2]\n0,3,100\n"),
        ("measured.csv", "3 mm", "--threshold"),
    ),
    "comparison without a threshold": (
        compared("time [s],area_fixed [mm^2]\n0,100\n", threshold="1,4"),
        ("measured.csv", "threshold [mm]"),
    ),
    "comparison of words": (compared("time [s],area_fixed [mm^2]\n0,large\n"), ("measured.csv", "number")),
    "comparison with a bad time": (
        compared("time [s],area_fixed [mm^2]\n0,1\nend,1\n"),
        ("measured.csv row 3", "time"),
    ),
    "--out is a file": ({"--out": file("result", "mine")}, ("result", "is a file", "--out names a folder")),
    "--out below a file": (
        {"--out": lambda f: written(f / "result", "mine") / "sub"},
        ("result", "is a file", "--out"),
    ),
}


@each(OPTIONS)
def test_impossible_options_are_refused(tmp_path: Path, changes: Given, said: tuple[str, ...]) -> None:
    refuse(tmp_path, changes, *said)


@pytest.mark.parametrize("option", ["--region", "--region-moving"])
@pytest.mark.parametrize(
    "code", ["__import__('os').mkdir('{}')", "[].append(open('{}', 'w'))", "exec('open(chr(46))')"]
)
def test_code_in_a_region_is_not_run(tmp_path: Path, option: str, code: str) -> None:
    refuse(tmp_path, {option: code.format(tmp_path / "proof")}, option, "not understood")


def test_a_folder_that_cannot_be_written_to_is_refused_at_once(tmp_path: Path) -> None:
    """/proc takes no files, not even from root."""
    if not Path("/proc/self").is_dir():
        pytest.skip("no /proc here")
    refuse(tmp_path, {"--out": "/proc/geocontact-out"}, "/proc", "--out")


def test_a_read_only_parent_is_refused_at_once(tmp_path: Path) -> None:
    if not hasattr(os, "geteuid") or os.geteuid() == 0:
        pytest.skip("root may write everywhere")
    locked = tmp_path / "locked"
    locked.mkdir()
    locked.chmod(0o555)
    refuse(tmp_path, {"--out": locked / "out"}, "locked", "choose another --out")


@pytest.mark.parametrize("tokens", [["aera"], ["aera", "--unit", "mm"], ["--unit", "mm"], ["area"]])
def test_unknown_commands_and_bare_ones_are_refused(tmp_path: Path, tokens: list[str]) -> None:
    result = call(*tokens)
    assert (result.code, len(result.complaints)) == (2, 1), result.err
    assert "--help" in result.err or "did you mean area?" in result.err


AREA = ["area", "a.stl", "b.stl", "--unit", "mm", "--out", "x"]
SLIPS = {
    "unknown option": ([*AREA, "--zzz"], "--zzz is not an option of area; see geocontact area --help"),
    "misspelt option": (
        [*AREA, "--treshold", "4"],
        "--treshold is not an option of area; did you mean --threshold?",
    ),
    "command of a group": (["settle"], "settle is not a command (`knee settle`?); "),
    "unknown command": (["zzz"], "zzz is not a command; there are app, area, cohort, cop, "),
    "choice": ([*AREA, "--medial", "left"], 'Invalid value "left" for --medial. Choose from: "-", "+"; see'),
    "type": ([*AREA, "--workers", "all"], 'Invalid value for --workers: unable to convert "all" into int; see'),
    "twice": ([*AREA, "--unit", "m"], "Parameter --unit specified multiple times; see geocontact area --help"),
    "too much": (["demo", "x"], "Unused Tokens: ['x']; see geocontact demo --help"),
}


@pytest.mark.parametrize(("tokens", "line"), SLIPS.values(), ids=SLIPS.keys())
def test_slips_are_named_in_one_well_formed_line(tokens: list[str], line: str) -> None:
    """The parser's own sentence and the remedy, with one mark between them."""
    result = call(*tokens)
    (said,) = result.complaints
    assert result.code == 2 and said.startswith(line), said
    assert not re.search(r"[.?!;:,][.?!;:,]", said), said
