"""Docstrings are sentences with a subject, or noun phrases that stand by themselves."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
ROOMS = sorted(path for path in (ROOT / "geocontact").iterdir() if path.is_dir() and path.name != "__pycache__")
HANGING = ("Of", "As", "Its")


def documented(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Docstrings of modules, classes and functions, and texts below assignments, with their lines."""
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        for each in body if isinstance(body, list) else ():
            value = each.value if isinstance(each, ast.Expr) else None
            if isinstance(value, ast.Constant) and isinstance(value.value, str):
                yield each.lineno, value.value


def hanging(text: str) -> list[int]:
    """Lines of docstrings that lean on a name outside of them."""
    return [line for line, said in documented(ast.parse(text)) if said.split()[:1] and said.split()[0] in HANGING]


@pytest.mark.parametrize("room", ROOMS, ids=lambda path: path.name)
def test_docstrings_stand_by_themselves(room: Path) -> None:
    found = {}
    for file in room.rglob("*.py"):
        if lines := hanging(file.read_text(encoding="utf-8")):
            found[str(file.relative_to(ROOT))] = lines
    assert found == {}


def test_a_docstring_that_leans_on_a_name_is_seen() -> None:
    text = 'A = 1\n"""Of the link."""\ndef mass():\n    """Mass of the link."""\n    x = 1\n    """As it is."""\n'
    assert hanging(text) == [2, 6]
