"""What a reader could misread: frame numbers, signs, curves that look alike, axes, marks that run into each other."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from geocontact.view.page.content import Curve, Curves, Page, Scene, Strip, Table
from tests.view.page.conftest import DESKTOP, PHONE, Open, Opened
from tests.view.page.examples import small_page

pytestmark = pytest.mark.slow

TIED = "distance without sign (other body open)"


def scene_of(page: Page) -> Scene:
    scene = page.sections[0]
    assert isinstance(scene, Scene)
    return scene


def with_scene(**change: Any) -> Page:
    page = small_page()
    return replace(page, sections=[replace(scene_of(page), **change), *page.sections[1:]])


def signed(*signs: bool, **change: Any) -> Page:
    bodies = scene_of(small_page()).bodies
    return with_scene(bodies=[replace(b, signed=s) for b, s in zip(bodies, signs, strict=True)], **change)


def one_panel(time: np.ndarray, unit: str, *values: np.ndarray) -> Page:
    curves = [Curve(f"curve {k}", v) for k, v in enumerate(values)]
    return Page("a", "", time, "angle [deg]", sections=[Curves("panel", unit, curves)])


def labels(here: Opened, anchor: str) -> list[tuple[float, float]]:
    """Tick values of an axis ("middle": below, "end": on the left) with their place in pixels."""
    found = here.tab.evaluate(
        "a => [...document.querySelectorAll(`.plot text.tick[text-anchor=${a}]`)]"
        ".map(e => [e.textContent, e.getAttribute(a === 'end' ? 'y' : 'x')])",
        anchor,
    )
    return [(float(text.replace("−", "-")), float(place)) for text, place in found]


def height(here: Opened) -> float:
    """Height of the area between the axes of the first chart [pixels]."""
    return float(here.tab.locator(".plot svg").first.get_attribute("height") or "nan") - 42.0


def test_frames_of_a_part_keep_their_numbers(opened: Open) -> None:
    numbers = np.array([1, 101, 201, 301, 503, 601, 701, 801, 1000])
    # the caption of the saved picture is drawn, not written: what is drawn is noted
    spy = """window.drawn = []; const fill = CanvasRenderingContext2D.prototype.fillText;
      CanvasRenderingContext2D.prototype.fillText = function (text, ...rest) {
        window.drawn.push(text); return fill.call(this, text, ...rest); };"""
    here = opened(replace(small_page(), numbers=numbers, total=1000), before=spy)
    assert here.frame() == 4, "the index of what is shown"
    assert here.text("#now") == "0.5 s · frame 503/1000"
    slider = here.tab.locator("#slider")
    assert slider.get_attribute("aria-valuetext") == "time 0.5 s, frame 503 of 1000"
    with here.tab.expect_download():
        here.tab.locator("#png").click()
    assert any("frame 503 of 1000" in text for text in here.tab.evaluate("window.drawn"))
    slider.press("End")
    assert here.frame() == 8
    assert here.text("#now").endswith("frame 1000/1000")


@pytest.mark.parametrize("signs", [(True, True), (False, True), (True, False), (False, False)])
def test_the_legend_names_bodies_whose_distance_has_no_sign(opened: Open, signs: tuple[bool, bool]) -> None:
    here = opened(signed(*signs))
    words = here.text("#legend p")
    picture = str(here.tab.locator("#legend svg").get_attribute("aria-label"))
    for said in (words, picture):
        for name, has_sign in zip(("plate", "ball"), signs, strict=True):
            assert (f"{name}: {TIED}" in said) != has_sign
        assert ("overlap" in said) == any(signs)
    assert here.tab.locator("#legend rect[fill='url(#hatch)']").count() == int(any(signs))


def test_no_overlap_is_spoken_of_where_no_colour_is_below_zero(opened: Open) -> None:
    here = opened(with_scene(span=(0.0, 6e-3)))
    assert "overlap" not in here.text("#legend p")
    assert "overlap" not in str(here.tab.locator("#legend svg").get_attribute("aria-label"))


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_curves_look_different_also_without_colour(opened: Open, scheme: str) -> None:
    time = np.arange(5.0)
    here = opened(one_panel(time, "N", *(time + k for k in range(16))), color_scheme=scheme)
    for lines in (".plot path.line", ".key path.line"):
        styles = here.tab.evaluate(
            """s => [...document.querySelectorAll(s)].map(e => getComputedStyle(e))
              .map(style => [style.stroke, style.strokeDasharray])""",
            lines,
        )
        assert len(styles) == 16
        assert len({tuple(style) for style in styles}) == 16
        assert len({dash for _, dash in styles[:8]}) == 8, "dashes alone tell eight apart"
    assert len({stroke for stroke, _ in styles}) >= 5


def test_an_axis_that_runs_down_has_ticks_and_a_cursor(opened: Open) -> None:
    angle = np.linspace(90.0, 0.0, 10)
    here = opened(one_panel(angle, "N", angle**2))
    ticks = labels(here, "middle")
    assert {0.0, 20.0, 40.0, 60.0, 80.0} <= {value for value, _ in ticks}
    slope = np.polyfit(*np.transpose(ticks), 1)[0]
    assert slope < 0.0, "the sweep runs from left to right"
    box = here.tab.locator(".plot svg").bounding_box()
    assert box
    here.tab.mouse.click(box["x"] + box["width"] - 13, box["y"] + 50)
    assert here.frame() == 9
    assert float(here.tab.locator("line.cursor").get_attribute("x1") or "nan") == pytest.approx(
        box["width"] - 12, abs=1
    )


def test_times_that_come_back_stay_on_the_axis(opened: Open) -> None:
    angle = np.array([0.0, 45.0, 90.0, 45.0, 0.0])
    ticks = labels(opened(one_panel(angle, "N", angle)), "middle")
    assert max(value for value, _ in ticks) >= 80.0


@pytest.mark.parametrize(
    ("unit", "level", "noise", "span"),
    [
        ("mm", 0.5, 1e-7, 0.1),
        ("mm", 80.0, 1e-3, 0.8),
        ("MPa", 7.0, 1e-4, 0.07),
        ("mm", 0.0, 1e-9, 0.1),
        ("mm", 0.3, 0.0, 0.1),
    ],
)
def test_a_nearly_constant_curve_is_not_blown_up(
    opened: Open, unit: str, level: float, noise: float, span: float
) -> None:
    time = np.arange(20.0)
    here = opened(one_panel(time, unit, level + noise * np.sin(time)))
    ticks = labels(here, "end")
    assert len({value for value, _ in ticks}) >= 3
    slope = abs(np.polyfit(*np.transpose(ticks), 1)[0])  # pixels per unit
    assert height(here) / slope == pytest.approx(1.12 * span, rel=0.07), (
        "1 % of the value, 0.1 mm at least, and some room"
    )


def test_a_curve_that_varies_fills_its_axis(opened: Open) -> None:
    time = np.linspace(0.0, 3.0, 20)
    here = opened(one_panel(time, "mm", 5.0 + np.sin(time)))
    ticks = labels(here, "end")
    slope = abs(np.polyfit(*np.transpose(ticks), 1)[0])
    assert height(here) / slope == pytest.approx(1.12 * np.ptp(np.sin(time)), rel=0.01)


def test_a_strip_of_zeros_has_an_axis(opened: Open) -> None:
    strip = Strip("s", np.array([1.0, 2.0]), np.zeros((2, 2)), "mm²", 1.0)
    here = opened(Page("a", "", np.arange(2.0), "time [s]", sections=[strip]))
    assert len(labels(here, "end")) >= 3


@pytest.mark.parametrize("device", [DESKTOP, PHONE], ids=["1280x800", "390x844"])
@pytest.mark.parametrize(
    ("thresholds", "span"),
    [((1.5e-3,), (-1e-3, 1.5e-3)), ((12.25e-3, 11.5e-3), (-11.25e-3, 12.25e-3)), ((1.25e-3, 1.5e-3), (-6e-3, 4e-3))],
)
def test_marks_of_the_legend_do_not_overlap(
    opened: Open, device: dict[str, Any], thresholds: tuple[float, ...], span: tuple[float, float]
) -> None:
    here = opened(with_scene(thresholds=thresholds, span=span), device=device)
    found = here.tab.evaluate(
        """[document.querySelector('#legend svg'), ...document.querySelectorAll('#legend svg text')]
          .map(e => [e.getBoundingClientRect().left, e.getBoundingClientRect().right, e.textContent])"""
    )
    (left, right, _), *marks = found
    marks.sort()
    assert {"beyond", f"{span[1] * 1e3:g}"} <= {mark[2] for mark in marks}
    for (_, end, a), (start, _, b) in pairwise(marks):
        assert end < start, f"{a} runs into {b}"
    assert left <= marks[0][0]
    assert marks[-1][1] <= right


@pytest.mark.parametrize("device", [DESKTOP, PHONE], ids=["1280x800", "390x844"])
def test_what_takes_the_focus_is_in_sight(opened: Open, device: dict[str, Any]) -> None:
    lower = [(f"fact {k}", "so much") for k in range(8)]  # on a phone the buttons begin behind the timeline
    here = opened(replace(small_page(), facts=lower), device=device)
    here.tab.locator("#more").evaluate("e => e.open = true")
    here.tab.evaluate("document.getElementById('canvas').focus({preventScroll: true}); scrollTo(0, 0)")
    seen = []
    for _ in range(19):  # the player comes first
        here.tab.keyboard.press("Tab")
        here.tab.wait_for_timeout(60)
        name, hidden = here.tab.evaluate(
            """(() => {
              const e = document.activeElement, box = e.getBoundingClientRect();
              const seen = part => document.elementFromPoint(box.x + box.width / 2, box.y + part * box.height);
              const own = other => other && (e.contains(other) || e.closest('label')?.contains(other));
              return [e.closest('#tools') ? e.id || e.textContent.trim() || e.type : '',
                      [0.1, 0.5, 0.9].filter(part => !own(seen(part))).length];
            })()"""
        )
        if name:
            seen.append(name)
            assert hidden == 0, f"{name} has the focus behind something"
    assert {"reset", "png", "cut", "superior (+y)"} <= set(seen)


@pytest.mark.parametrize("device", [DESKTOP, PHONE], ids=["1280x800", "390x844"])
def test_sliders_can_be_hit(opened: Open, device: dict[str, Any]) -> None:
    here = opened(small_page(), device=device)
    here.tab.locator("#more").evaluate("e => e.open = true")
    heights = here.tab.evaluate(
        "[...document.querySelectorAll('input[type=range]')].map(e => e.getBoundingClientRect().height)"
    )
    assert len(heights) == 4
    assert min(heights) >= 24


def test_heads_of_tables_stay_on_one_line_on_a_phone(opened: Open) -> None:
    header = ["body", "role", "file", "unit of the file", "closed", "sha256"]
    row = ["FIXED-insert", "fixed body", "insert.stl", "mm", "no: distances to it are unsigned", "0123456789abcdef" * 4]
    page = small_page()
    here = opened(replace(page, sections=[*page.sections, Table("In", header, [row])]), device=PHONE)
    lines = here.tab.evaluate(
        "[...document.querySelectorAll('.reading th bdi')].map(e => e.getClientRects().length)",
    )
    assert set(lines) == {1}
    cells = here.tab.evaluate(
        "[...document.querySelectorAll('.reading:not(:first-child) td')].map(e => e.getBoundingClientRect().width)"
    )
    assert max(cells) < 390, "a hash is read without scrolling along it"
    assert min(cells) > 20, "and nothing is broken letter by letter"
    assert here.tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth")


@pytest.mark.parametrize("device", [DESKTOP, PHONE], ids=["desktop", "phone"])
def test_a_name_in_the_legend_wraps_before_its_number_does(opened: Open, device: dict[str, Any]) -> None:
    """ "-0.0199" stood above "5" beside a long name in a narrow card."""
    curve = Curve("− penetration of the fixed body by the moving one " * 3, -0.01995 + np.zeros(5))
    here = opened(Page("a", "", np.arange(5.0), "", sections=[Curves("panel", "mm", [curve])]), device=device)
    (value,) = here.tab.evaluate(
        "[...document.querySelectorAll('.key .value')].map(e => { const r = document.createRange();"
        " r.selectNodeContents(e); return [e.textContent, new Set([...r.getClientRects()].map(b => b.top)).size,"
        " e.scrollWidth <= e.clientWidth]; })"
    )
    assert value == ["−0.01995", 1, True]
    assert here.tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
