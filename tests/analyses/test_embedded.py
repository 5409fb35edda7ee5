"""A page inside a notebook: the page itself, small, and shut in."""

from __future__ import annotations

import html
import re
from pathlib import Path

import pytest

from geocontact.analyses.frame import embedded, result
from tests.analyses.area.calls import area
from tests.cli.calls import FEMUR, INSERT, MESHES, gait


def test_the_frame_holds_the_page_and_nothing_else_reaches_it(tmp_path: Path) -> None:
    found = area(FEMUR, INSERT, gait(tmp_path), rule="clip")
    shown = found.embedded(height=400)
    frame = shown._repr_html_()
    (quoted,) = re.findall(r'^<iframe srcdoc="([^"]*)" ', frame)
    assert html.unescape(quoted) == shown.page == found.page(tmp_path / "page.html").read_text("utf-8")
    assert 'sandbox="allow-scripts allow-downloads"' in frame and "height: 400px" in frame
    assert repr(shown) == "Embedded(height=400)", "a notebook's list shows no page of a megabyte"


def test_a_page_shows_fewer_frames_until_it_is_small_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    found = area(FEMUR, INSERT, MESHES / "gait.csv", rule="clip", workers=1)
    assert len(found.embedded().page) < embedded.LARGEST_EMBEDDED
    whole = len(found.embedded().page)
    monkeypatch.setattr(result, "LARGEST_EMBEDDED", whole - 1)
    fewer = found.embedded().page
    (shown,) = re.findall(r"The page shows (\d+) of 101 frames", fewer)
    assert len(fewer) < whole and 30 < int(shown) < 60
