"""Every public name has a page; its example runs and prints what the page shows."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.house.first_screens import agrees
from website.api.entries import CHAIN, UNITS, Entry, entries
from website.api.pages import FOLDER, api_pages
from website.examples import differences

ENTRIES = entries()
WITH, WITHOUT = ([one for one in ENTRIES if bool(one.example) is kind] for kind in (True, False))
LACKING = 28  # may only fall
LONG = {  # more than three CPU seconds
    "diagnose",
    "discriminability",
    "inject",
    "mat",
    "knee.settle",
    "misalignment.compare",
    "misalignment.design",
    "misalignment.identify",
    "pressure",
    "prosthesis.scale",
    "shoulder.optimise",
}


def name(entry: Entry) -> str:
    return entry.name


def marked(entry: Entry) -> object:
    return pytest.param(entry, marks=pytest.mark.slow) if entry.name in LONG else entry


@pytest.mark.parametrize("entry", [marked(one) for one in WITH if one.group != UNITS], ids=name)
def test_an_example_prints_what_it_shows(entry: Entry, tmp_path: Path) -> None:
    assert differences(entry.name, entry.example, tmp_path, agrees) == ""


def test_an_example_that_prints_something_else_is_told(tmp_path: Path) -> None:
    assert "Expected" in differences("sum", ">>> 1 + 1\n3", tmp_path, agrees)


@pytest.mark.xfail(strict=True, reason=f"{LACKING} of {len(ENTRIES)} public names have no example")
def test_every_public_name_has_an_example() -> None:
    assert [one.name for one in WITHOUT] == []


def test_names_without_an_example_are_as_many_as_is_said() -> None:
    assert len(WITHOUT) == LACKING, [one.name for one in WITHOUT]


def test_every_public_name_has_a_page_with_its_parameters() -> None:
    pages = api_pages()
    for one in ENTRIES:
        text = pages[f"{FOLDER}/{'units' if one.group == UNITS else one.name}.md"]
        assert "## Source" in text or one.group == UNITS
        assert one.group in {CHAIN, UNITS} or re.search(r"^## Example$", text, re.MULTILINE)
        assert f"gc.{one.name}" in text
