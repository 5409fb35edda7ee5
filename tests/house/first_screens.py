"""First screens of the how-to pages: what is typed, and the output that the page shows below it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PAGES = sorted((ROOT / "docs" / "how-to").glob("*.md"))
NUMBER = re.compile(r"[-\N{MINUS SIGN}]?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
TOLERANCE = 1e-3


@dataclass(frozen=True)
class FirstScreen:
    """First code of a page.

    Parameters
    ----------
    line
        Where its fence stands in the page, from 1.
    language
        sh, or python on the pages about Python.
    shown
        Lines of the output block that follows; none where another block follows, or other text.
    """

    line: int
    language: str
    code: str
    shown: tuple[str, ...]


def first_screen(page: str) -> FirstScreen:
    """Of the text of a page; ValueError where there is no code in it."""
    found = re.search(r"^```(\w+)\n(.*?)^```\n(?:\n```text\n(.*?)^```$)?", page, re.MULTILINE | re.DOTALL)
    if found is None:
        raise ValueError("no code")
    line = page[: found.start()].count("\n") + 1
    return FirstScreen(line, found[1], found[2], tuple((found[3] or "").splitlines()))


def agrees(shown: str, printed: str) -> bool:
    """Whether a line of a page is this line of output: numbers to a thousandth, "…" stands for anything."""
    shown, printed = " ".join(shown.split()), " ".join(printed.split())
    parts = re.split(f"({NUMBER.pattern}|…)", shown)
    # even parts are words, odd ones numbers and dots
    pattern = "".join(
        re.escape(part) if i % 2 == 0 else ".*" if part == "…" else f"({NUMBER.pattern})"
        for i, part in enumerate(parts)
    )
    found = re.fullmatch(pattern, printed)
    if found is None:
        return False
    wanted = [number(part) for part in parts[1::2] if part != "…"]
    there = map(number, found.groups())
    return all(abs(one - other) <= TOLERANCE * abs(other) for one, other in zip(there, wanted, strict=True))


def number(text: str) -> float:
    return float(text.replace("\N{MINUS SIGN}", "-"))


def missing(shown: tuple[str, ...], printed: str) -> list[str]:
    """Lines of a page that the output lacks, in the page's order."""
    lines, absent = iter(printed.splitlines()), []
    for line in shown:
        if line.strip() != "…" and not any(agrees(line, other) for other in lines):
            absent.append(line)
            lines = iter(())
    return absent
