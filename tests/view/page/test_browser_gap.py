"""The page of a gap diagnosis in a browser: offline, without a complaint, its map drawn in the colours of the page."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

from tests.cli.gap_cases import damped_elbow
from tests.view.page.conftest import DESKTOP, PHONE, Open
from tests.view.page.test_heat import MATRIX, STRIPS, TEXTS, page_of

ROOT = Path(__file__).resolve().parents[3]


OVERLAPS = """[...document.querySelectorAll("svg.heat")].flatMap((frame) => {
  const boxes = [...frame.querySelectorAll(".tick")].map((each) => each.getBoundingClientRect());
  const edge = frame.getBoundingClientRect();
  const cut = boxes.filter((box) => box.left < edge.left - 1 || box.right > edge.right + 1);
  return [...cut, ...boxes.filter((box, k) => k && box.left < boxes[k - 1].right + 2)].map((box) => box.left);
})"""
"""Labels that are cut, or lie on each other."""


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Page of a damped elbow, made where shapes are not checked at every call."""
    folder = tmp_path_factory.mktemp("gap page")
    words = ("gap", "diagnose", damped_elbow(folder / "case"), "--out", folder / "out")
    subprocess.run([sys.executable, "cli.py", *map(str, words)], cwd=ROOT, check=True, capture_output=True)
    return folder / "out" / "report.html"


@pytest.mark.slow
@pytest.mark.parametrize("device", [DESKTOP, PHONE], ids=["1280x800", "390x844"])
def test_opens_and_draws_its_map(report: Path, opened: Open, device: dict[str, Any]) -> None:
    here = opened(report, device=device)
    assert here.tab.locator("img").count() == 1, "the stacked bars of the budget; all else is the page's own"
    assert here.tab.locator("svg.heat .cell").count() > 40
    assert here.tab.evaluate(OVERLAPS) == [], "labels of the map's axes stay apart"
    assert here.tab.evaluate("getComputedStyle(document.querySelector('.heat .tick')).fontSize") == "11px"
    assert here.complaints == []
    asked = [address for address in here.requests if not address.startswith("data:")]
    assert asked == [report.as_uri()]
    assert here.tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth"), "no sideways scrolling"
    assert here.tab.locator("svg").count() > 2, "curves of the held-out trials"


@pytest.mark.slow
def test_strips_and_matrix_follow_the_dark_scheme(opened: Open) -> None:
    """No white slab: the ground of cards, and shades of a light blue."""
    page = page_of(STRIPS, MATRIX)
    colours = {}
    for scheme in ("light", "dark"):
        here = opened(page, name=f"{scheme}.html", device=PHONE, color_scheme=scheme)
        look = "(s, p) => getComputedStyle(document.querySelector(s)).getPropertyValue(p)"
        colours[scheme] = [
            here.tab.evaluate(f"({look})('.matrix tbody th', 'background-color')"),
            here.tab.evaluate(f"({look})('.heat .cell', 'fill')"),
            here.tab.evaluate(f"({look})('.matrix tbody td:nth-child(3)', 'background-color')"),
        ]
        assert here.complaints == []
        assert here.tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth"), "no sideways scrolling"
        assert here.tab.locator(".matrix tbody td").all_text_contents() == [text for row in TEXTS for text in row]
        assert here.tab.evaluate(OVERLAPS) == []
    assert colours["light"] == ["rgb(255, 255, 255)", "rgb(0, 114, 178)", "rgba(0, 114, 178, 0.5)"]
    assert colours["dark"] == ["rgb(29, 33, 38)", "rgb(86, 180, 233)", "rgba(86, 180, 233, 0.5)"]
