"""`geocontact elbow design`: what it writes, says and refuses; its numbers are tested as an analysis."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

import geocontact as gc
from tests.cli.calls import Call, done, inventory, written
from tests.cli.elbow_calls import elbow, same_csv, unpictured

FILES = {"design.json", "map.csv", "boundary.csv", "sensitivity.csv", "force.csv", "design.png", "design.svg"}
FILES |= {"report.html", "run.json"}
PAPER = {"--k": 222.43, "--l-mm": 169, "--z-mm": 127, "--range": "0:120deg", "--limit": 5, "--offset-mm": "48,59"}


def design(folder: Path, changes: dict[str, object] | None = None, picture: bool = False) -> Call:
    """The command for the exoskeleton of the source, or another."""
    given = {**PAPER, "--step-mm": 10, **(changes or {})}
    arguments = [f"{key}={value}" for key, value in given.items() if value is not None]
    return elbow("design", folder / "out", *arguments, picture=picture)


def test_the_exoskeleton_of_the_source(tmp_path: Path) -> None:
    result = done(design(tmp_path, {"--stroke-mm": "0:60", "--uncertainty-mm": 10, "--map-mm": 60}, picture=True))
    assert set(inventory(result.folder)) == FILES
    assert "the lower end must be decreased by 27.48 mm" in result.out
    page = (result.folder / "report.html").read_text(encoding="utf-8")
    assert "the lower end must be decreased by 27.48\u00a0mm" in page and "robust radius" in page
    m = json.loads(result.bytes("design.json"))
    assert m["l_mm"] == 169.0 and m["stroke_mm"] == [0.0, 60.0] and m["range_deg"] == [0.0, 120.0]
    record = result.record()
    assert record["options"]["stroke_mm"] == "0:60" and record["options"]["l_mm"] == 169.0
    assert record["options_si"]["l [m]"] == 0.169 and record["options_si"]["step [m]"] == 0.01


def test_python_designs_as_the_command_does(tmp_path: Path) -> None:
    typed = done(design(tmp_path, {"--drift": "x=0:-8,y=0:5:2", "--stroke-mm": "0:60", "--z-mm": -127})).folder
    options: dict[str, Any] = {"k": 222.43, "l": gc.mm(169), "z": gc.mm(-127), "range": gc.deg(0, 120), "limit": 5.0}
    drift = {"x": gc.mm(0, -8), "y": gc.mm(0, 5, 2)}
    more: dict[str, Any] = {"offset": gc.mm(48, 59), "step": gc.mm(10), "stroke": gc.mm(0, 60), "drift": drift}
    with unpictured():
        python = gc.misalignment.design(**options, **more).write(tmp_path / "python")
    assert same_csv(python, typed) == ["boundary.csv", "force.csv", "map.csv", "sensitivity.csv"]
    assert (python / "design.json").read_bytes() == (typed / "design.json").read_bytes()


def test_warnings_name_options_as_they_are_typed(tmp_path: Path) -> None:
    result = done(design(tmp_path, {"--offset-mm": None}))
    assert "no sensitivities where there is no force: give another --offset-mm than what is aimed at" in result.warnings


def test_a_drift_from_a_file_is_an_input(tmp_path: Path) -> None:
    rows = "\n".join(f"{a},0,{a / 10}" for a in range(0, 121, 30))
    file = written(tmp_path / "drift.csv", f"beta [deg],x [mm],y [mm]\n{rows}\n")
    (entry,) = done(design(tmp_path, {"--drift": file})).record()["inputs"]
    assert (entry["role"], entry["tells"], entry["rows"]) == ("--drift", "exoskeleton", 5)


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"--range": "0:120"}, "write for example 0:120deg"),
        ({"--range": "0:120rad"}, "is 120 deg meant?"),
        ({"--range": "0:2.1deg"}, "are degrees and radians mixed up?"),
        ({"--range": "120:0deg"}, "--range: has no room between its ends"),
        (
            {"--k": 0.22},
            "--k: 0.22 N/m cannot be the stiffness of an attachment: that is 1 to 1e+07 N/m; is 0.22 N/mm meant?",
        ),
        ({"--k": 0}, "--k: 0 N/m cannot be the stiffness of an attachment"),
        ({"--l-mm": -169}, "--l-mm: -169 mm cannot be a link"),
        ({"--l-mm": 0.169}, "--l-mm: 0.169 mm cannot be a link of an exoskeleton"),
        ({"--limit": "nan"}, "--limit: nan is not a finite number"),
        ({"--z-mm": "inf"}, "--z-mm"),
        ({"--stroke-mm": "20:-20"}, "give the lower end first"),
        ({"--stroke-mm": "20"}, "from … to"),
        ({"--offset-mm": "48"}, "not two lengths"),
        ({"--offset-mm": "180,0"}, "x = 180 mm, y = 0 mm: the offset x is longer than the link"),
        ({"--offset-mm": "0,175", "--range": "0:180deg"}, "tan γ has a pole in the range"),
        ({"--uncertainty-mm": -1}, "--uncertainty-mm"),
        ({"--uncertainty-mm": 130}, "tan γ has a pole in the range"),
        ({"--step-mm": 0.01}, "larger step"),
        ({"--drift": "z=0:1"}, "--drift: 'z=0:1' is neither x=… nor y=…"),
        ({"--drift": "nowhere.csv"}, "nowhere.csv"),
    ],
)
def test_refused_in_one_line(tmp_path: Path, changes: dict[str, object], said: str) -> None:
    result = design(tmp_path, changes)
    assert result.code == 2
    (line,) = result.complaints
    assert said in line and not (tmp_path / "out").exists()
