"""Motions that cannot be used: exit 2, one line that names file, place and remedy, nothing left behind."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from tests.cli.calls import poses, storage, written
from tests.cli.spoilt import JOINT, Cases, Given, each, file, made, refuse

HEAD = "time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz\n"
EULER = "time [s],tx [mm],ty [mm],tz [mm],rx [deg],ry [deg],rz [deg]\n0,0,20,0,0,0,0\n"


def motion(text: str, name: str = "poses.csv", **options: str) -> Given:
    """A motion file of this text."""
    return {"--motion": file(name, text), **{f"--{key}": value for key, value in options.items()}}


def edited(*changes: str, frames: tuple[int, ...] = (0, 30)) -> Callable[[Path], Path]:
    """The .mot of the shipped knee with parts replaced: old, new, old, new …"""

    def change(folder: Path) -> Path:
        plain = storage(folder, frames)
        text = plain.read_text(encoding="utf-8")
        for old, new in zip(changes[::2], changes[1::2], strict=True):
            assert old in text
            text = text.replace(old, new)
        return written(plain, text)

    return change


FAR = edited("-0.0306176748938", "-0.1306176748938", frames=(0,))

MOTIONS: Cases = {
    "missing file": ({"--motion": "nowhere.csv"}, ("nowhere.csv", "there is no such file", "check the path")),
    "folder": ({"--motion": made("poses.csv")}, ("poses.csv", "is a folder", "name a file")),
    "unknown format": (
        motion(HEAD + "0,0,20,0,1,0,0,0\n", "poses.trc"),
        ("poses.trc", ".csv, .xlsx, .mot, .sto, .txt"),
    ),
    "pattern without a file": ({"--motion": "nowhere*.csv"}, ("nowhere*.csv", "matches no file", "check the pattern")),
    "two motions of one name": (
        {"--motion": lambda f: [poses(f, (0, 20, 0)), poses(made("b")(f), (0, 20, 0))]},
        ("two motions", "poses"),
    ),
    "missing quaternion": (motion("time [s],tx [mm],ty [mm],tz [mm]\n0,0,20,0\n"), ("poses.csv", "qw, qx, qy, qz")),
    "missing translation": (
        motion(HEAD.replace(",ty [mm]", "") + "0,0,0,1,0,0,0\n"),
        ("poses.csv", "no column 'ty'", "columns are"),
    ),
    "length without a unit": (motion(HEAD.replace("ty [mm]", "ty") + "0,0,20,0,1,0,0,0\n"), ("poses.csv", "ty [mm]")),
    "no rows": (motion(HEAD), ("poses.csv", "no rows")),
    "empty": (motion(""), ("poses.csv", "empty")),
    "NaN in a needed column": (
        motion(HEAD + "0,0,20,0,1,0,0,0\n1,0,nan,0,1,0,0,0\n"),
        ("poses.csv", "line 3", "column 'ty' is nan"),
    ),
    "empty cell in a needed column": (
        motion(HEAD + "0,0,20,0,1,0,0,0\n1,0,20,0,1,,0,0\n"),
        ("poses.csv", "line 3", "column 'qx' is nan"),
    ),
    "word in a cell": (motion(HEAD + "0,0,up,0,1,0,0,0\n"), ("poses.csv", "line 2", "'up'", "not a number")),
    "time stands": (
        motion(HEAD + "0,0,20,0,1,0,0,0\n0,0,20,0,1,0,0,0\n"),
        ("poses.csv", "line 3", "time must increase"),
    ),
    "time runs back": (
        motion(HEAD + "0,0,20,0,1,0,0,0\n-1,0,20,0,1,0,0,0\n"),
        ("poses.csv", "line 3", "time must increase"),
    ),
    "quaternion too long": (
        motion(HEAD + "0,0,20,0,1,0,0,0\n1,0,20,0,1.002,0,0,0\n"),
        ("poses.csv", "line 3", "length 1.002", "normalise"),
    ),
    "quaternion of zeros": (motion(HEAD + "0,0,20,0,0,0,0,0\n"), ("poses.csv", "line 2", "length 0", "normalise")),
    "Euler columns without an order": (
        motion(EULER),
        ("poses.csv", "order", "--order XYZ"),
    ),
    "nonsense order": (
        motion(EULER, order="XXY"),
        ("--order", "XXY", "each axis once"),
    ),
    "Euler angles without a unit": (
        motion("time [s],tx [mm],ty [mm],tz [mm],rx,ry,rz\n0,0,20,0,0,0,0\n", order="XYZ"),
        ("poses.csv", "--angles"),
    ),
    "contradictory angle units": (
        {**JOINT, "--motion": edited("inDegrees=yes\n", "inDegrees=no\nAngles are in degrees.\n")},
        ("gait.mot", "inDegrees=no but the text says degrees", "--angles deg or rad"),
    ),
    "no angle unit at all": ({**JOINT, "--motion": edited("inDegrees=yes\n", "")}, ("gait.mot", "--angles deg or rad")),
    "degrees declared as radians": (
        {**JOINT, "--motion": edited("=yes", "=no", "6.603143", "66.03143")},
        ("gait.mot", "too much for the radians", "--angles deg or rad"),
    ),
    "coordinates without a model": ({"--motion": JOINT["--motion"]}, ("gait.mot", "--osim and --joint", "--map")),
    "no coordinate of the joint": (
        {**JOINT, "--motion": edited("knee_", "hip_")},
        ("gait.mot", "no column for any coordinate", "hip_flexion"),
    ),
}


APART: Cases = {
    "poses": (
        {"--motion": lambda f: poses(f, (0, 55, 0), (0, 60, 0))},
        ("35 mm apart in every frame", "check unit", "--place-moving", "nearest in frame 1 of 2, 0 s"),
    ),
    "joint": ({**JOINT, "--motion": FAR}, ("99 mm apart in every frame", "wrong direction? try --moving parent")),
    "joint the other way round": (
        {**JOINT, "--motion": FAR, "--moving": "parent"},
        ("apart in every frame", "try --moving child"),
    ),
}


@each(MOTIONS)
def test_unusable_motions_are_refused(tmp_path: Path, changes: Given, said: tuple[str, ...]) -> None:
    refuse(tmp_path, changes, *said)


@each(APART)
def test_bodies_that_never_meet_are_refused(tmp_path: Path, changes: Given, said: tuple[str, ...]) -> None:
    refuse(tmp_path, changes, *said)
