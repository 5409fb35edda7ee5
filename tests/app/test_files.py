"""What the window says of a file that was dropped, against files composed here and counts made without its readers."""

from __future__ import annotations

import importlib.util
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.frame.file_content import Content, content_of, markers_in_common
from geocontact.app.files import contents, known_file, page_name, write_page
from geocontact.cli.demo import sample_folder
from tests.step_files import box
from tests.trial_checks.as_c3d import write_c3d


def said(content: Content) -> str:
    return "\n".join([content.kind, *content.facts, *content.warnings, content.wrong])


def test_markers_and_plates_of_a_c3d(tmp_path: Path) -> None:
    """A force of 700 N sin(pi s) on one plate over 51 frames at 50 Hz, one marker hidden in 5 of them."""
    time = np.linspace(0.0, 1.0, 51)
    places = np.repeat(np.array([[[0.1, 0.9, 0.2], [0.2, 0.5, 0.1]]]), 51, axis=0)
    places[10:15, 1] = np.nan
    force = np.column_stack([0.0 * time, 700.0 * np.sin(np.pi * time), 0.0 * time])
    point = np.column_stack([0.2 * time, 0.0 * time, 0.1 + 0.0 * time])
    file = write_c3d(tmp_path / "a trial.c3d", ("HEEL", "TOE"), places, 50.0, ((force, point, 0.0 * force),))
    found = content_of(file)
    assert "51 frames, 0 to 1 s, 50 Hz" in said(found) and "2 markers: HEEL, TOE" in said(found)
    assert "TOE 9.8%" in said(found) and "1 force plate: plate 1 up to 700 N" in said(found)
    assert found.wrong == "" and str(tmp_path) not in said(found)


@pytest.mark.parametrize("unit", ["mm", "m"])
def test_units_are_offered_that_make_the_size_usual(unit: str, tmp_path: Path) -> None:
    """A tetrahedron with edges of 0.04 m, in millimetres or metres; nothing is offered for one of 40 km."""
    size = {"mm": 40.0, "m": 0.04}[unit]
    corners = size * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n"
    file = tmp_path / "body.obj"
    file.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in corners) + faces)
    found = content_of(file)
    assert found.units[0] == unit and "4 triangles" in found.facts
    assert f"{unit}, then it is {40.0 * np.sqrt(3.0):.4g} mm across" in said(found)
    file.write_text("".join(f"v {x} {y} {z}\n" for x, y, z in 1e6 * corners) + faces)
    assert content_of(file).units == []


def test_tables_models_and_descriptions() -> None:
    """Counts from the lines of the files."""
    folder = sample_folder()
    head, *rows = (folder / "gait.csv").read_text("utf-8").splitlines()
    found = said(content_of(folder / "gait.csv"))
    assert f"{len(rows)} frames" in found and f"{head.count(',')} columns beside time" in found
    model = (folder / "leg.osim").read_text("utf-8")
    found = said(content_of(folder / "leg.osim"))
    assert (
        f"{model.count('<Marker name=')} markers" in found
        and f"{model.count('<Coordinate name=')} coordinates" in found
    )
    assert "keys: " in said(content_of(folder / "resting_knee.toml"))
    assert "2 force plates: own_force up to " in said(content_of(folder / "gait_P1_medium_1" / "plates.mot"))


def test_what_cannot_be_read_is_said_in_the_words_of_its_reader(tmp_path: Path) -> None:
    for name, text, words in (
        ("a.stl", "solid a\nendsolid a\n", "a.stl: no "),
        ("b.toml", "a = [1,\n", "b.toml: is not TOML"),
        ("c.osim", "<OpenSimDocument", "c.osim"),
        ("d.mot", "time\n", "d.mot"),
    ):
        (tmp_path / name).write_text(text)
        wrong = content_of(tmp_path / name).wrong
        assert words in wrong and str(tmp_path) not in wrong, wrong
    (tmp_path / "e.py").write_text("raise SystemExit(3)\n")
    assert content_of(tmp_path / "e.py").wrong == ""  # never run


@pytest.mark.skipif(os.name == "nt", reason="a program that only fails")
def test_a_process_of_its_own_says_the_same(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One that lasts too long or ends the process is named as such, and costs the others nothing."""
    cup = tmp_path / "künstliche Pfanne.stl"
    cup.write_bytes((sample_folder() / "cup_r24.stl").read_bytes())
    assert contents([cup]) == [content_of(cup)]
    assert "more than 0.001 s" in contents([cup], patience=1e-3)[0].wrong
    assert contents([tmp_path / "gone.xyz"])[0].wrong == "gone.xyz: No such file or directory"
    monkeypatch.setattr("sys.executable", shutil.which("false"))
    why = f"{cup.name}: not looked at, the process that reads ended with 1"
    assert [each.wrong for each in contents([cup, cup])] == [why] * 2


def test_the_page_of_a_surface(tmp_path: Path) -> None:
    cup = sample_folder() / "cup_r24.stl"
    assert write_page(cup, "mm", tmp_path / "cup.html") == ""
    assert "coordinates in mm" in (tmp_path / "cup.html").read_text("utf-8")
    assert "too large" in write_page(cup, "m", tmp_path / "other.html") and not (tmp_path / "other.html").exists()


def test_pages_of_surfaces_have_a_name_each(tmp_path: Path) -> None:
    names = [page_name(tmp_path / place, unit) for place in ("a/m.stl", "b/m.stl", "a/m.obj") for unit in ("mm", "m")]
    assert len(set(names)) == 6 and page_name(tmp_path / "a" / "m.stl", "mm") == names[0]
    assert len(page_name(tmp_path / ("x" * 250 + ".stl"), "mm")) < 200


@pytest.mark.skipif(os.name == "nt", reason="groups of processes of POSIX")
def test_what_lasts_too_long_ends_with_all_that_it_started(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    program, cup = tmp_path / "slow", sample_folder() / "cup_r24.stl"
    program.write_text(f"#!/bin/sh\nsleep 300 &\necho $! >> {tmp_path}/started\nwait\n")
    program.chmod(0o700)
    monkeypatch.setattr("sys.executable", str(program))
    assert "more than 2 s" in contents([cup], patience=2.0)[0].wrong
    assert "more than 2 s" in write_page(cup, "mm", tmp_path / "cup.html", patience=2.0)
    found = (tmp_path / "started").read_text().split()
    states = subprocess.run(["ps", "-o", "stat=", "-p", ",".join(found)], capture_output=True, text=True).stdout
    assert len(found) == 2 and not [state for state in states.split() if not state.startswith("Z")]


def test_what_is_no_file_or_cannot_be_asked_for_is_not_there(tmp_path: Path) -> None:
    (tmp_path / "file").write_bytes(b"four")
    found = known_file(tmp_path / "file")
    assert found is not None and found[2] == 4
    for name in ("gone", "x" * 5000, "file/below", "a\0b", "."):
        assert known_file(tmp_path / name) is None, name


@pytest.mark.skipif(importlib.util.find_spec("cascadio") is None, reason="the extra `step` is not installed")
@pytest.mark.parametrize("unit", ["mm", "m"])
def test_the_unit_that_a_file_states_is_the_one_that_is_offered(unit: str, tmp_path: Path) -> None:
    file = tmp_path / "box.step"
    file.write_text(box((1.0, 2.0, 3.0), unit))
    assert content_of(file).units == [unit]


def test_markers_in_common() -> None:
    assert markers_in_common(["A", "B"], ["B", "A"]) == "2 of the model's 2 markers are in the recording"
    assert markers_in_common(["A"], ["A", "B", "C"]).endswith(
        "1 of the model's 3 markers are in the recording; it lacks B, C"
    )


def test_folders_are_recognised_where_a_field_takes_one(tmp_path: Path) -> None:
    """A gap case by its description, a laboratory's by its recordings; what is neither is refused by its reader."""
    case, laboratory = tmp_path / "case", tmp_path / "laboratory"
    for folder in (case, laboratory):
        folder.mkdir()
        assert known_file(folder) is None and known_file(folder, folder=True) is not None
    (case / "case.toml").write_text('calibration = ["t1", "t2"]\nevaluation = ["t3"]\n', encoding="utf-8")
    found = content_of(case)
    assert (found.kind, found.wrong) == ("gap case", "")
    assert found.facts == ["2 trials of calibration: t1, t2", "1 trial of evaluation: t3"]
    assert "laboratory: is no folder of trials" in content_of(laboratory).wrong
    for name in ("walk.trc", "static.trc", "walk_ik.mot", "walk_grf.xml", "leg.osim", "notes.txt"):
        (laboratory / name).touch()
    found = content_of(laboratory)
    assert (found.kind, found.wrong) == ("folder of trials", "")
    assert found.facts == [
        "2 trials: static (static by its name), walk",
        "2 with markers, 1 with coordinates, 1 with loads",
        "1 model: leg.osim",
        "1 other file",
    ]
    assert contents([laboratory]) == [found]


def test_a_folder_is_another_one_when_anything_in_it_changes(tmp_path: Path) -> None:
    """Written again four levels below, with the same size; new; gone. What no reader looks at changes nothing."""
    deep = tmp_path / "session" / "a" / "b" / "c" / "d"
    deep.mkdir(parents=True)
    (deep / "walk.trc").write_text("one")
    os.utime(deep / "walk.trc", ns=(10**18, 10**18))
    seen = [known_file(tmp_path / "session", folder=True)]

    def changed() -> bool:
        seen.append(known_file(tmp_path / "session", folder=True))
        return seen[-1] != seen[-2]

    assert not changed()
    (deep / "walk.trc").write_text("two")
    os.utime(deep / "walk.trc", ns=(10**18 + 1, 10**18 + 1))
    assert changed() and seen[-1] is not None and seen[-1][0] == tmp_path / "session"
    (deep / "still.trc").write_text("")
    assert changed()
    (deep / "still.trc").unlink()
    assert changed() and not changed()
    (deep / ".hidden").write_text("")
    assert changed() and not changed()  # by the time of the folder that it is in
    (deep / ".hidden").write_text("more")
    assert not changed()
    (deep / "e" / "f").mkdir(parents=True)
    assert changed()
    (deep / "e" / "f" / "walk.trc").write_text("")
    assert not changed()
    (tmp_path / "session" / "again").symlink_to(tmp_path / "session")
    assert changed() and not changed()


def test_no_more_of_a_folder_is_looked_at_than_is_read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A window asks every few seconds: a folder of a million files would stop it."""
    monkeypatch.setattr("geocontact.io.recordings.tool_folder.MOST_FILES", 5)
    for k in range(20):
        (tmp_path / f"{k}.trc").touch()
    known = known_file(tmp_path, folder=True)
    assert known is not None and known[2] == 6
