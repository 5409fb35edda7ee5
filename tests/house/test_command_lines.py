"""Every command line of README and documentation runs, and prints what the page shows below it."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from cyclopts import App

import geocontact as gc
from geocontact.cli.main import app
from geocontact.cli.suggestions import commands
from geocontact.dynamics.compiled import cache_folder
from tests.house.first_screens import ROOT, missing
from tests.house.shell_blocks import DOCUMENTS, calls_of, files_of, name_of, shell_blocks
from tests.house.warm_command import warm_command

NOT_RUN = {
    ("README.md", 0): "make installs the package and runs these tests",
    ("docs/how-to/inverse.md", 1): "a static trial, a generic model and loads of one's own laboratory",
    ("docs/how-to/mat.md", 1): "a second scan with the mat on",
    ("docs/how-to/opensim_motion.md", 1): "real data that are not in the repository: run in tests/real",
}
"""Blocks that need what a reader has and the repository has not, and why."""

STAND_INS = {
    "README.md": {
        "femoral.stl": "femoral_component_right_coarse.stl",
        "tibial.stl": "tibial_insert_right_coarse.stl",
        "gait.csv": "gait.csv",
    },
    "docs/reference/input_files.md": {
        "talus.stl": "femoral_component_right_coarse.stl",
        "calcaneus.stl": "tibial_insert_right_coarse.stl",
    },
}
"""Shipped files that stand for a reader's own."""

PLATE = """\
import math
rows = [[k / 100, 0, 600 + 400 * k / 100, 0, 0.05 + 0.2 * k / 100, 0, 0, 0, 0, 0] for k in range(61)]
names = ["time", *(f"ground_force_r_{kind}{axis}" for kind in "vp" for axis in "xyz")]
names += [f"ground_torque_r_{axis}" for axis in "xyz"]
head = f"grf\\nversion=1\\nnRows={len(rows)}\\nnColumns={len(names)}\\ninDegrees=yes\\nendheader\\n"
open("grf.mot", "w").write(head + "\\n".join("\\t".join(map(str, row)) for row in [names, *rows]) + "\\n")
"""
KNEE = """\
import math
rows = [f"{a},{5 * math.sin(math.radians(a)):.4f},{3 * math.cos(math.radians(a)):.4f}" for a in range(0, 121, 5)]
open("knee.csv", "w").write("alpha [deg],x [mm],y [mm]\\n" + "\\n".join(rows) + "\\n")
"""
BONES = """\
walk = {"talus": "0.5", "calcaneus": "-30"}
rows = {bone: [f"1,0,0,{k},0,1,0,{y},0,0,1,0,0,0,0,1" for k in range(3)] for bone, y in walk.items()}
for bone, lines in rows.items():
    open(f"{bone}.txt", "w").write("\\n".join(lines) + "\\n")
"""
LOGGER = """\
import csv
rows = list(csv.DictReader(open("meshes/overhead_P1T1S100/truth.csv").read().splitlines()[1:]))
lines = [f"{r['time [s]']},{r['elevation_right [deg]']},10" for r in rows]
open("logger.csv", "w").write("time [s],exo_right [deg],mat [N]\\n" + "\\n".join(lines) + "\\n")
"""
MADE = {
    "docs/how-to/cop.md": PLATE,
    "docs/how-to/elbow_design.md": KNEE,
    "docs/how-to/shoulder.md": LOGGER,
    "docs/reference/input_files.md": BONES,
}
"""What makes files that a reader would have recorded."""

WITH_BLOCKS = [page for page in DOCUMENTS if shell_blocks(page)]
LASTING = {
    "docs/how-to/knee_chain.md",
    "docs/how-to/gap.md",
    "docs/how-to/prosthesis.md",
    "docs/how-to/shoulder_support.md",
    "docs/how-to/sit_to_stand.md",
    "docs/how-to/sit_to_stand_design.md",
}
"""Pages whose commands take a minute or more of one core."""


def lasting(page: Path) -> tuple[pytest.MarkDecorator, ...]:
    """Marks of a page's test."""
    return (pytest.mark.long,) if name_of(page) in LASTING else ()


@pytest.mark.parametrize("page", DOCUMENTS, ids=name_of)
def test_commands_and_options_are_there(page: Path) -> None:
    for words in calls_of(page):
        of, left = app, list(words)
        while left and left[0] in commands(of):
            of = of[left.pop(0)]
        assert of is not app or not left or left[0].startswith(("-", "COMMAND")), words
        options = {word.partition("=")[0] for word in left if word.startswith("--")}
        assert options <= names(of), f"{name_of(page)}: geocontact {' '.join(words)}"


def names(of: App) -> set[str]:
    """Options of a command."""
    own = {name for name in of if name.startswith("-")} | {"--debug"}
    return own if of.default_command is None else own.union(*(a.names for a in of.assemble_argument_collection()))


def test_what_is_not_run_is_little_and_there() -> None:
    blocks = {(each.page, each.number): each for page in DOCUMENTS for each in shell_blocks(page)}
    assert set(NOT_RUN) <= set(blocks)
    assert len(NOT_RUN) <= 4 and all(not blocks[each].shown for each in NOT_RUN)


@pytest.fixture(scope="session")
def command(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Shell words that start the command line of this checkout."""
    with warm_command(tmp_path_factory.mktemp("commands")) as words:
        yield words


@pytest.mark.slow
@pytest.mark.skipif(not (shutil.which("bash") and hasattr(os, "fork")), reason="the pages speak to a shell of Unix")
@pytest.mark.parametrize("page", [pytest.param(page, marks=lasting(page)) for page in WITH_BLOCKS], ids=name_of)
def test_every_block_prints_what_the_page_shows(tmp_path: Path, page: Path, command: str) -> None:
    """In the order of the page, in one folder: a later block may read what an earlier one wrote."""
    name = name_of(page)
    (tmp_path / "meshes").symlink_to(ROOT / "meshes")
    for file, shipped in STAND_INS.get(name, {}).items():
        shutil.copy(ROOT / "meshes" / shipped, tmp_path / file)
    for file, content in files_of(page).items():
        (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / file).write_text(content, encoding="utf-8")
    environment = shell(tmp_path, command)
    if name in MADE:
        subprocess.run([sys.executable, "-c", MADE[name]], cwd=tmp_path, check=True)
    for block in shell_blocks(page):
        if block.whole and (name, block.number) not in NOT_RUN:
            told = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
            done = subprocess.run(["bash", "-eu", "-c", block.code], cwd=tmp_path, env=environment, **told)
            assert done.returncode == 0, f"{block.code}\n{done.stdout}"
            assert missing(block.shown, done.stdout) == [], done.stdout


def shell(folder: Path, command: str) -> dict[str, str]:
    """Environment in which `geocontact` and `python` are those of this checkout, and no browser opens.

    The folder is home, but what this machine has compiled already is taken from where it lies.
    """
    (folder / "bin").mkdir()
    for name, words in (("python", f'"{sys.executable}"'), ("geocontact", command)):
        file = folder / "bin" / name
        file.write_text(f'#!/bin/sh\nexec {words} "$@"\n', encoding="utf-8")
        file.chmod(0o755)
    path = f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"
    own = {"HOME": str(folder), "SHELL": "/bin/bash", "BROWSER": "true", "GEOCONTACT_CACHE": str(cache_folder())}
    return os.environ | own | {"PATH": path, "PYTHONPATH": str(ROOT), "PYTHONUNBUFFERED": "1"}


def test_the_case_of_the_gap_page_can_be_diagnosed(tmp_path: Path) -> None:
    """Its case.toml with trials of the names in it is a case that has all that its model needs."""
    (text,) = files_of(ROOT / "docs/how-to/gap.md").values()
    (tmp_path / "trials").mkdir()
    (tmp_path / "case.toml").write_text(text, encoding="utf-8")
    trials = gc.misalignment.simulate(trials=5, seconds=5.0, rate=20.0).tables()
    for number in range(1, 6):
        trials[f"locked_{number}"].to_csv(tmp_path / "trials" / f"t0{number}.csv", index=False)
    case = gc.read_gap_case(tmp_path)
    system = gc.system_of(case)
    assert {"l", "z"} <= set(system.constants) and [each.name for each in system.parameters] == ["k", "x", "y"]
