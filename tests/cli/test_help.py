"""Help and version are there at once and import nothing that only an analysis needs."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from geocontact import __version__
from tests.cli.calls import ROOT, call

HELP = [["--help"], ["area", "--help"], ["demo", "--help"], ["doctor", "--help"], ["view", "--help"]]
HELP += [["cop", "--help"], ["fit", "--help"], ["loadcells", "--help"], ["--version"]]
HELP += [["gap", "--help"], ["gap", "diagnose", "--help"], ["elbow", "--help"], ["elbow", "fit", "--help"]]
HELP += [["ik", "--help"], ["id", "--help"]]
HELP += [["elbow", "design", "--help"], ["elbow", "population", "--help"]]
HEAVY = {"numba", "trimesh", "pyvista", "vtk", "matplotlib", "igl", "fcl", "pandas", "scipy", "open3d", "casadi"}
each_help = pytest.mark.parametrize("arguments", HELP, ids=" ".join)


@each_help
def test_help_takes_less_than_half_a_second_of_the_processor(arguments: list[str]) -> None:
    pytest.importorskip("resource", reason="processor time of a child is measured on Unix")
    child = subprocess.Popen([sys.executable, "cli.py", *arguments], cwd=ROOT, stdout=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    assert child.returncode == 0
    assert usage.ru_utime + usage.ru_stime < 0.5


@each_help
def test_help_imports_nothing_heavy(arguments: list[str]) -> None:
    program = f"import sys; from geocontact.cli.main import run; code = run({arguments!r}); sys.stderr.write("
    program += "f'{code} ' + ' '.join({name.partition('.')[0] for name in sys.modules}))"
    child = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, encoding="utf-8")
    code, *modules = child.stderr.split()
    assert code == "0"
    assert not HEAVY & set(modules)


def test_help_names_the_commands_and_every_option_of_the_contract() -> None:
    commands = (
        "area",
        "cop",
        "demo",
        "doctor",
        "elbow",
        "fit",
        "gap",
        "id",
        "ik",
        "loadcells",
        "markers",
        "scale",
        "view",
    )
    assert all(name in call("--help").out for name in commands)
    promised = (
        "motion unit threshold out osim joint moving map order angles sweep axis place-moving place-fixed convention "
        "side split medial region region-moving compare tolerance bounds save-map assume-closed parquet"
    )
    told = call("area", "--help").out
    assert not [option for option in promised.split() if f"--{option}" not in told]


def test_version() -> None:
    result = call("--version")
    assert (result.code, result.out.strip(), result.err) == (0, __version__, "")
