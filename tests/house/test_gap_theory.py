"""The numbers that docs/theory/gap_diagnosis.md states are those of the code."""

from __future__ import annotations

import csv
import re
from importlib import import_module
from pathlib import Path

import pytest

from benchmarks.gap.constants_of import bare, numbers_in

PAGE = Path(__file__).resolve().parents[2] / "docs" / "theory" / "gap_diagnosis.md"
TEXT = PAGE.read_text(encoding="utf-8")
SYMBOLS = re.findall(r"^\| `([\w.]+)\.([A-Z_]+)` \| ([-\w.]+) \| (\S+) \|", TEXT, re.MULTILINE)
LISTED = PAGE.parents[1] / "reference" / "gap_constants.csv"
"""Every constant with its reason: the page has those that its formulas use, by their symbols."""
ROWS = [
    (*one["constant"].rpartition(".")[::2], one["value"])
    for one in csv.DictReader(LISTED.read_text(encoding="utf-8").splitlines())
]
BARE = re.findall(r"^\| `([a-z_.]+)` \| ([\d.]+) \|", TEXT, re.MULTILINE)


def test_there_are_tables() -> None:
    assert len(ROWS) >= 150 and len(SYMBOLS) > 10
    assert {row[:3] for row in SYMBOLS} <= set(ROWS)


def test_symbols_stand_in_the_text() -> None:
    text = TEXT.partition("## Constants")[0]
    assert [symbol for *_, symbol in SYMBOLS if symbol not in text] == []


@pytest.mark.parametrize(("module", "name", "value"), ROWS, ids=[f"{module}.{name}" for module, name, _ in ROWS])
def test_a_constant_is_what_the_page_says(module: str, name: str, value: str) -> None:
    stated = [float(each) for each in value.split(", ")]
    assert numbers_in(getattr(import_module(f"geocontact.{module}"), name)) == stated


def test_numbers_without_a_name_are_those_of_the_page() -> None:
    found = [(module.removeprefix("geocontact."), float(number)) for module, number in bare(("gap", "identify"))]
    assert sorted(found) == sorted((module, float(number)) for module, number in BARE)


def test_no_constant_stands_in_capitals_in_the_text() -> None:
    text = TEXT.partition("## Constants")[0]
    assert {name for _, name, __ in ROWS} & set(re.findall(r"[A-Z]{3,}(?:_[A-Z]+)*", text)) == set()
