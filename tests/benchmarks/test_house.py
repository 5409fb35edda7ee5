"""What the layout of a package is measured by, on packages of a few lines."""

from __future__ import annotations

from pathlib import Path

import pytest

from benchmarks.house import KINDS, measured, table

CONTRACT = """
[[tool.importlinter.contracts]]
name = "Rooms know only the rooms below them"
layers = ["cli", "analyses : view", "systems | effects", "data"]
"""
MODULE = '''"""A docstring
over

four lines."""

from __future__ import annotations
from geocontact.data import (
    one,
)

# a comment
LIMIT = 3  # another
"""What an attribute is counts as code."""


def twice(value):
    """One line."""
    import json  # late

    return 2 * value
'''


def package(root: Path, files: dict[str, str]) -> Path:
    """A checkout with these files."""
    (root / "pyproject.toml").write_text(CONTRACT, encoding="utf-8")
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")
    return root


def test_every_line_is_of_one_kind(tmp_path: Path) -> None:
    found = measured(package(tmp_path, {"geocontact/a.py": MODULE}))
    assert found["lines_by_kind"] == dict(zip(KINDS, (4, 5, 5, 1, 5), strict=True))
    assert found["lines"] == len(MODULE.splitlines()) and found["modules"] == 1
    assert found["import_lines"] == pytest.approx(5 / 20) and found["small_files"] == 1.0
    long = package(tmp_path, {"geocontact/b.py": "x = 1\n" * 20})
    assert measured(long)["small_files"] == 0.5, "twenty lines are not fewer than twenty"


def test_functions_that_take_the_record(tmp_path: Path) -> None:
    text = "def one(a: int, *, r: Record | None): ...\nclass A:\n    def two(self, *all: list[Record]): ...\n"
    text += "def three(record: int) -> Record: ...\ndef four(r: RecordOf): ...\n"
    files = {f"geocontact/analyses/{name}": text for name in ("job.py", "frame/job.py", "mat/run.py")}
    found = measured(package(tmp_path, files))
    assert (found["functions_with_record"], found["functions_with_record_outside_the_frame"]) == (6, 2)


def test_files_of_an_analysis_are_those_below_its_options(tmp_path: Path) -> None:
    names = ("options.py", "frame/options.py", "mat/__init__.py", "mat/options.py", "mat/deep/law.py", "elbow/words.py")
    names += ("elbow/fit/options.py", "elbow/fit/run.py", "elbow/fit/more/options.py")
    files = {f"geocontact/analyses/{name}": "\n" for name in names}
    found = measured(package(tmp_path, files))
    assert found["files_of_analyses"] == {"mat": 3, "elbow/fit": 2, "elbow/fit/more": 1}
    assert found["files_of_an_analysis"] == {"least": 1, "median": 2, "most": 3}
    assert "| files of an analysis | 1 to 3, median 2 |" in table(found)


def test_circles_of_modules_and_of_packages(tmp_path: Path) -> None:
    """The two modules of `data` know each other; `view` and `analyses` by way of modules that do not."""
    files = {
        "geocontact/data/a.py": "import geocontact.data.b",
        "geocontact/data/b.py": "def late():\n    from geocontact.data import a",
        "geocontact/view/one.py": "from geocontact.analyses.two import thing",
        "geocontact/view/three.py": "",
        "geocontact/analyses/two.py": "",
        "geocontact/analyses/four.py": "from geocontact.view.three import thing",
        "benchmarks/a.py": "from benchmarks.b import one",
        "benchmarks/b.py": "from benchmarks.c import one",
        "benchmarks/c.py": "from benchmarks.a import one\nfrom geocontact.data.a import one",
    }
    found = measured(package(tmp_path, files))
    rooms, inside = ["geocontact.analyses", "geocontact.view"], ["geocontact.data.a", "geocontact.data.b"]
    assert sorted(found["circles"]) == [rooms, inside]
    assert found["circles_of_benchmarks"] == [["benchmarks.a", "benchmarks.b", "benchmarks.c"]]
    assert "| circles, those of `benchmarks/` | 2, 1 |" in table(found)


def test_upward_imports_are_found_by_the_layers(tmp_path: Path) -> None:
    files = {
        "geocontact/data/a.py": "from geocontact.systems.b import one",
        "geocontact/systems/b.py": "import geocontact.data.a\nfrom meshes.make import one",
        "geocontact/effects/c.py": "import geocontact.systems.b",
        "meshes/make.py": "from geocontact.cli.main import one",
        "geocontact/cli/main.py": "import geocontact.view.x, geocontact.data.a",
        "geocontact/view/x.py": "",
    }
    found = measured(package(tmp_path, files))
    assert found["upward_imports"] == [
        "geocontact.data.a -> geocontact.systems.b",
        "geocontact.systems.b -> meshes.make",
    ]
