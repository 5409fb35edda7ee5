"""Captions leave colours to the key, which is drawn with the lines; one that names hues is that of a map with them."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

ANALYSES = Path(__file__).resolve().parents[2] / "geocontact" / "analyses"
HUES = re.compile(r"\b(blue|orange|green|pink|purple|yellow|red)\b", re.IGNORECASE)
MAPS = {"misalignment/simulate/show.py": ("blue", "red")}
"""Modules whose captions name the ends of a colour map, and the ends."""


def captions(file: Path) -> Iterator[str]:
    """Texts of a module, docstrings and notes below constants left out."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    notes = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
    for node in ast.walk(tree):
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and id(node) not in notes:
            yield node.value


def named() -> dict[str, set[str]]:
    """Hues by module whose texts name some."""
    found = {
        file.relative_to(ANALYSES).as_posix(): {hue.lower() for text in captions(file) for hue in HUES.findall(text)}
        for file in sorted(ANALYSES.rglob("*.py"))
    }
    return {file: hues for file, hues in found.items() if hues}


def test_no_caption_names_the_colour_of_a_line() -> None:
    assert named() == {file: set(ends) for file, ends in MAPS.items()}


@pytest.mark.parametrize("file", MAPS)
def test_ends_of_a_map_are_of_the_hues_that_its_caption_names(file: str) -> None:
    """The first named is the end below 0, the second that above."""
    import matplotlib as mpl

    source = (ANALYSES / file).read_text(encoding="utf-8")
    (name,) = set(re.findall(r'"cmap": "(\w+)"', source))
    low, high = (mpl.colormaps[name](end)[:3] for end in (0.0, 1.0))
    channel = {"red": 0, "green": 1, "blue": 2}
    for end, hue in zip((low, high), MAPS[file], strict=True):
        assert max(range(3), key=lambda k, end=end: end[k]) == channel[hue]  # type: ignore[misc]
