"""The numbers that docs/theory/gap_diagnosis.md states are those of the code."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest

PAGE = Path(__file__).resolve().parents[2] / "docs" / "theory" / "gap_diagnosis.md"
ROWS = re.findall(r"^\| `([\w.]+)\.([A-Z_]+)` \| (\S+) \|", PAGE.read_text(encoding="utf-8"), re.MULTILINE)


def test_there_is_a_table() -> None:
    assert len(ROWS) > 20


@pytest.mark.parametrize(("module", "name", "value"), ROWS, ids=[f"{module}.{name}" for module, name, _ in ROWS])
def test_a_constant_is_what_the_page_says(module: str, name: str, value: str) -> None:
    assert getattr(import_module(f"geocontact.{module}"), name) == float(value)


def test_names_in_capitals_are_in_the_table() -> None:
    text = PAGE.read_text(encoding="utf-8").partition("## Constants")[0]
    named = set(re.findall(r"(?<![\w.`])[A-Z]{3,}(?:_[A-Z]+)*(?![\w.`])", text)) - {"JSON"}
    assert named <= {name for _, name, __ in ROWS}
