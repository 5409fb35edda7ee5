"""The wheel holds the package and its sample data and nothing that lies about; the demo finds its files in it."""

from __future__ import annotations

import hashlib
import os
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
MANIFEST = tomllib.loads((ROOT / "meshes/manifest.toml").read_text(encoding="utf-8"))
MADE = ("__pycache__", "build", "dist", "generated", "node_modules")  # folders that tools make and git ignores
SOURCE = "front"  # of the page's script; the built file is in the package
RUBBISH = (
    "meshes/generated/tibial_insert_right_finest.stl",
    "meshes/__pycache__/gait.cpython-312.pyc",
    "geocontact/__pycache__/area.cpython-312.pyc",
    "tests/test_it.py",
    "result/area.csv",
)


@pytest.fixture(scope="module")
def wheel(tmp_path_factory: pytest.TempPathFactory) -> zipfile.ZipFile:
    """Built from a copy of the checkout in which things lie about."""
    pytest.importorskip("hatchling", reason="the build backend; make test installs it")
    copy = tmp_path_factory.mktemp("checkout")
    for folder in ("geocontact", "meshes"):
        shutil.copytree(ROOT / folder, copy / folder, ignore=shutil.ignore_patterns(*MADE))
    for name in ("pyproject.toml", "README.md", "LICENSE", ".gitignore"):
        shutil.copy(ROOT / name, copy)
    for name in RUBBISH:
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_text("rubbish", encoding="utf-8")
    program = "from hatchling.build import build_wheel; build_wheel('dist')"
    built = subprocess.run([sys.executable, "-c", program], cwd=copy, capture_output=True, text=True)
    assert built.returncode == 0, built.stderr
    (file,) = (copy / "dist").glob("*.whl")
    return zipfile.ZipFile(file)


def test_wheel_holds_the_package_and_the_sample_data_only(wheel: zipfile.ZipFile) -> None:
    package = [p.relative_to(ROOT) for p in (ROOT / "geocontact").rglob("*") if p.is_file()]
    expected = {p.as_posix() for p in package if not {*MADE, SOURCE} & set(p.parts)}
    expected |= {f"geocontact/meshes/{entry['name']}" for entry in MANIFEST["file"]}
    expected |= {"geocontact/meshes/manifest.toml", "geocontact/meshes/README.md"}
    assert {name for name in wheel.namelist() if ".dist-info/" not in name} == expected
    assert "geocontact/py.typed" in expected, "the classifier says that it is typed"


def test_sample_data_are_those_of_the_manifest(wheel: zipfile.ZipFile) -> None:
    for entry in MANIFEST["file"]:
        content = wheel.read(f"geocontact/meshes/{entry['name']}")
        assert hashlib.sha256(content).hexdigest() == entry["sha256"], entry["name"]


def test_demo_of_an_installed_package_finds_its_files(wheel: zipfile.ZipFile, tmp_path: Path) -> None:
    installed = tmp_path / "site"
    wheel.extractall(installed)
    program = "from geocontact.cli.demo import sample_folder; print(sample_folder())"
    environment = os.environ | {"PYTHONPATH": str(installed)}
    command = [sys.executable, "-c", program]
    found = subprocess.run(command, cwd=tmp_path, env=environment, capture_output=True, text=True)
    assert (found.stdout.strip(), found.stderr) == (str(installed / "geocontact/meshes"), "")
    names = ("femoral_component_right_medium.stl", "tibial_insert_right_medium.stl", "gait.csv")
    assert all((installed / "geocontact/meshes" / name).is_file() for name in names)
