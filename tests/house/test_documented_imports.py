"""What the pages import from the package, and the files of the repository that they name, are there."""

from __future__ import annotations

import ast
import csv
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
IMPORT = re.compile(r"^\s*from (geocontact[\w.]*) import (.+)$", re.MULTILINE)
IMPORTS = sorted({found for page in PAGES for found in IMPORT.findall(page.read_text(encoding="utf-8"))})
PATH = re.compile(r"`((?:geocontact|benchmarks|tests|meshes)/[\w./-]+|\w+/[\w/]+\.py)`")
PATHS = sorted({found for page in PAGES for found in PATH.findall(page.read_text(encoding="utf-8"))})


def defined(module: str) -> set[str]:
    """Names at the top of a module, by its source; submodules count as well."""
    place = ROOT / module.replace(".", "/")
    inside = {file.stem for file in place.iterdir()} if place.is_dir() else set()
    file = place / "__init__.py" if place.is_dir() else place.with_suffix(".py")
    stub = file.with_suffix(".pyi")
    tree = ast.parse((stub if stub.is_file() else file).read_text("utf-8"))
    for one in tree.body:
        if isinstance(one, (ast.FunctionDef, ast.ClassDef)):
            inside.add(one.name)
        elif isinstance(one, (ast.Import, ast.ImportFrom)):
            inside |= {alias.asname or alias.name for alias in one.names}
        elif isinstance(one, (ast.Assign, ast.AnnAssign)):
            targets = one.targets if isinstance(one, ast.Assign) else [one.target]
            inside |= {name.id for target in targets for name in ast.walk(target) if isinstance(name, ast.Name)}
    return inside


def test_there_are_some() -> None:
    assert len(IMPORTS) > 10 and len(PATHS) > 10  # pages call gc.… where they can


@pytest.mark.parametrize(("module", "names"), IMPORTS, ids=lambda part: part.replace(" ", ""))
def test_a_documented_import_works(module: str, names: str) -> None:
    wanted = {name.partition(" as ")[0].strip() for name in names.partition("#")[0].strip(" ()").split(",")}
    assert wanted <= defined(module)


@pytest.mark.parametrize("path", PATHS)
def test_a_documented_file_exists(path: str) -> None:
    """Modules may be named from the package's folder, or from the one that the page is about."""
    places = (ROOT, ROOT / "geocontact", ROOT / "geocontact" / "gap_benchmark")
    assert any((place / path).exists() for place in places)


def test_corrected_numbers_have_their_tests_and_the_page_has_some_of_them() -> None:
    folder = ROOT / "docs" / "reference"
    every = list(csv.DictReader((folder / "corrected_numbers.csv").read_text(encoding="utf-8").splitlines()))
    assert [one["test"] for one in every if not (ROOT / one["test"]).is_file()] == []
    page = (folder / "corrected_numbers.md").read_text(encoding="utf-8")
    shown = [[cell.strip() for cell in line.strip("|").split("|")] for line in page.splitlines() if "|" in line][2:]
    known = [[one["of"].lower(), one["number"], one["was"], one["is"]] for one in every]
    assert len(shown) >= 10 and all(row in known for row in shown) and f"All {len(every)}, each with its test" in page
