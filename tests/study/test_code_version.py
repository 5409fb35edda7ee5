"""The version of an analysis' code changes with what it can import and with nothing else."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import geocontact
from geocontact.analyses.catalogue import ENTRIES, entry_of
from geocontact.study.code_version import READ_FROM_FILES, CodeSources, code_version

PACKAGE = Path(geocontact.__file__).parent
LATE = {
    "analyses/catalogue.py",
    "analyses/frame/calls.py",
    "analyses/frame/typed_text.py",
    "analyses/gap/benchmark/show.py",
    "app/within.py",
    "chain/__init__.py",
    "data/stub_names.py",
    "systems/python_model.py",
}
"""CodeSources that import by a name: of the catalogue, an annotation, their own texts, a stub, a case or a form."""


@pytest.fixture(scope="module")
def copied(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A package that can be changed."""
    folder = tmp_path_factory.mktemp("copied") / "geocontact"
    shutil.copytree(PACKAGE, folder, ignore=shutil.ignore_patterns("__pycache__", "node_modules"))
    return folder


def versions(package: Path) -> dict[str, str]:
    modules = {each: entry_of(each).module for each in ("area", "mat", "modulus", "ik", "gap diagnose")}
    return {name: CodeSources(geocontact=package).digest(module) for name, module in modules.items()}


def changed(package: Path, name: str) -> set[str]:
    """Analyses whose version changes with a file, which is then as it was."""
    before, file = versions(package), package / name
    content = file.read_bytes()
    file.write_bytes(content + b"\n# changed\n")
    try:
        return {each for each, version in versions(package).items() if version != before[each]}
    finally:
        file.write_bytes(content)


@pytest.mark.parametrize(
    ("file", "analyses"),
    [
        ("analyses/mat/result.py", {"mat"}),
        ("geometry/surface.py", {"area", "mat", "modulus", "gap diagnose"}),
        ("analyses/area/options.py", {"area"}),
        ("analyses/motion/inverse_kinematics/result.py", {"ik"}),
        ("gap/__init__.py", {"gap diagnose"}),
        ("systems/elbow.py", {"gap diagnose"}),
        ("analyses/frame/result.py", {"area", "mat", "modulus", "ik", "gap diagnose"}),
        ("view/page/templates/table.html", {"area", "mat", "modulus", "ik", "gap diagnose"}),
        ("data/version.py", set()),
        ("study/result.py", set()),
        ("cli/main.py", set()),
    ],
)
def test_a_change_makes_new_what_can_import_it(copied: Path, file: str, analyses: set[str]) -> None:
    assert changed(copied, file) == analyses


def test_every_import_by_name_is_one_that_is_known() -> None:
    """Others would have to be found by `CodeSources`."""
    found = {
        file.relative_to(PACKAGE).as_posix()
        for file in PACKAGE.rglob("*.py")
        if "import_module" in (text := file.read_text(encoding="utf-8")) or "__import__(" in text
    }
    assert found - {"cli/doctor.py", "study/code_version.py"} == LATE
    assert set(READ_FROM_FILES) == {"geocontact.systems.python_model"}


RUN = """
import sys
from geocontact.cli.main import main
try:
    main(sys.argv[2:])
except SystemExit as ended:
    assert not ended.code, ended.code
open(sys.argv[1], "w").write(" ".join(name for name in sys.modules if name.partition(".")[0] == "geocontact"))
"""
MESHES = Path(__file__).parents[2] / "meshes"
CALLS = {
    "fit": f"{MESHES}/sphere_r20.stl --shape sphere --unit mm",
    "markers": f"{MESHES}/leg_swing.mot --model {MESHES}/leg.osim",
    "elbow simulate": "--trials 1 --seconds 2",
    "mat": f"{MESHES}/mat_thigh_16x8/frames.csv --layout {MESHES}/mat_thigh_16x8/layout.toml --unit mm "
    f"--surface {MESHES}/thigh.stl --landmarks {MESHES}/mat_thigh_16x8/landmarks.csv",
    "area": f"{MESHES}/sphere_r20.stl {MESHES}/plate_80x80x12.stl --unit mm --sweep turn=0:2:1 --axis 0,30,0,1,0,0 "
    "--pressure --modulus 500MPa --poisson 0.4 --thickness 8mm",
}
"""Commands with page, figures and tables."""


@pytest.mark.slow
@pytest.mark.parametrize("command", CALLS)
def test_a_command_imports_nothing_that_its_version_leaves_out(tmp_path: Path, command: str) -> None:
    """What only the command line and the number of the release need is apart."""
    words = [*command.split(), *CALLS[command].split(), "--out", str(tmp_path / "out")]
    subprocess.run([sys.executable, "-c", RUN, str(tmp_path / "names"), *words], check=True, timeout=300)
    loaded = {each for each in (tmp_path / "names").read_text("utf-8").split() if ".cli" not in each}
    known, _ = CodeSources().closure(entry_of(command).module)
    assert loaded - set(known) - {"geocontact.data.version", "geocontact.analyses.catalogue"} == set()
    assert len(loaded) > 40


def test_every_analysis_has_a_version_with_its_libraries() -> None:
    sources = CodeSources()
    for entry in ENTRIES:
        found, libraries = sources.closure(entry.module)
        assert entry.module in found and f"{entry.package}.options" in found and "numpy" in libraries
        assert len(found) < 400, "of a thousand"
    assert "casadi" in str(code_version(entry_of("ik").module)["libraries"])
    assert "casadi" not in str(code_version(entry_of("area").module)["libraries"])


def test_modules_that_no_distribution_has_are_sources_and_not_libraries(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A helper beside the analysis, what that imports, a folder without __init__.py, and a file that one names."""
    texts = {
        "own_add.py": "import numpy\nfrom own_helper import factor\n",
        "own_helper.py": "def factor():\n    import own_parts.more\n    return open('factor.json')\n",
        "own_parts/more.py": "import tomllib\n",
        "factor.json": "1",
        "study.toml": "",
        "out/run.json": "",
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    monkeypatch.syspath_prepend(tmp_path)
    assert CodeSources().closure("own_add")[1] == {"numpy"}

    def changes(name: str) -> bool:
        before = CodeSources().digest("own_add")
        (tmp_path / name).write_text(texts[name] + "\n", encoding="utf-8")
        return CodeSources().digest("own_add") != before

    assert {name for name in texts if changes(name)} == {*texts} - {"study.toml", "out/run.json"}
