"""A small analysis in a copy of this checkout is behind every door; what it touches is counted."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.house import measured, table
from benchmarks.new_analysis import ADDED, CATALOGUE, HOME, ROOT, STUB, added, environment, name_alone, touched

EVERYWHERE = """
from pathlib import Path
from geocontact.analyses.catalogue import entry_of, job_named
import geocontact as gc
from benchmarks.page_pictures.kinds import KINDS
from benchmarks.same_outputs.recording import ROOT
from geocontact.cli.main import run
from website.stubs import stubs

entry_of("edges").load_job()
assert KINDS["edges"] == "edges", "no run"
assert all((ROOT / name).read_text("utf-8") == text for name, text in stubs(ROOT).items()), "old stub"
result = gc.edge_lengths("meshes/sphere_r20.stl", unit="mm")
assert str(result) == "4320 edges, 2 mm on average", result
assert job_named("edges") is gc.edge_lengths is entry_of("edges").load_job() and "edge_lengths" in dir(gc)
assert run(["edges", "--help"]) == 0
assert run(["edges", "meshes/sphere_r20.stl", "--unit", "mm", "--out", "out"]) == 0
assert sorted(each.name for each in Path("out").glob("edges.*")) == ["edges.csv", "edges.png", "edges.svg"]
assert run(["rerun", "out"]) == 0
assert run(["edge"]) == 2
tests = {}
exec(Path("tests/analyses/test_edges.py").read_text("utf-8"), tests)
tests["test_edges_of_a_sphere_are_as_long_as_its_faces_say"]()
"""
"""Doors of an analysis: Python, studies, command line, help, a run again, pictures of pages; and its stub."""


def test_it_touches_few_files_and_one_of_them_with_its_name_alone() -> None:
    found = touched()
    assert found is not None
    assert len(found.by_hand) + len(found.by_script) <= 10
    assert found.name_alone == (CATALOGUE,) and found.by_script == (STUB,)
    assert name_alone(ADDED[CATALOGUE][1]) and not name_alone(ADDED["README.md"][1])


def test_the_house_tells_it(tmp_path: Path) -> None:
    """Of a checkout without the list there is nothing to tell."""
    (tmp_path / "geocontact").mkdir()
    (tmp_path / "geocontact" / "a.py").write_text("one = 1\n", encoding="utf-8")
    (tmp_path / "pyproject.toml").write_bytes((ROOT / "pyproject.toml").read_bytes())
    assert measured(tmp_path)["files_of_a_new_analysis"] is None
    assert "| files of a new analysis, of these only its name | not measured |" in table(measured(tmp_path))
    (tmp_path / CATALOGUE).parent.mkdir(parents=True)
    (tmp_path / CATALOGUE).write_bytes((ROOT / CATALOGUE).read_bytes())
    line = "| files of a new analysis, of these only its name | 10, one of them by a script; 1 |"
    assert line in table(measured(tmp_path))


@pytest.mark.slow
def test_it_is_behind_every_door(tmp_path: Path) -> None:
    added(tmp_path)
    done = run(tmp_path)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "did you mean edges?" in done.stderr and "4 of 4 files of the results are equal" in done.stdout


@pytest.mark.slow
def test_contracts_hold_it_without_naming_it(tmp_path: Path) -> None:
    added(tmp_path)
    assert "BROKEN" not in lint(tmp_path)
    file = tmp_path / HOME / "show.py"
    file.write_text(file.read_text("utf-8") + "\n\nimport geocontact.analyses.area.result\n", encoding="utf-8")
    assert "Analyses do not know each other BROKEN" in lint(tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("without", "said"),
    [
        (CATALOGUE, "KeyError: 'edges'"),
        (STUB, "AssertionError: old stub"),
        ("benchmarks/same_outputs/runs.txt", "AssertionError: no run"),
        (f"{HOME}/options.py", "No module named 'geocontact.analyses.edges.options'"),
    ],
)
def test_without_one_of_its_files_a_door_is_shut(tmp_path: Path, without: str, said: str) -> None:
    added(tmp_path, without=without)
    done = run(tmp_path)
    assert done.returncode == 1 and said in done.stderr


def run(folder: Path) -> subprocess.CompletedProcess[str]:
    """What the copy says of its new analysis."""
    command = [sys.executable, "-c", EVERYWHERE]
    return subprocess.run(command, cwd=folder, env=environment(folder), capture_output=True, text=True, check=False)


def lint(folder: Path) -> str:
    """What the contracts say of the copy."""
    command = [sys.executable, "-c", "from importlinter.cli import lint_imports_command as c; c()", "--no-cache"]
    told = environment(folder) | {"PYTHONUTF8": "1", "NO_COLOR": "1"}
    return subprocess.run(command, cwd=folder, env=told, capture_output=True, encoding="utf-8", check=False).stdout
