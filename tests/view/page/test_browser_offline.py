"""The page opens offline from any folder, without a complaint, whatever names hold and browsers lack."""

from __future__ import annotations

import json
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from geocontact.view.page.content import Curves, Words
from tests.view.page.conftest import DESKTOP, PHONE, Open, set_range
from tests.view.page.examples import curves_page, small_page
from tests.view.page.hostile import HOSTILE, hostile_page
from tests.view.page.pictures import pixels

NO_WEBGL = """
const get = HTMLCanvasElement.prototype.getContext;
HTMLCanvasElement.prototype.getContext = function (kind, ...rest) {
  return String(kind).startsWith('webgl') ? null : get.call(this, kind, ...rest);
};"""


@pytest.mark.parametrize("device", [DESKTOP, PHONE], ids=["1280x800", "390x844"])
def test_opens_from_any_folder_asking_nobody(opened: Open, device: dict[str, Any]) -> None:
    here = opened(small_page(), 'with space\'s & "quotes" #1 100%/page é.html', device)
    here.tab.wait_for_timeout(300)
    assert len(here.requests) == 1, here.requests
    assert here.requests[0].startswith("file:")
    assert here.complaints == []
    seen = pixels(here.picture()).reshape(-1, 3)
    assert len(np.unique(seen, axis=0)) > 500, "not blank"
    assert here.frame() == small_page().opening
    assert here.tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth"), "no sideways scrolling"
    for scrolled in ("#view", "#section-3"):
        here.tab.locator(scrolled).evaluate("e => e.scrollIntoView({block: 'center'})")
        slider = here.tab.locator("#slider").bounding_box()
        assert slider
        assert 0 <= slider["y"] <= device["viewport"]["height"] - slider["height"], "time is at hand"
    touch = "e => [e, document.body].map(x => getComputedStyle(x).touchAction)"
    assert here.tab.locator("#canvas").evaluate(touch) == ["none", "auto"], "a finger turns it, and scrolls elsewhere"


def test_hostile_names_stay_text(opened: Open) -> None:
    here = opened(hostile_page(small_page(), HOSTILE), "hostile.html")
    assert here.tab.evaluate("'hacked' in window") is False
    set_range(here, "#slider", 2)
    here.tab.wait_for_timeout(300)
    assert here.tab.evaluate("'hacked' in window") is False
    assert here.complaints == []
    assert len(here.requests) == 1
    texts = set(here.tab.evaluate("[...document.querySelectorAll('bdi, svg text')].map(e => e.textContent)"))
    assert set(HOSTILE) <= texts
    assert here.tab.evaluate("document.title") == HOSTILE[0]
    assert here.tab.evaluate("document.querySelectorAll('bdi *, iframe, object, embed, img, form, base').length") == 0
    assert here.tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


def test_the_policy_is_in_force(opened: Open) -> None:
    here = opened(replace(small_page(), sections=[Words("a", ["b"])]))
    reached = here.tab.evaluate(
        """async () => {
          const script = document.createElement('script');
          script.textContent = 'window.hacked = 1';
          document.body.append(script);
          const get = await fetch('data:text/plain,x').then(() => true, () => false);
          return [get, 'hacked' in window];
        }"""
    )
    assert reached == [False, False]


def test_without_webgl_the_rest_works_and_says_so(opened: Open) -> None:
    here = opened(small_page(), before=NO_WEBGL)
    assert "WebGL" in here.text("#notice")
    assert here.tab.locator("#notice").is_visible()
    assert not here.tab.locator("#canvas").is_visible()
    here.tab.locator("#slider").press("Home")
    assert here.frame() == 0
    assert here.tab.locator("#section-2 path.line").count() >= 2
    assert not [c for c in here.complaints if "error:" in c and "WebGL" not in c]


def test_without_scripts_words_tables_and_numbers_are_read(opened: Open) -> None:
    here = opened(small_page(), java_script_enabled=False)
    words = here.tab.inner_text("body")
    for text in (
        "largest area",
        "Scripts are off",
        "ball.stl",
        "Not a clinical device",
        small_page().sections[1].rows[0].texts[4],
    ):
        assert text in words


@pytest.mark.parametrize("frames", [1, 1000])
def test_curves_alone_with_any_number_of_frames(opened: Open, frames: int) -> None:
    here = opened(curves_page(frames))
    assert here.complaints == []
    assert here.tab.locator("#slider").count() == (frames > 1)
    if frames > 1:
        here.tab.locator("#slider").press("End")
        assert f"frame {frames}/{frames}" in here.text("#now")
    assert here.text("td.value") == f"{frames - 1:.3f}"
    if frames > 1:
        here.tab.keyboard.press("Space")
        assert here.tab.locator("#play").get_attribute("aria-label") == "Pause"


def test_one_frame_has_a_picture(opened: Open) -> None:
    here = opened(small_page(frames=1))
    assert len(np.unique(pixels(here.picture()).reshape(-1, 3), axis=0)) > 500
    assert here.complaints == []


def test_data_of_the_page_are_those_given(opened: Open) -> None:
    """What the browser unpacked, against the numbers that were packed."""
    page = small_page()
    here = opened(page)
    data = json.loads(here.text("#page-data"))
    curves = next(section for section in page.sections if isinstance(section, Curves)).curves
    part = next(part for part in data["parts"] if part["kind"] == "curves")
    assert part["curves"][0]["values"] == pytest.approx(list(curves[0].values), rel=1e-6)
