"""Words that help, messages, pages and docs do not use: the field has terms for what they mean (CONTRIBUTING)."""

from __future__ import annotations

import ast
import io
import re
import tokenize
from collections.abc import Iterator
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
OPTIONS = re.compile(r"options\.py$")
AVOIDED = re.compile(
    r"\btold\b|\btells?\b|\bleft over\b|\bbelieved\b|\bwhat became of\b|\bunless given\b|\bat most so many\b"
    r"|\bheeded\b|\bas often as there are\b|\bstrangers?\b",
    re.IGNORECASE,
)
KEYS = {"told"}
"""Keys of what a page's script reads; nobody sees them."""


def shown(file: Path) -> Iterator[tuple[int, str]]:
    """Texts that somebody may read: all of a module but for docstrings; those of options are the help."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    docstrings = set()
    for node in ast.walk(tree):
        body = getattr(node, "body", None)
        for one in body if isinstance(body, list) else ():
            text = isinstance(one, ast.Expr) and isinstance(one.value, ast.Constant)
            if text and not (isinstance(node, ast.ClassDef) and OPTIONS.search(file.name)):
                docstrings.add(id(one.value))
    shapes = {id(each) for node in ast.walk(tree) if isinstance(node, ast.Subscript) for each in ast.walk(node.slice)}
    for node in ast.walk(tree):
        text = isinstance(node, ast.Constant) and isinstance(node.value, str)
        if text and id(node) not in docstrings | shapes and node.value not in KEYS:
            yield node.lineno, node.value


def test_the_words_are_seen_where_they_stand() -> None:
    assert AVOIDED.search("What the data cannot tell") and AVOIDED.search("0 Unless  given".replace("  ", " "))
    assert not AVOIDED.search("retold, toldo, the satellites")


def test_help_messages_and_pages_use_the_terms_of_the_field() -> None:
    found = [
        f"{file.relative_to(ROOT)}:{line}: {text[:80]!r}"
        for file in sorted((ROOT / "geocontact").rglob("*.py"))
        for line, text in shown(file)
        if AVOIDED.search(text)
    ]
    assert found == []


def prose(file: Path) -> Iterator[tuple[int, str]]:
    """Comments, and lines of docstrings but for names in backticks and those that stand alone, as parameters do."""
    text = file.read_text(encoding="utf-8")
    for token in tokenize.generate_tokens(io.StringIO(text).readline):
        if token.type == tokenize.COMMENT:
            yield token.start[0], re.sub(r"`[^`]*`", "", token.string)
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and isinstance(node.value.value, str):
            for k, line in enumerate(re.sub(r"`[^`]*`", "", node.value.value).splitlines(), node.lineno):
                if " " in line.strip():
                    yield k, line


def test_docstrings_and_comments_say_known_identified_or_separable_too() -> None:
    """Docstrings are pages of the site."""
    found = [
        f"{file.relative_to(ROOT)}:{line}: {text.strip()[:100]}"
        for file in sorted((ROOT / "geocontact").rglob("*.py"))
        for line, text in prose(file)
        if re.search(r"\btold\b", text)
    ]
    assert found == []


PAGES = sorted([*(ROOT / "docs").rglob("*.md"), ROOT / "README.md"])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
def test_docs_use_them_too(page: Path) -> None:
    lines = re.sub(r"`[^`]*`", "", page.read_text(encoding="utf-8")).splitlines()  # names of files and code aside
    assert [f"{k}: {line[:100]}" for k, line in enumerate(lines, 1) if AVOIDED.search(line)] == []
