"""The first screen of a page holds answer, reservations and picture; what does not fit says that it continues."""

from __future__ import annotations

import base64
import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from geocontact.data.motion import Course
from geocontact.view.page.content import (
    Choices,
    Curve,
    Curves,
    IntervalRow,
    Intervals,
    Length,
    Limit,
    Page,
    PageChoice,
    Picture,
    Plan,
    Points,
    Readout,
    Row,
    Scene,
    Shade,
    Table,
    Words,
)
from tests.view.page.conftest import DESKTOP, PHONE, Open, Opened, set_range
from tests.view.page.examples import curves_page, small_page
from tests.view.page.pictures import pixels

pytestmark = pytest.mark.slow

DEVICES = pytest.mark.parametrize("device", [DESKTOP, PHONE], ids=["1280x800", "390x844"])
RESERVATIONS = ("bodies overlap by 3 mm in frame 7", "the fixed body is open", "markers were filled over 0.4 s")
DRAWING = b"""<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 300" width="400" height="300">
<rect width="400" height="300" style="fill: #ffffff"/>
<rect x="100" y="100" width="200" height="100" style="fill: #0072b2"/>
</svg>"""
FOLDED = Table("How it was made", ("option", "value"), [("numpy", "2.0")], folded=True)


def angles(*sections: Any, **more: Any) -> Page:
    """A page of curves over angles, which is no time."""
    angle = np.linspace(0.0, 90.0, 10)
    curves = Curves("Force", "N", [Curve("force", angle / 10.0)])
    numbers = Readout([Row("force", "N", [f"{a:.1f}" for a in angle / 10.0])], "At this angle")
    return Page("a", "b", angle, "angle [deg]", sections=[curves, numbers, *sections], plays=False, **more)


def inside(here: Opened, selector: str, part: float = 1.0) -> bool:
    """Whether so much of the height of an element is on the first screen."""
    box = here.tab.locator(selector).first.bounding_box()
    high = here.tab.evaluate("window.innerHeight")
    return box is not None and box["y"] >= 0 and box["y"] + part * box["height"] <= high


@DEVICES
@pytest.mark.parametrize("lines", [0, 2, 3])
def test_answer_reservations_and_picture_are_on_the_first_screen(
    opened: Open, device: dict[str, Any], lines: int
) -> None:
    here = opened(replace(small_page(), reservations=RESERVATIONS[:lines]), device=device)
    assert here.text(".answer").replace("\u00a0", " ") == small_page().headline[0]
    assert inside(here, ".answer") and inside(here, ".facts")
    assert inside(here, "#view", 0.6), "most of the picture"
    assert here.tab.locator(".banner").count() == (lines > 0)
    if lines:
        assert inside(here, ".banner") and RESERVATIONS[0] in here.text(".banner")
    if lines == 3:
        assert not here.tab.get_by_text(RESERVATIONS[2]).is_visible()
        here.tab.locator(".banner summary").click()
        assert here.tab.get_by_text(RESERVATIONS[2]).is_visible()
    assert here.tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    assert here.complaints == []


@DEVICES
def test_without_a_scene_the_first_curves_or_drawing_stand_on_the_first_screen(
    opened: Open, device: dict[str, Any]
) -> None:
    words = Words("first", ["read me"])
    for page, lead in (
        (curves_page(), "#section-1"),
        (replace(curves_page(), sections=[words, Picture("Figure", "", DRAWING)]), "#section-1"),
    ):
        here = opened(page, device=device)
        assert here.tab.locator(f"{lead}.lead").count() == 1
        assert inside(here, lead, 0.5)


def test_a_player_is_there_only_where_something_runs(opened: Open) -> None:
    assert opened(small_page()).tab.locator("#play").is_visible()
    assert opened(curves_page()).tab.locator("#play").is_visible()
    here = opened(angles())
    assert here.tab.locator("#play, #slider").count() == 0
    box = here.tab.locator("#section-0 .plot svg").bounding_box()
    assert box
    here.tab.mouse.move(box["x"] + box["width"] - 13, box["y"] + 40)
    assert here.frame() == 9, "a curve is read by pointing at it"
    assert here.text(".readout h2") == "At this angle: 90 deg" and here.text("td.value") == "9.0"
    here.tab.keyboard.press("ArrowLeft")
    assert here.frame() == 8
    here.tab.keyboard.press("Space")
    assert here.complaints == []


def test_a_card_without_numbers_is_not_drawn(opened: Open) -> None:
    here = opened(replace(angles(), sections=[angles().sections[0], Readout([])]))
    assert here.tab.locator(".readout").count() == 0
    assert here.complaints == []


def test_versions_and_hashes_are_folded(opened: Open) -> None:
    here = opened(angles(FOLDED))
    assert not here.tab.get_by_text("numpy").is_visible()
    here.tab.locator("details.fold summary").click()
    assert here.tab.get_by_text("numpy").is_visible()


def test_tables_and_drawings_that_continue_say_so(opened: Open) -> None:
    wide = Table("Wide", [f"column {k}" for k in range(12)], [["1.2345"] * 12])
    tall = Table("Tall", ["a"], [["1"]] * 100)
    page = angles(wide, tall, Table("Small", ["a"], [["1"]]), Picture("Figure", "", DRAWING, wide=True))
    here = opened(page, device=PHONE)
    script = """Object.fromEntries([...document.querySelectorAll('.hint')].map(e =>
      [e.parentElement.querySelector('h2').textContent, e.hidden ? '' : e.textContent]))"""
    hints = here.tab.evaluate(script)
    assert "sideways" in hints["Wide"] and "sideways" in hints["Figure"]
    assert "down" in hints["Tall"] and hints["Small"] == ""
    assert here.tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth")
    room = here.tab.locator("#section-2 .wide")
    assert "beyond" in str(room.get_attribute("class"))
    room.evaluate("e => { e.scrollLeft = 9999; }")
    here.until("!document.querySelector('#section-2 .wide').classList.contains('beyond')")


def test_charts_are_drawn_anew_at_the_width_of_a_phone(opened: Open) -> None:
    here = opened(small_page())
    here.tab.set_viewport_size({"width": 390, "height": 844})
    for plot in ("#section-2 .plot svg", "#section-6 .plot svg"):
        here.until(f"document.querySelector('{plot}').getAttribute('viewBox').split(' ')[2] < 390")
        sizes = here.tab.evaluate(
            f"[...document.querySelectorAll('{plot} text')].map(e => e.getBoundingClientRect().height)"
        )
        assert min(sizes) > 9, "letters keep their size"


def test_names_of_rows_are_whole_on_a_phone_and_beside_a_scene(opened: Open) -> None:
    long = "motion_offset.thigh_normal + dry_friction.stroke.thigh, of the offset along the upper arm"
    rows = [IntervalRow(long, 1.0, 0.5, 1.5), IntervalRow("short", 2.0, 1.5, 2.5)]
    here = opened(angles(Intervals("Rows", "N", rows)), device=PHONE)
    beyond = """[...document.querySelectorAll('#section-2 text')].filter(e => {
      const [own, all] = [e, e.closest('svg')].map(x => x.getBoundingClientRect());
      return own.left < all.left || own.right > all.right; }).length"""
    for width in (390, 1280):
        here.tab.set_viewport_size({"width": width, "height": 844})
        here.until(f"document.querySelector('#section-2 svg').getAttribute('viewBox').split(' ')[2] <= {width}")
        assert here.tab.evaluate(beyond) == 0
        assert here.tab.locator("#section-2 text.label").count() > 2, "in several lines"


def test_drawings_follow_dark_mode_and_colour_scales_stay(opened: Open) -> None:
    scale = b"".join(b'<path style="fill: #%06x"/>' % (1000 * k) for k in range(20))
    page = angles(Picture("Lines", "", DRAWING), Picture("Scale", "", DRAWING.replace(b"</svg>", scale + b"</svg>")))
    here = opened(page, color_scheme="dark")
    shown = []
    for name in ("#section-2", "#section-3"):
        picture = here.tab.locator(f"{name} img").screenshot()
        shot = pixels("x," + base64.b64encode(picture).decode())
        shown.append((shot[6, 6], shot[shot.shape[0] // 2, shot.shape[1] // 2]))
    (ground, blue), (own, same) = shown
    assert ground.max() < 45 and own.max() < 45, "no white slab"
    assert blue[2] > blue[0] and blue.sum() > 240, "still blue, and lighter than on white"
    assert list(same) == [0, 0x72, 0xB2]


def test_marks_and_limits_stand_in_the_curves(opened: Open) -> None:
    time = np.linspace(0.0, 1.0, 5)
    points = Points("measured", np.array([0.25, 1.5]), np.array([2.0, 9.0]))
    curves = Curves("F", "N", [Curve("f", time)], [points], [Limit("limit 5 N", 5.0)])
    here = opened(Page("a", "", time, "time [s]", sections=[curves]))
    assert here.tab.locator(".plot .mark").count() == 2
    assert here.tab.locator(".plot text.limit").text_content() == "limit 5 N"
    box, plot = (here.tab.locator(s).last.bounding_box() for s in (".plot .mark", ".plot svg"))
    assert box and plot
    assert plot["x"] < box["x"] and box["x"] + box["width"] <= plot["x"] + plot["width"], "the axis holds all marks"


def test_a_panel_with_an_axis_of_its_own_is_read_there_alone(opened: Open) -> None:
    time = np.linspace(0.0, 1.0, 5)
    cycle = Course("cycle", "%", np.linspace(0.0, 100.0, 101))
    own = Curves(
        "M",
        "N m",
        [Curve("mean", cycle.values), Curve("one", 1.0 + 0.9 * cycle.values, thin=True)],
        over=cycle,
        log=True,
    )
    timed = Curves("F", "N", [Curve("f", time)], spans=[Shade("work", 0.25, 0.5), Shade("now", 0.75, 0.75)])
    here = opened(Page("a", "", time, "time [s]", sections=[timed, own]))
    plot = here.tab.locator("#section-1 .plot svg")
    plot.scroll_into_view_if_needed()
    assert here.text("#section-1 .value") == "100", "it opens where the first curve is farthest from zero"
    box = plot.bounding_box()
    assert box
    here.tab.mouse.click(box["x"] + box["width"] / 2, box["y"] + 20)
    assert 40.0 < float(here.text("#section-1 .value")) < 60.0
    assert here.frame() == 4, "the page's time stays where the page opened: at the peak of its first curve"
    assert here.tab.locator("#section-1 .key li").count() == 1, "thin curves have no name"
    ticks = here.tab.locator("#section-1 .tick[text-anchor=end]").all_text_contents()
    assert ticks == ["1", "10", "100"], "whole decades"
    assert here.tab.locator("#section-0 .plot .span, #section-0 .plot .edge").count() == 2
    assert here.tab.locator("#section-0 .key").text_content().endswith("worknow")  # type: ignore[union-attr]


def test_one_of_many_curves_is_picked_by_its_name(opened: Open) -> None:
    """Sixteen markers in one plot: pointing at a name, or pressing it, lets that curve stand out."""
    time = np.linspace(0.0, 1.0, 9)
    many = Curves("Error", "mm", [Curve(f"marker {k}", k + time) for k in range(16)])
    few = Curves("F", "N", [Curve("f", time), Curve("g", -time)])
    here = opened(Page("a", "", time, "time [s]", sections=[many, few]))
    clear = here.tab.locator("#section-0 .plot .line:not(.back)")
    entry = here.tab.locator("#section-0 .key li").nth(3)
    assert clear.count() == 16
    entry.hover()
    assert clear.count() == 1
    here.tab.mouse.move(1, 1)
    assert clear.count() == 16
    entry.press("Enter")
    assert clear.count() == 1 and entry.get_attribute("aria-pressed") == "true"
    before = here.frame()
    entry.press("Space")
    assert clear.count() == 16 and here.frame() == before, "the space bar plays where no name has the focus"
    assert here.tab.locator("#section-1 [role=button]").count() == 0, "two curves need no choice"
    assert here.complaints == []


def test_a_picture_is_as_wide_as_its_card(opened: Open) -> None:
    svg = b'<svg xmlns="http://www.w3.org/2000/svg" width="100pt" height="400pt" viewBox="0 0 100 400"></svg>'
    here = opened(Page("a", "", np.zeros(1), "", sections=[Picture("Tall", "words", svg, wide=True)]))
    card, image = (here.tab.locator(s).bounding_box() for s in ("#section-0", "#section-0 img"))
    assert card and image
    assert image["width"] > 0.95 * card["width"], "a cap of its height makes a strip of it"


def test_a_plan_has_one_scale(opened: Open) -> None:
    here = opened(small_page())
    script = """a => [...document.querySelectorAll(`#section-6 .plot text.tick[text-anchor=${a}]`)]
      .map(e => [e.textContent.replace('−', '-'), e.getAttribute(a === 'end' ? 'y' : 'x')].map(Number))"""
    across, up = (here.tab.evaluate(script, anchor) for anchor in ("middle", "end"))
    scale = [np.polyfit(*np.transpose(each), 1)[0] for each in (across, up)]
    assert scale[0] == pytest.approx(-scale[1], rel=1e-3)
    before = here.tab.locator("#section-6 circle.dot").get_attribute("cy")
    here.tab.keyboard.press("ArrowRight")
    assert here.tab.locator("#section-6 circle.dot").get_attribute("cy") != before


@DEVICES
@pytest.mark.parametrize("bars", [False, True])
def test_intervals_lie_where_their_axis_says(opened: Open, device: dict[str, Any], bars: bool) -> None:
    rows = [
        IntervalRow("E*, total", 6.8, 6.2, 7.6),
        IntervalRow("E*, medial", 5.0),
        IntervalRow("missing", float("nan")),
    ]
    page = Page("a", "", np.zeros(1), "", sections=[Intervals("Modulus", "MPa", rows, bars, "95 %")])
    here = opened(page, device=device)
    plot = "#section-0 .plot"
    script = "p => [...document.querySelectorAll(p)].map(e => [e.textContent, e.getAttribute('x')].map(Number))"
    ticks = here.tab.evaluate(script, f"{plot} text.tick")
    slope, start = np.polyfit(*np.transpose(ticks), 1)
    drawn = str(here.tab.locator(f"{plot} .whisker").get_attribute("d"))
    ends = [(float(x) - start) / slope for x in re.findall(r"M([\d.]+) ", drawn)]
    assert [min(ends), max(ends)] == pytest.approx([6.2, 7.6], abs=0.02)
    assert here.tab.locator(f"{plot} .whisker").count() == 1, "what has no interval has no whiskers"
    assert here.tab.locator(f"{plot} rect.bar").count() == 2 * bars
    assert here.tab.locator(f"{plot} circle").count() == 2 * (not bars)
    assert (0.0 in [value for value, _ in ticks]) or not bars, "bars start at nothing"
    wide = here.tab.locator(f"{plot} svg").bounding_box()
    assert wide
    for label in here.tab.locator(f"{plot} text.label").all():
        box = label.bounding_box()
        assert box and wide["x"] <= box["x"] and box["x"] + box["width"] <= wide["x"] + wide["width"]
    assert here.complaints == []


def test_numbers_of_two_kinds_have_two_colours_and_a_key(opened: Open) -> None:
    rows = [IntervalRow("x", 0.5, kind="total"), IntervalRow("x", 0.3, kind="first-order")]
    here = opened(Page("a", "", np.zeros(1), "", sections=[Intervals("Shares", "share", rows, bars=True)]))
    fills = "[...document.querySelectorAll('#section-0 .plot rect.bar')].map(e => getComputedStyle(e).fill)"
    assert len(set(here.tab.evaluate(fills))) == 2
    assert here.tab.locator("#section-0 .key li").all_inner_texts() == ["total", "first-order"]
    assert here.tab.locator("#section-0 .plot text.label").all_text_contents() == ["x"], "named once"


def test_one_thing_has_one_colour_in_all_panels(opened: Open) -> None:
    values = np.linspace(0.0, 1.0, 5)
    both = Curves("force", "N", [Curve("measured", values), Curve("base", 2.0 * values, stroke=1)])
    page = Page("a", "", values, "", sections=[both, Curves("off", "N", [Curve("base", values, stroke=1)])])
    script = "s => [...document.querySelectorAll(s + ' .plot path.line')].map(e => getComputedStyle(e).stroke)"
    here = opened(page)
    (_, base), (off,) = (here.tab.evaluate(script, f"#section-{k}") for k in range(2))
    assert base == off


@DEVICES
def test_a_length_is_drawn_to_scale_with_its_interval_in_the_key(opened: Open, device: dict[str, Any]) -> None:
    told = Length("x", "30 mm (95 % 28 … 32)", (0.0, 0.0), (30.0, 40.0))
    page = Page("a", "", np.zeros(1), "", sections=[Plan("Arm", "mm", "x", "y", lengths=[told])])
    here = opened(page, device=device)
    drawn = str(here.tab.locator("#section-0 .plot path.line").get_attribute("d"))
    x1, y1, x2, y2 = (float(v) for v in re.findall(r"-?[\d.]+", drawn)[:4])
    assert (x2 - x1) / (y1 - y2) == pytest.approx(0.75)
    assert here.tab.locator("#section-0 .plot text.length").text_content() == "x"
    assert "28 … 32" in here.tab.locator("#section-0 .key").inner_text()


def test_a_narrow_drawing_fits_a_phone(opened: Open) -> None:
    here = opened(Page("a", "", np.zeros(1), "", sections=[Picture("Map", "", DRAWING)]), device=PHONE)
    box = here.tab.locator("#section-0 img").bounding_box()
    assert box and 250 < box["width"] <= 390


def test_another_threshold_changes_answer_numbers_curves_and_contour(opened: Open) -> None:
    page = small_page()
    scene, numbers = page.sections[:2]
    assert isinstance(scene, Scene) and isinstance(numbers, Readout)
    instead = {
        1: Readout([Row("area within 1 mm", "mm²", ["7"] * 9)], "This frame, 1 mm"),
        5: Words("Of 1 mm", ["less"]),
    }
    other = PageChoice("1 mm", ["Little."], [("largest area", "7 mm²")], instead, 1e-3)
    here = opened(replace(page, choices=Choices("threshold", "4 mm", [other])))
    before = here.picture()
    assert here.tab.locator("#legend text.main").first.text_content() == "4"
    here.tab.locator("#choice").select_option("1")
    assert here.tab.locator(".answer:visible").all_text_contents() == ["Little."]
    assert here.tab.locator(".readout:visible th").all_text_contents() == ["area within 1 mm"]
    assert here.tab.locator("#legend text.main").first.text_content() == "1"
    assert here.picture() != before, "the other contour is bold"
    assert here.tab.get_by_text("less").is_visible() and not here.tab.get_by_text("What this is").is_visible()
    assert "chosen: 1 mm" in here.text("#section-3 .chosen")
    here.tab.locator("#choice").select_option("0")
    assert here.picture() == before
    assert here.complaints == []


def test_a_lost_picture_comes_back(opened: Open) -> None:
    here = opened(small_page())
    before = here.picture()
    here.tab.evaluate(
        "window.lost = document.getElementById('canvas').getContext('webgl2').getExtension('WEBGL_lose_context')"
    )
    here.tab.evaluate("window.lost.loseContext()")
    here.until("!document.getElementById('notice').hidden")
    assert "lost" in here.text("#notice")
    here.tab.locator("#slider").press("End")
    assert here.frame() == 8
    here.tab.locator("#slider").press("Home")
    here.tab.wait_for_timeout(100)
    here.tab.evaluate("window.lost.restoreContext()")
    here.until("document.getElementById('notice').hidden")
    set_range(here, "#slider", 4)
    after = pixels(here.picture())
    assert np.abs(after - pixels(before)).mean() < 1.0, "the same picture as before"


@DEVICES
def test_the_player_covers_neither_buttons_nor_tiles(opened: Open, device: dict[str, Any]) -> None:
    """It stands between legend and tools, and sticks to the window where that place is not seen."""
    here = opened(small_page(), device=device)
    here.tab.locator("#tools").scroll_into_view_if_needed()
    here.tab.evaluate("window.scrollTo(0, document.querySelector('#tools').offsetTop - 400)")
    place = {
        name: here.tab.locator(f"#{name}").bounding_box() or {"y": np.nan, "height": np.nan}
        for name in ("legend", "timeline", "tools")
    }
    assert place["legend"]["y"] + place["legend"]["height"] <= place["timeline"]["y"] + 1
    assert place["timeline"]["y"] + place["timeline"]["height"] <= place["tools"]["y"] + 1
    wide = here.tab.evaluate("window.innerWidth")
    for tile in here.tab.locator(".facts div").all():
        box = tile.bounding_box()
        assert box is not None and box["x"] >= 0 and box["x"] + box["width"] <= wide
    here.tab.evaluate("window.scrollTo(0, document.querySelector('.panels .panel:last-child').offsetTop - 200)")
    shown = here.tab.locator("#timeline").bounding_box()
    assert (
        shown is not None and shown["y"] > -1 and shown["y"] + shown["height"] <= here.tab.evaluate("innerHeight") + 1
    )
