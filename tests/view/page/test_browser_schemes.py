"""The 3-D picture in light and dark, on paper, on a phone: its ground, its legend, its buttons, its first values."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from geocontact.view.page.content import Curve, Curves, Linkage, Page, Scene
from tests.view.page.conftest import PHONE, Open, Opened
from tests.view.page.examples import small_page
from tests.view.page.pictures import pixels
from tests.view.page.test_browser_linkages import swinging
from tests.view.page.test_linkage import pendulum

pytestmark = pytest.mark.slow

LEAST_TYPE = 10.0  # px


def ground(here: Opened) -> float:
    """Brightness of the picture's corner, 0 … 255."""
    return float(pixels(here.picture())[:4, :4].mean())


def drawn_type(here: Opened, selector: str) -> list[float]:
    """Sizes of the texts of drawings as they are seen [px]: that of the style times the drawing's scale."""
    script = """s => [...document.querySelectorAll(s)].map(text => {
      const svg = text.ownerSVGElement, box = svg.getBoundingClientRect();
      return parseFloat(getComputedStyle(text).fontSize) * box.width / svg.viewBox.baseVal.width; })"""
    return [float(size) for size in here.tab.evaluate(script, selector)]


def crowded() -> Page:
    """As a scene of standing up: six linkages with long names."""
    page, names = swinging(), ("exoskeleton", "normal force of one strap, 0.5 m for 100 N", "shank, thigh, trunk")
    one = pendulum()
    more = [Linkage(name, one.points, one.lines, "force", one.radius, one.width) for name in (*names, "foot", "a", "b")]
    scene = page.sections[0]
    assert isinstance(scene, Scene)
    views = {f"direction {k} (+x)": (1.0, 0.1 * k, 0.0) for k in range(8)}
    return replace(page, sections=[replace(scene, linkages=more, directions=views), *page.sections[1:]])


def soon(here: Opened, wanted: Callable[[float], bool]) -> bool:
    """Whether the ground of the picture is as wanted within 5 s: a busy machine draws late."""
    for _ in range(100):
        if wanted(ground(here)):
            return True
        here.tab.wait_for_timeout(50)
    return False


@pytest.mark.parametrize("page", [small_page, swinging], ids=["bodies", "linkages"])
def test_the_picture_follows_the_scheme_also_when_it_changes(opened: Open, page: object) -> None:
    assert callable(page)
    here = opened(page(), color_scheme="dark")
    assert ground(here) < 70.0
    legend = "getComputedStyle(document.getElementById('legend')).backgroundColor"
    dark = here.tab.evaluate(legend)
    here.tab.emulate_media(color_scheme="light")
    assert soon(here, lambda seen: seen > 200.0) and here.tab.evaluate(legend) != dark
    here.tab.emulate_media(color_scheme="dark")
    assert soon(here, lambda seen: seen < 70.0) and here.complaints == []


def test_a_saved_picture_is_light_in_the_dark_and_the_page_stays_dark(opened: Open) -> None:
    here = opened(crowded(), color_scheme="dark")
    spy = """window.sheets = []; const blob = HTMLCanvasElement.prototype.toBlob;
      HTMLCanvasElement.prototype.toBlob = function (...all) {
        window.sheets.push(this.toDataURL()); return blob.apply(this, all); }"""
    here.tab.evaluate(f"() => {{ {spy} }}")
    with here.tab.expect_download():
        here.tab.locator("#png").click()
    sheet = pixels(here.tab.evaluate("window.sheets[0]"))
    assert sheet[5, 5].mean() > 200.0 and sheet[-5, 5].mean() > 250.0
    below = sheet[int(0.7 * len(sheet)) :]
    assert (below.sum(axis=2) < 150).sum() > 500, "names and caption are dark on white"
    here.until("!document.querySelector('.paper')")
    assert ground(here) < 70.0


def test_printing_is_light_and_goes_back(opened: Open) -> None:
    here = opened(swinging(), color_scheme="dark")
    here.tab.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    assert ground(here) > 200.0
    here.tab.evaluate("window.dispatchEvent(new Event('afterprint'))")
    assert ground(here) < 70.0


@pytest.mark.parametrize("page", [small_page, crowded], ids=["bodies", "linkages"])
def test_legend_and_buttons_on_a_phone(opened: Open, page: object) -> None:
    """Type of a size that can be read, every entry inside its card, every button of a view inside its card."""
    assert callable(page)
    here = opened(page(), device=PHONE)
    sizes = drawn_type(here, ".legend text, .corner text, .plot text")
    assert len(sizes) > 6 and min(sizes) >= LEAST_TYPE
    for inside, card in ((".legend text", ".legend"), (".views button", ".tools")):
        box = here.tab.locator(card).bounding_box()
        assert box
        for each in here.tab.locator(inside).all():
            own = each.bounding_box()
            assert own and own["x"] >= box["x"] - 1 and own["x"] + own["width"] <= box["x"] + box["width"] + 1


def test_curves_open_at_their_peak_and_say_nothing_where_nothing_is_known(opened: Open) -> None:
    time = np.linspace(0.0, 1.0, 11)
    force = np.where(time < 0.2, np.nan, np.sin(np.pi * time))
    late = np.where(time < 0.85, np.nan, time)
    panels = [
        Curves("force", "N", [Curve("model", -force), Curve("plate", force)]),
        Curves("late", "N", [Curve("l", late)]),
    ]
    page = Page("a", "", time, "time [s]", sections=panels)
    assert page.opening == 9, "of the frames in which all three are known that of the largest force"
    here = opened(replace(page, start_frame=5))
    values = here.tab.locator(".key .value")
    assert [each.text_content() for each in values.all()] == ["−1", "1", ""], "not –"
    here.tab.keyboard.press("ArrowLeft")
    assert values.nth(2).text_content() == "–", "said of what the reader chose"


def test_a_page_of_many_cards_has_two_columns_beside_its_scene(opened: Open) -> None:
    time, page = np.linspace(0.0, 1.0, 11), swinging()
    cards = [Curves(f"card {k}", "N", [Curve("a", time)]) for k in range(8)]
    here = opened(replace(page, sections=[page.sections[0], *cards]))
    tall = [here.tab.locator(name).bounding_box() for name in (".left", ".panels")]
    assert tall[0] and tall[1] and tall[1]["height"] < 2.2 * tall[0]["height"]
    assert here.tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
