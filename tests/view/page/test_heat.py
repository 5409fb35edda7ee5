"""Strips and matrices: what the page's script is given, and what is refused."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from geocontact.view.page.content import Matrix, Page, StripBlock, Strips
from geocontact.view.page.write import page_html

SCALE = ("0 %", "25 %", "50 %", "75 %", "100 %")
TEXTS = [["none", "half", "all"], ["not known"] * 3]
BLOCK = StripBlock(
    "phase [%]",
    ("0", "33.3", "66.7", "100"),
    np.array([[0.0, 0.5, 1.0], [np.nan, 0.25, 0.0]]),
    TEXTS,
    [["", "+", "−"], ["", "", "•"]],
    wide=True,
)
STRIPS = Strips(
    "Where", "", ("force", "<b>angle"), (BLOCK, replace(BLOCK, name="load [N]", wide=False)), SCALE, "Words."
)
MATRIX = Matrix("Pairs", "nats", ("a", "b"), ("none", "a", "b"), "rows ↓", BLOCK.values, TEXTS, SCALE, "More words.")


def page_of(*sections: Strips | Matrix) -> Page:
    """A page of these alone."""
    return Page("title", "", np.zeros(1), "", sections=sections)


def parts(html: str) -> list[dict]:
    """What the script draws."""
    (text,) = re.findall(r'id="page-data">(.*?)</script>', html, re.DOTALL)
    return list(json.loads(text)["parts"])


def test_the_script_gets_shades_marks_and_texts() -> None:
    html = page_html(page_of(STRIPS, MATRIX))
    strips, matrix = parts(html)
    assert (strips["kind"], matrix["kind"]) == ("strips", "matrix")
    first = strips["blocks"][0]
    assert first["values"] == [[0.0, 0.5, 1.0], [None, 0.25, 0.0]] and first["marks"][0] == ["", "+", "−"]
    assert first["edges"] == ["0", "33.3", "66.7", "100"] and first["wide"] and not strips["blocks"][1]["wide"]
    assert matrix["values"] == first["values"] and matrix["texts"] == TEXTS and matrix["columns"] == ["none", "a", "b"]
    assert "Words." in html and "More words." in html and "<b>angle" not in html


def test_they_show_the_answer_where_they_come_first() -> None:
    assert page_of(MATRIX, STRIPS).leads == range(1)


@pytest.mark.parametrize(
    "change",
    [
        lambda: replace(BLOCK, edges=("0", "1")),
        lambda: replace(BLOCK, marks=[["", ""], ["", ""]]),
        lambda: replace(BLOCK, texts=TEXTS[:1]),
        lambda: replace(STRIPS, rows=("force",)),
        lambda: replace(STRIPS, scale=SCALE[:4]),
        lambda: replace(MATRIX, columns=("a", "b")),
        lambda: replace(MATRIX, texts=TEXTS[:1]),
    ],
)
def test_what_does_not_fit_is_refused(change: object) -> None:
    with pytest.raises(ValueError, match=r"edges|texts|rows|words|expected"):
        change()  # type: ignore[operator]
