"""Every kind of page, as the command line writes it, at both widths."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

from benchmarks.page_pictures.kinds import KINDS, make_pages
from tests.view.page.conftest import DESKTOP, PHONE, Open

STILL = {
    *("cohort", "fit", "modulus", "elbow_fit", "elbow_design", "elbow_population"),
    *("scale", "gap_gather", "gap_diagnose", "gap_discriminability"),
    *("prosthesis_scale", "prosthesis_calibrate", "prosthesis_compare", "prosthesis_design"),
}
"""Pages on which nothing runs in time."""


FIRST = {"area", "id", "mat", "modulus", "elbow_fit"}
"""Kinds that are opened with every change: a scene, a skeleton, a map, choices, a drawing."""
MARKED = [kind if kind in FIRST else pytest.param(kind, marks=pytest.mark.long) for kind in KINDS]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("kinds")


@pytest.mark.slow
@pytest.mark.parametrize("kind", MARKED)
def test_the_first_screen_answers(folder: Path, opened: Open, kind: str) -> None:
    page = make_pages(folder, [kind], again=False, jobs=1)[kind]
    warnings = json.loads((page.parent / "run.json").read_text(encoding="utf-8"))["warnings"]
    for device in (DESKTOP, PHONE):
        _first_screen(page, opened, device, bool(warnings), kind not in STILL)


def _first_screen(page: Path, opened: Open, device: dict[str, Any], warned: bool, plays: bool) -> None:
    here = opened(page, device=device)
    high, tab = device["viewport"]["height"], here.tab
    answer = tab.locator(".answer:visible").bounding_box()
    lead = tab.locator("#view, .lead").first.bounding_box()
    assert answer and lead
    assert answer["y"] + answer["height"] < 0.4 * high
    assert lead["y"] + 0.5 * min(lead["height"], 300.0) < high, "the picture that shows it"
    assert tab.locator(".banner").count() >= warned
    assert tab.locator("#play").count() == plays
    assert not tab.locator("details.fold td").first.is_visible(), "versions and hashes are folded"
    for k in range(tab.locator("img").count()):
        if not tab.locator("img").nth(k).is_visible():
            continue  # of another choice
        tab.locator("img").nth(k).scroll_into_view_if_needed()
        here.until(f"document.images[{k}].complete && document.images[{k}].naturalWidth > 100")
    assert tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth"), "no sideways scrolling"
    assert [address for address in here.requests if not address.startswith("data:")] == [page.as_uri()]
    assert here.complaints == []
