"""The numbers that docs/theory/gap_diagnosis.md states are those of the code."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest

from benchmarks.gap.constants_of import bare, numbers_in

PAGE = Path(__file__).resolve().parents[2] / "docs" / "theory" / "gap_diagnosis.md"
TEXT = PAGE.read_text(encoding="utf-8")
ROWS = re.findall(r"^\| `([\w.]+)\.([A-Z_]+)` \| ([-\w.]+(?:, [-\w.]+)*) \|", TEXT, re.MULTILINE)
BARE = re.findall(r"^\| `([a-z_.]+)` \| ([\d.]+) \|", TEXT, re.MULTILINE)


def test_there_is_a_table() -> None:
    assert len(ROWS) > 20


@pytest.mark.parametrize(("module", "name", "value"), ROWS, ids=[f"{module}.{name}" for module, name, _ in ROWS])
def test_a_constant_is_what_the_page_says(module: str, name: str, value: str) -> None:
    stated = [float(each) for each in value.split(", ")]
    assert numbers_in(getattr(import_module(f"geocontact.{module}"), name)) == stated


def test_numbers_without_a_name_are_those_of_the_page() -> None:
    found = [(module.removeprefix("geocontact."), float(number)) for module, number in bare(("gap", "identify"))]
    assert sorted(found) == sorted((module, float(number)) for module, number in BARE)


def test_names_in_capitals_are_in_the_table() -> None:
    text = TEXT.partition("## Constants")[0]
    named = set(re.findall(r"(?<![\w.`])[A-Z]{3,}(?:_[A-Z]+)*(?![\w.`])", text)) - {"JSON"}
    assert named <= {name for _, name, __ in ROWS}
