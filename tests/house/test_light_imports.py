"""The command line starts without what it does not need; heavy packages are imported where they are used."""

from __future__ import annotations

import ast
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HEAVY = {"casadi", "ezc3d", "matplotlib", "open3d", "opensim", "pyvista", "trimesh", "vtk"}
NUMERIC = {"fcl", "igl", "numba", "pandas", "scipy"}


def loaded_by(program: str) -> set[str]:
    """Top-level packages that a fresh interpreter has loaded after `program`."""
    program += "\nimport sys\nsys.stdout.write('\\n@' + ' '.join({name.partition('.')[0] for name in sys.modules}))"
    result = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, text=True)
    assert result.returncode == 0, result.stderr
    return set(result.stdout.rpartition("@")[2].split())


@pytest.mark.parametrize("program", ["import geocontact", "import geocontact.cli.main"])
def test_importing_is_light(program: str) -> None:
    assert not loaded_by(program) & (HEAVY | NUMERIC)


@pytest.mark.parametrize("arguments", [["--help"], ["--version"]])
def test_help_is_light(arguments: list[str]) -> None:
    assert not loaded_by(f"from geocontact.cli.main import run; run({arguments})") & (HEAVY | NUMERIC)


EVERY_HELP = f"""
import sys
from geocontact.cli.main import app, run
from geocontact.cli.suggestions import commands

def told(of, words):
    for name in commands(of):
        run([*words, name, "--help"])
        heavy = sorted({{each.partition(".")[0] for each in sys.modules}} & {HEAVY | NUMERIC})
        assert not heavy, (words, name, heavy)
        told(of[name], [*words, name])

told(app, [])
"""
"""Help of one command after the other: the first that loads something heavy is named."""


def test_help_of_every_command_is_light() -> None:
    """Options are declared without what computes."""
    loaded_by(EVERY_HELP)


SLOW = {
    "igl",
    "matplotlib",
    "scipy.integrate",
    "scipy.interpolate",
    "scipy.optimize",
    "scipy.signal",
    "scipy.stats",
    "trimesh",
}
"""A tenth of a second each, needed by few steps of a job: imported in the function that calls them."""
USUAL = (
    "area.result",
    "area.pairs.result",
    "cop.result",
    "loadcells.result",
    "mat.result",
    "motion.functional_joint.result",
    "motion.inverse_dynamics.result",
    "motion.inverse_kinematics.result",
    "motion.scale.result",
    "motion.virtual_markers.result",
    "knee.settle.result",
    "misalignment.design.result",
    "misalignment.simulate.result",
    "shape.result",
    "thickness.result",
)
"""Modules of jobs that are called most and fit nothing, or only at some step."""
NO_KERNEL = (
    "cop.result",
    "loadcells.result",
    "motion.functional_joint.result",
    "motion.inverse_dynamics.result",
    "motion.inverse_kinematics.result",
    "motion.scale.result",
    "motion.virtual_markers.result",
    "prosthesis.compare.result",
    "prosthesis.simulate.result",
    "prosthesis.walk.result",
    "shape.result",
)
"""Modules of jobs that may end without a surface, a filter or a law that numba compiles."""


@pytest.mark.parametrize("module", USUAL)
def test_a_job_starts_without_what_few_steps_need(module: str) -> None:
    program = f"import sys, geocontact.analyses.{module}; found = {SLOW} & set(sys.modules); assert not found, found"
    loaded_by(program)


@pytest.mark.parametrize("module", NO_KERNEL)
def test_a_job_that_may_call_no_kernel_starts_without_numba(module: str) -> None:
    assert "numba" not in loaded_by(f"import geocontact.analyses.{module}")


SELDOM = {*(SLOW - {"scipy.interpolate", "scipy.optimize"}), "scipy.ndimage", "urllib.request"}
"""What takes longest and no job calls at once: `scipy.signal` brings `scipy.stats` along, 0.4 s together."""
EVERY_JOB = f"""
import sys
from geocontact.analyses.catalogue import ENTRIES

for entry in ENTRIES:
    if entry.command not in ("", "gap benchmark"):
        entry.load_job()
        found = {SELDOM} & set(sys.modules)
        assert not found, (entry.command, found)
"""
"""All jobs but the one that makes cases, one after the other: the first that loads something slow is named."""


def test_no_job_starts_with_statistics_signals_or_the_network() -> None:
    loaded_by(EVERY_JOB)


@pytest.mark.slow
def test_a_whole_simulation_needs_no_statistics_signals_or_fits(tmp_path: Path) -> None:
    words = ["elbow", "simulate", "--trials", "1", "--seconds", "2", "--out", str(tmp_path / "out")]
    never = {"scipy.optimize", "scipy.signal", "scipy.stats"}
    program = f"import sys\nfrom geocontact.cli.main import run\nassert run({words}) == 0"
    loaded_by(f"{program}\nfound = {never} & set(sys.modules)\nassert not found, found")


def imported_at_the_top(file: Path) -> set[str]:
    """Top-level packages that a module imports when it is imported."""
    names: set[str] = set()
    for node in ast.parse(file.read_text(encoding="utf-8")).body:
        if isinstance(node, ast.Import):
            names |= {alias.name.partition(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom):
            names.add((node.module or "").partition(".")[0])
    return names


def test_no_module_imports_a_heavy_package_at_the_top() -> None:
    found = {file: imported_at_the_top(file) & HEAVY for file in (ROOT / "geocontact").rglob("*.py")}
    assert not {file.name: sorted(names) for file, names in found.items() if names}
