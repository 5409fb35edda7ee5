"""`geocontact shoulder`: what is mistaken is told in one line, with code 2."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.calls import MESHES, call, written

TRIAL = MESHES / "overhead_P1T1S100"
BORE = "[numbers]\nbore = { "


def refused(folder: Path, words: str, *options: object, command: str = "simulate") -> None:
    """One complaint that says so, code 2, nothing written."""
    markers = (TRIAL / "markers.trc",) if command == "simulate" else ()
    told = call("shoulder", command, *markers, *options, "--out", folder / "out")
    assert told.code == 2 and words in told.err, told.err
    assert len(told.complaints) == 1 and not (folder / "out").exists()


DEVICES = {
    "no number": (
        '[numbers]\nbores = { value = 1, unit = "mm" }',
        "[numbers] bores: is not known here; perhaps bore",
    ),
    "no unit": ("[numbers]\nbore = 32", "[numbers] bore: is not a value with its unit"),
    "other unit": (BORE + 'value = 32, unit = "kg" }', "'kg' is not a unit of it; its SI unit is m"),
    "other source": (BORE + 'value = 32, unit = "mm", source = "guess" }', "source 'guess' is not known"),
    "metres": (BORE + 'value = 32, unit = "m" }', "32000 mm cannot be bore of the cylinder; that is 1 to 200 mm"),
    "text": (BORE + 'value = "wide", unit = "mm" }', "'wide' is not a finite number"),
    "no toml": ("bore: 32", "is not TOML"),
    "other key": ("nmae = 'x'", "nmae: is not known here; write name, based_on, numbers"),
    "more kinetic friction": (
        '[numbers]\nmu_k = { value = 1.2, unit = "1" }',
        "[numbers] mu_k: kinetic friction 1.2 is larger than the static one, 1",
    ),
    "unknown base": ("based_on = 'lucie'", "'lucie' is not built in"),
    "no room": (
        '[numbers]\nelevation_lower = { value = 160, unit = "deg" }',
        "the range of elevation from 160 to 150 degrees has no room",
    ),
    "no axis": (
        '[numbers]\naxis_elevation_x = { value = 0, unit = "1" }',
        "the axis of elevation has no length",
    ),
}


@pytest.mark.parametrize("name", DEVICES)
def test_a_device_that_cannot_be(tmp_path: Path, name: str) -> None:
    text, words = DEVICES[name]
    refused(tmp_path, words, "--device", written(tmp_path / "device.toml", text))


OPTIONS = {
    "level": (("--level", "120%"), "--level: 120 % cannot be a level of support: that is 0 to 100 %"),
    "less than nothing": (("--level", "-20%"), "--level: -20 % cannot be a level of support: that is 0 to 100 %"),
    "per cent": (("--level", "50"), "'50' may be meant in per cent; write 50% or 0.5"),
    "device": (("--device", "lucie"), "'lucie' is neither a file nor a built-in device"),
    "lone current": (("--tool-current", "2"), "--tool-current: has no effect without --tool"),
    "lone task": (("--task", "T1"), "--task: has no effect without --profile"),
    "map": (("--markers-map", "R_UP=humerus_rup"), "R_UP was not recorded"),
    "upright": (("--upright", "90:95"), "no frame with all reference markers from 90 to 95 s"),
}


@pytest.mark.parametrize("name", OPTIONS)
def test_options_that_cannot_be(tmp_path: Path, name: str) -> None:
    options, words = OPTIONS[name]
    refused(tmp_path, words, *options)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("time [s],event [-]\n0,0\n1,2\n9,0\n", "event is 2 at 1 s, neither 0 nor 1"),
        ("time [s],event [-]\n0,0\n9,0\n", "the tool never runs"),
        ("time [s],event [-]\n0,1\n0.1,0\n9,0\n", "right arm: the tool never runs while the arm is raised"),
        ("time [s],force [N]\n0,1\n9,0\n", "no column event or current"),
    ],
)
def test_a_tool_that_cannot_be(tmp_path: Path, text: str, words: str) -> None:
    refused(tmp_path, words, "--tool", written(tmp_path / "tool.csv", text))


def test_no_cuff_where_the_arm_is(tmp_path: Path) -> None:
    """Shoulders half a metre behind; the start alone was judged once ("mm from the cuff's middle")."""
    text = '[numbers]\nlink_1_y = { value = 450, unit = "mm" }\n'
    refused(
        tmp_path,
        "right arm: the sphere is far out of the cuff for 100% of the time",
        "--device",
        written(tmp_path / "device.toml", text),
    )


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("arm = 3", "none of upper_arm, shoulder_width, torso"),
        ("upper_arm = 300", 'upper_arm: is not a value with its unit; write upper_arm = { value = …, unit = "mm" }'),
        ('upper_arm = { value = 3, unit = "m" }', "3000 mm cannot be a length of a person: that is 100 to 1000 mm"),
    ],
)
def test_a_person_that_cannot_be(tmp_path: Path, text: str, words: str) -> None:
    refused(tmp_path, words, "--person", written(tmp_path / "p1.toml", text))


def test_help_lists_the_commands() -> None:
    told = call("shoulder", "--help")
    assert told.code == 0 and "simulate" in told.out and "compare" in told.out


def test_angles_beyond_all_stops_at_the_start(tmp_path: Path) -> None:
    """Ranges that hold no pose of an arm that hangs down; stops so soft that they give way."""
    ranges = {"passive_1": (40, 60), "passive_2": (20, 30), "elevation": (120, 150)}
    lines = [
        f'{joint}_{end} = {{ value = {angle}, unit = "deg" }}'
        for joint, ends in ranges.items()
        for end, angle in zip(("lower", "upper"), ends, strict=True)
    ]
    text = "\n".join(["[numbers]", *lines, 'stop_stiffness = { value = 0.5, unit = "N m/rad" }'])
    refused(
        tmp_path, "at the start all joints are beyond their stops", "--device", written(tmp_path / "device.toml", text)
    )


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--reserve", "100%"), "--reserve: 100 % leaves no support; give less"),
        (("--worst-share", "20%"), "--worst-share: has no effect with --aim mean; give --aim cvar"),
        (("--draws", "5"), "--draws: 5 draws are too few for an interval; give 20 or more"),
        (("--study", "lost.toml"), "lost.toml"),
    ],
)
def test_support_that_cannot_be_asked_for(tmp_path: Path, options: tuple[str, str], words: str) -> None:
    refused(tmp_path, words, *options, command="optimise")
