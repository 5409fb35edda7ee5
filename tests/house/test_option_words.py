"""Options are spelled with dashes in the command line only: everywhere else a message names them as Python does."""

from __future__ import annotations

import ast
import re
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[2] / "geocontact"
MODULES = sorted(file for file in PACKAGE.rglob("*.py") if PACKAGE / "cli" not in file.parents)
SPELLED = re.compile(r"(?<![-\w])--[a-z]")


def texts(file: Path) -> list[tuple[int, str]]:
    """Line and text of every string of a module, those inside f-strings and docstrings included."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    return [(n.lineno, n.value) for n in ast.walk(tree) if isinstance(n, ast.Constant) and isinstance(n.value, str)]


@pytest.mark.parametrize("file", MODULES, ids=lambda file: file.relative_to(PACKAGE).as_posix())
def test_no_option_is_spelled_with_dashes(file: Path) -> None:
    assert [(line, text) for line, text in texts(file) if SPELLED.search(text)] == []


def test_the_check_sees_what_it_looks_for(tmp_path: Path) -> None:
    file = tmp_path / "wrong.py"
    file.write_text('"""Words."""\nraise ValueError(f"pass {1} --unit mm")\nheader = "-------"\n')
    assert [line for line, text in texts(file) if SPELLED.search(text)] == [2]
