"""The first screen of every how-to is a command that runs on shipped data, and what it prints.

test_command_lines.py runs it, with all other blocks of the page.
"""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tests.house.first_screens import PAGES, ROOT, agrees, first_screen, missing

FIRST_LINES = 25
ABOUT_PYTHON = ("figures", "own_model")
FILE = re.compile(r"[\w./*-]+\.(?:stl|csv|mot|osim|trc|toml|json)\b")
MADE = re.compile(r"(?:> |--out |export\(\")([\w.-]+)")


def name(page: Path) -> str:
    return page.stem


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_it_begins_with_a_command_and_its_output(page: Path) -> None:
    text = page.read_text(encoding="utf-8")
    screen = first_screen(text)
    assert text.startswith("# ") and screen.line <= FIRST_LINES
    assert screen.language == ("python" if page.stem in ABOUT_PYTHON else "sh")
    assert any(line.strip(" …") for line in screen.shown), "no output below the first command"


@pytest.mark.parametrize("page", PAGES, ids=name)
def test_it_names_files_that_are_shipped_or_made_by_it(page: Path) -> None:
    code = first_screen(page.read_text(encoding="utf-8")).code
    made = set(MADE.findall(code))
    named = [file for file in FILE.findall(code) if file.partition("/")[0] not in made]
    assert all((ROOT / file).is_file() and file.startswith("meshes/") for file in named), named


@pytest.mark.parametrize(
    ("shown", "printed", "same"),
    [
        ("area 1796.3 … 2505.0 mm^2", "area 1797.1 … 2503.0 mm^2", True),
        ("area 1796.3 … 2505.0 mm^2", "area 1796.3 … 2508.0 mm^2", False),
        ("area 1796.3 … 2505.0 mm^2", "areas 1796.3 … 2505.0 mm^2", False),
        ("[−3, 82] of 0.0", "[\N{MINUS SIGN}3, 82] of 0.0", True),
        ("results in result: a.csv, … run.json", "results in result: a.csv, b.csv, run.json", True),
        ("results in result: a.csv, … run.json", "results in result: b.csv, run.json", False),
        ("  0.1   2.5", " 0.1 2.5", True),
        ("1e-3 N", "0.001 N", True),
    ],
)
def test_lines_are_compared_by_words_and_numbers(shown: str, printed: str, same: bool) -> None:
    assert agrees(shown, printed) == same


def test_lines_are_looked_for_in_order() -> None:
    assert missing(("a 1", "…", "c 3"), "a 1\nb 2\nc 3\n") == []
    assert missing(("c 3", "a 1"), "a 1\nb 2\nc 3\n") == ["a 1"]
    assert missing(("a 1", "d"), "a 1\nb 2\nc 3\n") == ["d"]
