"""The import contracts of pyproject.toml hold, and each of them fails on a copy of the package that breaks it."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
IO = "Only analyses use io"
ROOMS = "Rooms know only the rooms below them"
PLOTS = "Numerics do not plot"
DOOR = "Rooms do not come in by the front door"
ARRAYS = "Force laws take arrays, never a Surface"
PLANTED = "Planted cases share nothing with the candidates"
WITHHELD = "Only the benchmark knows the planted cases"
VIEW = "View shows data only"
APART = "Analyses do not know each other"
GROUP = "Analyses of a group do not know each other"
CIRCLES = "No two modules import each other"
TYPED = "Only cli parses and prints"


def lint(folder: Path) -> subprocess.CompletedProcess[str]:
    """Outcome of lint-imports on the package in `folder`."""
    command = [sys.executable, "-c", "from importlinter.cli import lint_imports_command as c; c()", "--no-cache"]
    environment = os.environ | {"PYTHONPATH": str(folder), "PYTHONUTF8": "1", "NO_COLOR": "1"}
    return subprocess.run(command, cwd=folder, env=environment, capture_output=True, encoding="utf-8")


@pytest.fixture
def copy(tmp_path: Path) -> Path:
    """Folder with a copy of the package and its contracts."""
    ignored = shutil.ignore_patterns("__pycache__", "*.stl")
    shutil.copytree(ROOT / "geocontact", tmp_path / "geocontact", ignore=ignored)
    shutil.copy(ROOT / "pyproject.toml", tmp_path)
    return tmp_path


def append(folder: Path, module: str, line: str) -> None:
    """Add a line to a module of the copy, making the room when it is not there yet."""
    file = folder / "geocontact" / module
    file.parent.mkdir(exist_ok=True)
    (file.parent / "__init__.py").touch()
    with file.open("a", encoding="utf-8") as text:
        text.write(f"\n{line}\n")


def test_contracts_hold() -> None:
    result = lint(ROOT)
    assert result.returncode == 0, result.stdout + result.stderr


BREAKS = [
    ("data/mesh.py", "import geocontact.geometry.plane", ROOMS),
    ("io/mesh/meshes.py", "import geocontact.geometry.plane", ROOMS),
    ("geometry/plane.py", "def late():\n    import geocontact.analyses.area.figure", ROOMS),
    ("geometry/plane.py", "import geocontact.contact.law", ROOMS),
    ("effects/mechanical/slip.py", "import geocontact.systems.knee", ROOMS),
    ("identify/optimise/least_squares.py", "import geocontact.chain.links", ROOMS),
    ("analyses/area/figure.py", "import geocontact.cli.main", ROOMS),
    ("view/curves/style.py", "import geocontact.analyses.area.figure", ROOMS),
    ("axis_misalignment/law.py", "import geocontact.systems.elbow", ROOMS),
    ("gap/diagnose.py", "import geocontact.gap_benchmark.score", ROOMS),
    ("newroom/newroom.py", "", ROOMS),
    ("view/curves/style.py", "import geocontact.geometry.plane", VIEW),
    ("analyses/cop/foot.py", "import geocontact.analyses.area.result", APART),
    ("analyses/frame/bodies.py", "import geocontact.analyses.shape.result", APART),
    ("analyses/motion/scale/result.py", "import geocontact.analyses.motion.inverse_dynamics.result", GROUP),
    ("analyses/area/options.py", "import geocontact.analyses.area.result", CIRCLES),
    ("chain/system.py", "import geocontact.chain.effect", CIRCLES),
    ("analyses/cop/foot.py", "import cyclopts", TYPED),
    ("gap/diagnose.py", "import rich", TYPED),
    ("geometry/plane.py", "import geocontact.io.mesh.meshes", IO),
    ("loads/resultant.py", "from geocontact.io.mesh.meshes import read_mesh", IO),
    ("cli/main.py", "import geocontact.io.mesh.meshes", IO),
    ("contact/law.py", "import geocontact.geometry.surface", ARRAYS),
    ("geometry/plane.py", "import matplotlib.pyplot", PLOTS),
    ("gap/localise/gap_map.py", "def late():\n    import pyvista", PLOTS),
    ("geometry/plane.py", "from geocontact import read_mesh", DOOR),
    ("gap_benchmark/synthetic/systems/elbow.py", "import geocontact.chain.links", PLANTED),
    ("gap_benchmark/synthetic/noise.py", "def late():\n    import geocontact.gap.case.refit", PLANTED),
    ("gap_benchmark/synthetic/cases.py", "import geocontact.gap_benchmark.score", PLANTED),
    ("gap/diagnose.py", "import geocontact.gap_benchmark.synthetic.label", WITHHELD),
    ("analyses/gap/diagnose/many.py", "from geocontact.gap_benchmark.synthetic import synthetic_case", WITHHELD),
]
"""A module, a line at its end, and the contract that it breaks."""


def rounds() -> list[list[tuple[str, str, str]]]:
    """The breaks dealt out: of each contract one at a time, since a contract that is broken already tells nothing."""
    out: list[list[tuple[str, str, str]]] = []
    for one in BREAKS:
        free = next((each for each in out if one[2] not in {other[2] for other in each}), None)
        if free is None:
            out.append(free := [])
        free.append(one)
    return out


@pytest.mark.slow
@pytest.mark.parametrize("breaks", rounds())
def test_contract_fails_when_broken(copy: Path, breaks: list[tuple[str, str, str]]) -> None:
    for name in ("contact/law.py", "systems/knee.py", "chain/links.py"):
        append(copy, name, "")
    for module, line, _ in breaks:
        append(copy, module, line)
    result = lint(copy)
    assert result.returncode == 1, result.stdout + result.stderr
    assert [contract for *_, contract in breaks if f"{contract} BROKEN" not in result.stdout] == []
    for module, _, contract in breaks:
        _, told = result.stdout.split(f"\n{contract}\n{'-' * len(contract)}\n", 1)
        assert Path(module).stem in re.split(r"\n-{5,}\n", told)[0], told


def test_planted_cases_are_walled_off_from_every_module_of_the_diagnosis() -> None:
    """A new module of geocontact.gap has to be added to the contract."""
    contracts = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]["importlinter"][
        "contracts"
    ]
    wall = next(set(one["forbidden_modules"]) for one in contracts if one["name"] == PLANTED)
    gap = ROOT / "geocontact" / "gap"
    modules = {f"geocontact.gap.{file.stem}" for file in gap.glob("*.py") if file.stem != "__init__"}
    modules |= {f"geocontact.gap_benchmark.{f.stem}" for f in (gap / "benchmark").glob("*.py") if f.stem != "__init__"}
    assert modules <= wall, sorted(modules - wall)
