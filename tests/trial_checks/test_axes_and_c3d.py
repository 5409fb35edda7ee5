"""One option turns markers, plates and points alike, and a .c3d file is read as the same files of text are."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.io.plate_files import CENTRE, channels, plate_file, stance
from tests.trial_checks.as_c3d import LABORATORY, as_c3d, laboratory, plates_as_c3d
from tests.trial_checks.damage import Said, numbers
from tests.trial_checks.test_commands import COMMANDS, COMPARED, GATHER, OVERHEAD_STUDY, cop, gather, trial_of

TURNED = {
    "prosthesis simulate": ("walking.trc", "standing.trc", "plates.mot"),
    "prosthesis calibrate": ("walking.trc", "standing.trc", "plates.mot"),
    "prosthesis design": ("walking.trc", "standing.trc", "plates.mot"),
    "prosthesis scale": ("standing.trc",),
    "prosthesis compare": ("walking.trc", "standing.trc", "plates.mot"),
    "joint": ("walking.trc", "standing.trc"),
    "ik": ("walk.trc",),
    "scale": ("still.trc",),
    "shoulder simulate": ("markers.trc",),
    "shoulder study": ("markers.trc",),
    "shoulder optimise": ("markers.trc",),
    "id": ("grf.mot",),
    "cop": ("plates.mot",),
    "gap gather": ("plates.mot", "t02.mot"),
    "sit-to-stand calibrate": tuple(f"T{k}_plates.mot" for k in (1, 2, 3)),
}
UNKNOWN = ("ik", "scale")
"""Of the leg's labels no landmark is known; `ik` finds the tilt when it has the pelvis."""
CLOSE, SINGLE = 2e-6, 3e-5
"""m, rad, N, N m and their rates; text has nine decimals, .c3d files single precision in mm and N mm."""


@pytest.fixture(scope="module")
def clean(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Said]:
    """What each command says and reads of its trial as it is shipped."""
    return {command: COMMANDS[command][0](trial_of(command, tmp_path_factory.mktemp("clean"))) for command in TURNED}


def alike_to(found: Said, expected: Said, close: float) -> None:
    """Both read the same numbers."""
    values, known = np.array(numbers(found.made)), np.array(numbers(expected.made))
    assert len(known) > 100
    np.testing.assert_allclose(values, known, rtol=close, atol=close)


@pytest.mark.parametrize("command", TURNED)
def test_one_option_turns_markers_and_plates(command: str, tmp_path: Path, clean: dict[str, Said]) -> None:
    """The same walk along -x with z up is read as it was before, by `axes` alone; without it, something else."""
    folder = trial_of(command, tmp_path)
    laboratory(folder, TURNED[command])
    run = COMMANDS[command][0]
    turned = run(folder, axes="-x,z,y")
    assert turned == clean[command]
    alike_to(turned, clean[command], CLOSE)
    if command not in UNKNOWN:
        assert run(folder) - clean[command]


def test_a_c3d_with_plates_simply_works(tmp_path: Path) -> None:
    """A plate with z up in a .c3d under a foot that stands on it: `axes` is all that `cop` and `gap gather` need."""
    plate_file(tmp_path / "plates.c3d", channels(stance()))
    plate_file(tmp_path / "t02.c3d", channels(0.8 * stance() ** 1.5))
    time = np.arange(0.05, 0.95, 0.01)
    foot = np.column_stack([time, np.full((len(time), 4), [CENTRE[0] - 0.1, 0.005, -CENTRE[1], 0.0])])
    head = "time [s],x [m],y [m],z [m],pitch [rad]"
    for name, by in (("foot", 0.0), ("t01", 0.0), ("t02", 0.02)):
        foot[:, 1] += by * np.sin(9.0 * time)
        np.savetxt(tmp_path / f"{name}.csv", foot, delimiter=",", comments="", header=head)
    (tmp_path / "spheres.csv").write_text(
        "px [m],py [m],pz [m],radius [m],zone\n0,0,0,0.005,all\n0.2,0,0,0.005,all\n", encoding="utf-8"
    )
    plate = {"compare": tmp_path / "plates.c3d", "plate": None, "axes": "x,z,-y"}
    assert not [line for line in cop(tmp_path, **plate) if "plate" in line or "refused" in line]
    text = GATHER.replace('plate = "own_force"\n', "").replace(".mot", ".c3d")
    (tmp_path / "gather.toml").write_text(text, encoding="utf-8")
    assert gather(tmp_path, axes="x,z,-y") == set()
    assert "its normal is (" in "".join(gather(tmp_path))


BOTH = ("own_force", "other_force")
Given = dict[str, Any]


def walk(folder: Path) -> tuple[Given, Given]:
    as_c3d(folder, "walking.trc", "plates.mot", BOTH)
    as_c3d(folder, "standing.trc")
    return {}, {"markers": "walking.c3d", "static": "standing.c3d", "plates": "walking.c3d", "plate": "1"}


def of_both(folder: Path) -> tuple[Given, Given]:
    return {}, walk(folder)[1] | {"other_plate": "2"}


def study_of_walks(folder: Path) -> tuple[Given, Given]:
    walk(folder)
    text = COMPARED.replace("plates.mot", "walking.c3d").replace(".trc", ".c3d")
    return {}, {"study": text.replace("own_force", "1").replace("other_force", "2")}


def one(name: str, option: str) -> Callable[[Path], tuple[Given, Given]]:
    """Markers of one file alone, by an option."""

    def files(folder: Path) -> tuple[Given, Given]:
        as_c3d(folder, name)
        return {}, {option: name.replace(".trc", ".c3d")}

    return files


def study_of_arms(folder: Path) -> tuple[Given, Given]:
    as_c3d(folder, "markers.trc")
    return {}, {"study": OVERHEAD_STUDY.replace(".trc", ".c3d")}


def under_a_leg(folder: Path) -> tuple[Given, Given]:
    plates_as_c3d(folder, "grf.mot", ("plate_force",))
    given = {"loads": None, "plates": folder / "grf.mot", "plate": ("plate_force=foot_r",)}
    return given, given | {"plates": folder / "grf.c3d", "plate": ("1=foot_r",)}


def rising(folder: Path) -> tuple[Given, Given]:
    text = (folder / "study.toml").read_text(encoding="utf-8")
    for k in (1, 2, 3):
        plates_as_c3d(folder, f"T{k}_plates.mot", ("feet_force", "chair_force"))
    text = text.replace("_plates.mot", "_plates.c3d").replace("feet_force", "1").replace("chair_force", "2")
    (folder / "c3d.toml").write_text(text, encoding="utf-8")
    return {}, {"study": "c3d.toml"}


RECORDED: dict[str, Callable[[Path], tuple[Given, Given]]] = {
    "prosthesis simulate": of_both,
    "prosthesis calibrate": walk,
    "prosthesis design": walk,
    "prosthesis scale": one("standing.trc", "markers"),
    "prosthesis compare": study_of_walks,
    "joint": walk,
    "ik": one("walk.trc", "markers"),
    "scale": one("still.trc", "markers"),
    "id": under_a_leg,
    "shoulder simulate": one("markers.trc", "markers"),
    "shoulder study": study_of_arms,
    "shoulder optimise": study_of_arms,
    "sit-to-stand calibrate": rising,
}
"""What writes a command's trial as .c3d beside it, with options of either; `cop` and `gap gather` are above."""


UNLOADED = "its zero is not known"
"""Said of channels of a .c3d file, which have one, where somebody stands on the plate all the time."""


@pytest.mark.parametrize("command", RECORDED)
def test_a_c3d_is_read_as_the_files_of_text(command: str, tmp_path: Path) -> None:
    """One trial as .trc and .mot and as a .c3d of a laboratory: the same words and the same numbers."""
    folder = trial_of(command, tmp_path)
    text, c3d = RECORDED[command](folder)
    run = COMMANDS[command][0]
    expected, found = run(folder, **text), run(folder, axes=LABORATORY, **c3d)
    words = [{re.sub(r"^\S+: ", "", line) for line in said if UNLOADED not in line} for said in (found, expected)]
    assert words[0] == words[1]
    alike_to(found, expected, SINGLE)
