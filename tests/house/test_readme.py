"""README and gallery: pictures are there and small, badges say what pyproject.toml says, every job is shown."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from benchmarks.page_pictures.badges import FOLDER, badges
from benchmarks.page_pictures.gallery import LARGEST, PICTURES, entries
from geocontact.analyses.catalogue import ENTRIES
from tests.house.first_screens import ROOT

README = (ROOT / "README.md").read_text(encoding="utf-8")
GALLERY = (ROOT / "docs" / "gallery.md").read_text(encoding="utf-8")
ALL = 3_000_000  # bytes of all pictures
NOT_SHOWN = {
    "gap benchmark": "made for those who change the diagnosis",
    "gap gather": "needs recordings of several laboratories' devices",
    "gap init": "needs a simulator of somebody's own: my_simulator.md makes one",
    "prosthesis compare": "needs a study file of three settings: its how-to makes one",
    "prosthesis walk": "its page moves as that of `prosthesis simulate`",
    "scale": "its page is that of `prosthesis scale`",
    "shoulder study": "lasts minutes",
    "sit-to-stand coordinates": "two curves, as of `sit-to-stand movements`",
    "sit-to-stand movements": "two curves with shaded stretches, as of gait events",
}
"""Commands without a picture, and why."""


def test_pictures_of_the_readme_are_there() -> None:
    named = re.findall(r'(?:srcset|src)="([^"]+)"|!\[[^\]]*\]\(([^)]+)\)', README)
    files = [one or other for one, other in named]
    assert len(files) == 7 and all((ROOT / file).is_file() for file in files), files
    light, dark = (PICTURES / f"area-{scheme}.png" for scheme in ("light", "dark"))
    assert (
        light.read_bytes()[:8] == dark.read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
        and light.read_bytes() != dark.read_bytes()
    )


def test_badges_say_what_the_project_says() -> None:
    assert {file.name: file.read_text(encoding="utf-8") for file in FOLDER.glob("*.svg")} == badges()


def test_the_gallery_has_a_small_picture_for_every_command() -> None:
    names = [one.name for one in entries()]
    assert len(names) == len(set(names)) == GALLERY.count("\n### ") == GALLERY.count("](pictures/")
    assert {file.stem for file in PICTURES.glob("*.webp")} == set(names)
    assert all((PICTURES / f"{name}.webp").stat().st_size <= LARGEST for name in names)
    assert sum(file.stat().st_size for file in PICTURES.rglob("*") if file.is_file()) <= ALL
    typed = " ".join(one.code for one in entries())
    commands = {each.command for each in ENTRIES if each.command}
    assert {each for each in commands if f"geocontact {each} " not in typed} == set(NOT_SHOWN)


def test_every_job_stands_in_the_tables() -> None:
    """A group's name stands once in a row: `elbow simulate`, `fit`, `compare`."""
    cells = [line.split("|")[2] for line in README.splitlines() if line.startswith("| ") and line.count("|") == 5]
    listed: set[str] = set()
    for cell in cells:
        words = re.findall(r"`([^`]+)`", cell)
        group = words[0].rpartition(" ")[0] if words else ""
        listed |= {word if " " in word or not group else f"{group} {word}" for word in words}
    commands = {each.command for each in ENTRIES if each.command} - {"gap benchmark"}
    assert commands - listed == set()


def test_its_sizes_are_those_that_were_measured() -> None:
    told = json.loads((ROOT / "benchmarks" / "results" / "install_size.json").read_text(encoding="utf-8"))["figures"]
    assert f"({told['make']['MB']} MB, {told['make']['cpu_s']['together']:.0f} s of one core" in README
    assert f"`pip install .` takes {told['pip']['MB']} MB" in README


@pytest.mark.slow
def test_its_python_gives_the_area_that_the_command_prints(tmp_path: Path) -> None:
    (code,) = re.findall(r"^```python\n(.*?)^```$", README, re.MULTILINE | re.DOTALL)
    (tmp_path / "meshes").symlink_to(ROOT / "meshes")
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(
        [sys.executable, "-c", f"{code}print(result)\n"], cwd=tmp_path, env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    line = next(line for line in README.splitlines() if line.startswith("area of FIXED within"))
    assert line.partition(" mm^2")[0].rpartition("mm: ")[2] in done.stdout and (tmp_path / "report.html").is_file()
