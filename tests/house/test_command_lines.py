"""Every command line of README and documentation runs, and prints what the page shows below it.

Blocks of the tutorial and of the how-to pages run as they stand, Python as well, from an empty folder next to `meshes`.
"""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest
from cyclopts import App

import geocontact as gc
from geocontact.cli.main import app
from geocontact.cli.suggestions import commands
from geocontact.dynamics.code_cache import cache_folder
from tests.house.first_screens import ROOT, missing
from tests.house.shell_blocks import DOCUMENTS, GUIDES, calls_of, files_of, name_of, shell_blocks
from tests.house.warm_command import warm_command

NOT_RUN = {("README.md", 1): "make installs the package and runs these tests"}
"""Blocks that are not run, and why."""

STAND_INS = {
    "docs/reference/input_files.md": {
        "talus.stl": "femoral_component_right_coarse.stl",
        "calcaneus.stl": "tibial_insert_right_coarse.stl",
    },
}
"""Shipped files that stand for a reader's own."""

BONES = """\
walk = {"talus": "0.5", "calcaneus": "-30"}
rows = {bone: [f"1,0,0,{k},0,1,0,{y},0,0,1,0,0,0,0,1" for k in range(3)] for bone, y in walk.items()}
for bone, lines in rows.items():
    open(f"{bone}.txt", "w").write("\\n".join(lines) + "\\n")
"""
MADE = {"docs/reference/input_files.md": BONES}
"""What makes files that a reader of the reference would have recorded."""

WITH_BLOCKS = [page for page in DOCUMENTS if shell_blocks(page) or page in GUIDES]
LASTING = {
    "docs/gallery.md",
    "docs/how-to/cohort.md",
    "docs/how-to/knee_chain.md",
    "docs/how-to/gap.md",
    "docs/how-to/prosthesis.md",
    "docs/how-to/shoulder_support.md",
    "docs/how-to/sit_to_stand.md",
    "docs/how-to/sit_to_stand_design.md",
}
"""Pages whose commands take twenty seconds or more of one core."""

QUICK = {
    f"docs/how-to/{name}.md"
    for name in ("cop", "fit", "inverse", "loadcells", "my_markers", "my_mat", "own_model", "units")
}
"""Pages whose commands take four seconds or less: run with every change, about 18 CPU seconds in all."""


def lasting(page: Path) -> tuple[pytest.MarkDecorator, ...]:
    """Marks of a page's test."""
    name = name_of(page)
    return () if name in QUICK else (pytest.mark.slow, *([pytest.mark.long] if name in LASTING else []))


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
    assert len(NOT_RUN) <= 1 and all(not blocks[each].shown for each in NOT_RUN)


@pytest.mark.parametrize("page", GUIDES, ids=name_of)
def test_blocks_of_a_guide_can_be_typed(page: Path) -> None:
    """No dots in commands, and no command outside of blocks that run; what a settings file shows can be read."""
    assert [block.code for block in shell_blocks(page) if not block.whole] == []
    outside = re.sub(r"^```.*?^```", "", page.read_text(encoding="utf-8"), flags=re.MULTILINE | re.DOTALL)
    assert re.findall(r"^    +geocontact [^\n]*", outside, re.MULTILINE) == []
    for block in shell_blocks(page, "toml"):
        tomllib.loads(block.code)


@pytest.fixture(scope="session")
def command(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """Shell words that start the command line of this checkout."""
    with warm_command(tmp_path_factory.mktemp("commands")) as words:
        yield words


@pytest.mark.skipif(not (shutil.which("bash") and hasattr(os, "fork")), reason="the pages speak to a shell of Unix")
@pytest.mark.parametrize("page", [pytest.param(page, marks=lasting(page)) for page in WITH_BLOCKS], ids=name_of)
def test_every_block_prints_what_the_page_shows(tmp_path: Path, page: Path, command: str) -> None:
    """In the order of the page, in one folder: a later block may read what an earlier one wrote."""
    name = name_of(page)
    (tmp_path / "meshes").symlink_to(ROOT / "meshes")
    for file, shipped in STAND_INS.get(name, {}).items():
        shutil.copy(ROOT / "meshes" / shipped, tmp_path / file)
    if page not in GUIDES:
        for file, content in files_of(page).items():
            (tmp_path / file).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / file).write_text(content, encoding="utf-8")
    environment = shell(tmp_path, command)
    if name in MADE:
        subprocess.run([sys.executable, "-c", MADE[name]], cwd=tmp_path, check=True)
    for block in shell_blocks(page):
        if block.whole and (name, block.number) not in NOT_RUN:
            run(["bash", "-eu", "-c", block.code], block.shown, tmp_path, environment)
    scripts = list(shell_blocks(page, "python"))
    if page in GUIDES and scripts:  # as typed in one session of Python
        code, shown = "\n".join(one.code for one in scripts), tuple(line for one in scripts for line in one.shown)
        run([sys.executable, "-c", code], shown, tmp_path, environment)


def run(words: list[str], shown: tuple[str, ...], folder: Path, environment: dict[str, str]) -> None:
    """Run it, and look for the lines that the page shows."""
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "text": True}
    done = subprocess.run(words, cwd=folder, env=environment, **streams)
    assert done.returncode == 0, f"{words[-1]}\n{done.stdout}"
    assert missing(shown, done.stdout) == [], done.stdout


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
