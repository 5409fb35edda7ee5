"""No option is silently without effect: beside any kind of motion it changes the areas, or it is refused by name."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.calls import call, gait, poses, unpictured
from tests.cli.spoilt import JOINT, Cases, Given, each, file, lifted, refuse, sound, sweep, tokens

SLIDER = """<OpenSimDocument Version="40000"><Model name="m"><BodySet name="bodyset"><objects><Body name="floor"/>
<Body name="ball"/></objects></BodySet><JointSet name="jointset"><objects><SliderJoint name="slide">
<socket_parent_frame>/bodyset/floor</socket_parent_frame><socket_child_frame>/bodyset/ball</socket_child_frame>
<coordinates><Coordinate name="x"/></coordinates></SliderJoint></objects></JointSet></Model></OpenSimDocument>"""
COLUMNS = "time [s],tx [mm],ty [mm],tz [mm],{} [deg],{} [deg],{} [deg]\n0,1,19,2,3,4,5\n1,0,18,2,5,4,-3\n"
PLACE = "tx=tx,ty=ty,tz=tz"

MOTIONS: dict[str, Given] = {
    "quaternions": {},
    "Euler columns": {"--motion": file("euler.csv", COLUMNS.format("rx", "ry", "rz")), "--order": "XYZ"},
    "map": {"--motion": file("map.csv", COLUMNS.format("a", "b", "c")), "--map": f"rx=a,ry=b,rz=c,{PLACE}"},
    "map of one rotation": {"--motion": file("map.csv", COLUMNS.format("a", "b", "c")), "--map": f"rx=a,{PLACE}"},
    "map of translations": {"--motion": file("map.csv", COLUMNS.format("a", "b", "c")), "--map": PLACE},
    "joint": JOINT,
    "joint that only slides": {
        "--motion": file("slide.csv", "time [s],x [mm]\n0,1\n1,3\n"),
        "--osim": file("slide.osim", SLIDER),
        "--joint": "slide",
        **lifted(),
    },
    "knee angles": {
        "--motion": file("knee.csv", COLUMNS.format("flexion", "adduction", "rotation")),
        "--convention": "grood-suntay",
        "--side": "right",
    },
    "sweep": sweep("turn=0:3:3"),
}
OPTIONS: dict[str, Given] = {
    "--order": {"--order": "ZYX"},
    "--angles": {"--angles": "rad"},
    "--osim": {"--osim": JOINT["--osim"], "--joint": "knee_r"},
    "--joint": {"--joint": "knee_r"},
    "--map": {"--map": f"rz=a,ry=b,{PLACE}"},
    "--convention": {"--convention": "grood-suntay", "--side": "left"},
    "--side": {"--side": "left"},
    "--moving": {"--moving": "parent"},
    "--axis": {"--axis": "5,0,0,1,0,0"},
    "--medial": {"--medial": "+"},
    "--tolerance": {"--tolerance": "5%"},
}
TELLING = {
    ("Euler columns", "--order"),
    ("Euler columns", "--angles"),
    ("map", "--order"),
    ("map", "--angles"),
    ("map", "--map"),
    ("map of one rotation", "--angles"),
    ("map of one rotation", "--map"),
    ("map of translations", "--map"),
    ("joint", "--angles"),
    ("joint", "--moving"),
    ("joint that only slides", "--moving"),
    ("knee angles", "--angles"),
    ("knee angles", "--convention"),
    ("knee angles", "--side"),
    ("knee angles", "--moving"),
    ("sweep", "--axis"),
}
"""Option beside motion where it means something else than what the motion has without it."""


def areas(folder: Path, given: Given) -> tuple[int, str, bytes]:
    """Exit code, complaint and table of the call with what is given."""
    folder.mkdir()
    with unpictured():
        result = call(*tokens(folder, sound(folder) | given))
    table = folder / "place/deep/out/area.csv"
    return result.code, "".join(result.complaints), table.read_bytes() if table.is_file() else b""


@pytest.mark.parametrize("motion", MOTIONS)
def test_every_option_changes_the_areas_or_is_refused(tmp_path: Path, motion: str) -> None:
    code, said, plain = areas(tmp_path / "plain", MOTIONS[motion])
    assert (code, said) == (0, "")
    for option, more in OPTIONS.items():
        if more.items() <= MOTIONS[motion].items():
            continue
        code, said, table = areas(tmp_path / option, MOTIONS[motion] | more)
        if (motion, option) in TELLING:
            assert (code, said, table == plain) == (0, "", False), f"{option}: {said}"
        else:
            assert code == 2 and not table, f"{option} did nothing and nobody said so"


IDLE: Cases = {
    "--order beside quaternions": ({"--order": "XYZ"}, ("--order", "no two angles", "poses.csv", "leave it out")),
    "--order of one rotation": (
        MOTIONS["map of one rotation"] | {"--order": "XYZ"},
        ("--order", "no two angles", "map.csv", "leave it out"),
    ),
    "--angles beside quaternions": ({"--angles": "deg"}, ("--angles", "no angle is read", "poses.csv", "leave it out")),
    "--angles beside translations": (
        MOTIONS["map of translations"] | {"--angles": "deg"},
        ("--angles", "no angle is read", "map.csv", "leave it out"),
    ),
    "--angles beside a joint that only slides": (
        MOTIONS["joint that only slides"] | {"--angles": "deg"},
        ("--angles", "no angle is read", "slide.csv", "leave it out"),
    ),
    "--tolerance without --compare": ({"--tolerance": "5%"}, ("--tolerance", "without --compare", "measured areas")),
    "--medial without --split": ({"--medial": "-"}, ("--medial", "without --split", "give --split")),
    "--axis without --sweep": ({"--axis": "0,0,0,0,0,1"}, ("--axis", "without --sweep", "give --sweep")),
    "--side without --convention": (
        {"--side": "left"},
        ("--side", "has no effect without --convention or --split", "give --convention or --split"),
    ),
    "--convention without --side": ({"--convention": "grood-suntay"}, ("--side", "missing", "right or left")),
    "--convention beside poses": (
        OPTIONS["--convention"],
        ("--convention", "no knee angle", "poses.csv", "--map"),
    ),
    "--convention beside --osim": (
        {**JOINT, "--convention": "grood-suntay", "--side": "left"},
        ("--convention", "has no effect with --osim", "give one"),
    ),
    "--map beside --osim": ({**JOINT, "--map": "tx=knee_tx"}, ("--map", "--osim", "give one")),
    "--order beside --osim": ({**JOINT, "--order": "XYZ"}, ("--order", "joint", "leave it out")),
    "--moving parent without a joint": ({"--moving": "parent"}, ("--moving", "parent", "swap the two meshes")),
    "--moving child without a joint": ({"--moving": "child"}, ("--moving", "child", "swap the two meshes")),
    **{
        f"{option} beside --sweep": (
            MOTIONS["sweep"] | more,
            (f"{next(iter(more))}: ", "has no effect with --sweep", "leave it"),
        )
        for option, more in OPTIONS.items()
        if option not in ("--axis", "--medial", "--side", "--tolerance")
    },
}


@each(IDLE)
def test_options_without_effect_are_refused(tmp_path: Path, changes: Given, said: tuple[str, ...]) -> None:
    refuse(tmp_path, changes, *said)


def test_an_option_that_one_of_several_motions_needs_is_not_idle(tmp_path: Path) -> None:
    """Euler columns beside quaternions: the order is for the first."""
    euler = file("euler.csv", COLUMNS.format("rx", "ry", "rz"))
    given: Given = {"--motion": lambda folder: [euler(folder), poses(folder, (0, 20, 0))], "--order": "XYZ"}
    code, said, _ = areas(tmp_path / "both", given)
    assert (code, said) == (0, "")
    two: Given = {"--motion": lambda f: [gait(f, [0]), poses(f, (0, 20, 0))], "--order": "XYZ"}
    (tmp_path / "neither").mkdir()
    refuse(tmp_path / "neither", two, "--order", "gait.csv", "poses.csv")
