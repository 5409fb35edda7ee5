"""The wheel holds the package and its sample data and nothing that lies about; the demo finds its files in it.

The source distribution holds what git does, and the wheel that is built from it is the same, byte for byte.
"""

from __future__ import annotations

import hashlib
import importlib.util
import os
import shutil
import subprocess
import sys
import tarfile
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
MANIFEST = tomllib.loads((ROOT / "meshes/manifest.toml").read_text(encoding="utf-8"))
MADE = ("__pycache__", "build", "dist", "generated", "node_modules")  # folders that tools make and git ignores
SOURCE = "front"  # of the page's script; the built file is in the package
SPEC = importlib.util.spec_from_file_location("build_release", ROOT / ".ci" / "build_release.py")
assert SPEC is not None
assert SPEC.loader is not None
build_release = importlib.util.module_from_spec(SPEC)
SPEC.loader.exec_module(build_release)
RUBBISH = (
    "notes.txt",
    "meshes/generated/tibial_insert_right_finest.stl",
    "meshes/__pycache__/gait.cpython-312.pyc",
    "geocontact/__pycache__/area.cpython-312.pyc",
    "tests/test_it.py",
    "result/area.csv",
)


LICENCES = ("LICENSE", "NOTICE", "geocontact/view/page/bundle/THREE-LICENSE")


@pytest.fixture(scope="module")
def checkout(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the checkout in which things lie about."""
    pytest.importorskip("hatchling", reason="the build backend; make test installs it")
    copy = tmp_path_factory.mktemp("checkout")
    for name in ("geocontact", "meshes", "docs", ".ci"):
        shutil.copytree(ROOT / name, copy / name, ignore=shutil.ignore_patterns(*MADE))
    for file in (each for each in ROOT.iterdir() if each.is_file() and each.name != ".git"):
        shutil.copy(file, copy)
    for name in RUBBISH:
        (copy / name).parent.mkdir(parents=True, exist_ok=True)
        (copy / name).write_text("rubbish", encoding="utf-8")
    return copy


@pytest.fixture(scope="module")
def both(checkout: Path) -> list[Path]:
    """Source distribution and wheel."""
    found: list[Path] = build_release.built(checkout, checkout / "dist", epoch=1_600_000_000)
    return sorted(found, key=lambda file: file.suffix)


@pytest.fixture(scope="module")
def wheel(both: list[Path]) -> zipfile.ZipFile:
    return zipfile.ZipFile(both[1])


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


def test_licences_are_in_the_wheel(wheel: zipfile.ZipFile) -> None:
    for name in LICENCES:
        inside = wheel.read(f"geocontact-{PROJECT['version']}.dist-info/licenses/{name}")
        assert inside == (ROOT / name).read_bytes(), name


def test_source_distribution_holds_no_rubbish_and_builds_the_same_wheel(both: list[Path], tmp_path: Path) -> None:
    """Built somewhere else, from files of another age, a moment later."""
    sdist, wheel = both
    with tarfile.open(sdist) as content:
        names = {name.partition("/")[2] for name in content.getnames()}
    assert {"geocontact/view/page/front/src/main.js", "CITATION.cff", "NOTICE", "requirements.lock", ".ci/run"} <= names
    assert not set(RUBBISH) & names - {"tests/test_it.py"}, "tests are part of it"
    (tmp_path / "sdist").mkdir()
    source = build_release.unpacked(sdist, tmp_path / "sdist")
    (again,) = build_release.built(source, tmp_path / "dist", ("wheel",), epoch=1_600_000_000)
    assert again.read_bytes() == wheel.read_bytes()
