"""Every control does what it says, by mouse and by keyboard."""

from __future__ import annotations

import pytest

from geocontact.view.page.content import Readout, Strip
from tests.view.page.conftest import Open, set_range
from tests.view.page.examples import small_page


def test_slider_moves_picture_and_numbers(opened: Open) -> None:
    page = small_page()
    rows = next(section for section in page.sections if isinstance(section, Readout)).rows
    here = opened(page)
    slider = here.tab.locator("#slider")
    pictures = {here.frame(): here.picture()}

    def check(frame: int) -> None:
        assert here.frame() == frame
        assert here.tab.locator("td.value").all_text_contents() == [row.texts[frame].replace("-", "−") for row in rows]
        assert f"frame {frame + 1}/9" in here.text("#now")
        pictures[frame] = here.picture()

    check(4)
    slider.focus()
    for key, frame in [("ArrowRight", 5), ("ArrowUp", 6), ("ArrowLeft", 5), ("End", 8), ("Home", 0)]:
        here.tab.keyboard.press(key)
        check(frame)
    box = slider.bounding_box()
    assert box
    here.tab.mouse.click(box["x"] + 0.75 * box["width"], box["y"] + box["height"] / 2)
    check(6)
    here.tab.mouse.down()
    here.tab.mouse.move(box["x"] + 0.25 * box["width"], box["y"] + box["height"] / 2, steps=4)
    here.tab.mouse.up()
    check(2)
    assert len(set(pictures.values())) == len(pictures), "every frame has a picture of its own"
    assert slider.get_attribute("aria-valuetext") == "time 0.25 s, frame 3 of 9"


def test_play_runs_and_pauses(opened: Open) -> None:
    here = opened(small_page(), reduced_motion="reduce")
    assert here.frame() == 4
    here.tab.wait_for_timeout(300)
    assert here.frame() == 4, "nothing moves unasked"
    here.tab.locator("#speed").select_option("3")
    here.tab.locator("#play").click()
    here.until("window.__geocontact.frame !== 4")
    assert here.tab.locator("#play").get_attribute("aria-label") == "Pause"
    here.tab.keyboard.press("Space")  # the button has the focus and is pressed
    stopped = here.frame()
    here.tab.wait_for_timeout(700)
    assert here.frame() == stopped
    assert here.tab.locator("#play").get_attribute("aria-label") == "Play"
    here.tab.locator("#forth").click()
    assert here.frame() == min(stopped + 1, 8)
    for taken_over in (lambda: set_range(here, "#slider", 5), lambda: here.tab.locator("#section-2 .plot svg").click()):
        here.tab.locator("#play").click()
        taken_over()
        assert here.tab.locator("#play").get_attribute("aria-label") == "Play", "the reader's hand goes first"
    here.tab.locator("#back").click()
    here.until("document.getElementById('said').textContent.includes('frame')")


def test_keys_play_step_and_look(opened: Open) -> None:
    here = opened(small_page())
    start = here.picture()
    for key, frame in [("ArrowRight", 5), ("ArrowLeft", 4)]:
        here.tab.keyboard.press(key)
        assert here.frame() == frame
    seen = {start}
    for key in ("1", "2", "3", "Shift+ArrowLeft", "Shift+ArrowDown", "+", "-"):
        here.tab.keyboard.press(key)
        seen.add(here.picture())
    assert len(seen) >= 7
    here.tab.keyboard.press("r")
    assert here.picture() == start
    here.tab.keyboard.press("Space")
    here.until("window.__geocontact.frame !== 4")
    here.tab.keyboard.press("Space")


def test_curves_move_the_cursor(opened: Open) -> None:
    here = opened(small_page())
    plot = here.tab.locator("#section-2 .plot svg")
    box = plot.bounding_box()
    assert box
    before = here.picture()
    here.tab.mouse.click(box["x"] + box["width"] - 14, box["y"] + box["height"] / 2)
    assert here.frame() == 8
    assert here.picture() != before
    strip = [here.tab.locator("#section-3 path.line").get_attribute("d")]
    here.tab.mouse.click(box["x"] + box["width"] / 2, box["y"] + 20)
    strip.append(here.tab.locator("#section-3 path.line").get_attribute("d"))
    assert len(set(strip)) == 2
    cursor = float(here.tab.locator("#section-2 line.cursor").get_attribute("x1") or "nan")
    assert cursor == pytest.approx(box["width"] / 2, abs=box["width"] / 16), "the cursor comes to the pointer"
    area = next(section for section in small_page().sections if isinstance(section, Strip)).values
    assert float(here.text("#section-3 .value").split()[0]) == pytest.approx(area[here.frame(), -1], rel=1e-3)


def test_a_missing_value_is_a_gap(opened: Open) -> None:
    here = opened(small_page())
    lines = [here.tab.locator(f"#section-2 path.line.c{k}").last.get_attribute("d") or "" for k in (0, 1)]
    assert [line.count("M") for line in lines] == [1, 2]
    assert here.tab.locator("#section-2 li bdi").all_text_contents() == ["within 4 mm", "within 2 mm"]
    set_range(here, "#slider", 3)
    assert here.text("#section-2 li:nth-child(2) .value") == "–"


def test_bodies_and_section_change_the_picture(opened: Open) -> None:
    here = opened(small_page())
    start = here.picture()
    seen = [start]
    box = here.tab.locator("[data-show='1']")
    box.uncheck()
    seen.append(here.picture())
    box.check()
    assert here.picture() == start
    set_range(here, "[data-opacity='1']", 1.0)
    seen.append(here.picture())
    assert here.tab.locator("#cut-at").is_disabled()
    here.tab.locator("#cut").select_option("2")
    seen.append(here.picture())
    set_range(here, "#cut-at", 0.7)
    seen.append(here.picture())
    here.tab.locator("#cut-flip").click()
    seen.append(here.picture())
    assert len(set(seen)) == len(seen)
    here.tab.locator("#cut").select_option("")
    assert here.picture() == seen[2]


def test_the_picture_is_turned_by_dragging(opened: Open) -> None:
    here = opened(small_page())
    start = here.picture()
    box = here.tab.locator("#canvas").bounding_box()
    assert box
    here.tab.mouse.move(box["x"] + 200, box["y"] + 200)
    here.tab.mouse.down()
    here.tab.mouse.move(box["x"] + 300, box["y"] + 220, steps=4)
    here.tab.mouse.up()
    assert here.picture() != start
    here.tab.locator("#reset").click()
    assert here.picture() == start


def test_everything_that_can_be_worked_has_a_name_and_a_focus_ring(opened: Open) -> None:
    here = opened(small_page())
    nameless = here.tab.evaluate(
        """[...document.querySelectorAll('button, input, select, canvas, svg[role=img], [role=group]')]
          .filter(e => !(e.textContent.trim() || e.getAttribute('aria-label') || e.labels?.length))
          .map(e => e.outerHTML)"""
    )
    assert nameless == []
    ids = here.tab.evaluate("[...document.querySelectorAll('[id]')].map(e => e.id)")
    assert len(ids) == len(set(ids))
    here.tab.keyboard.press("Tab")
    focused = here.tab.evaluate("[document.activeElement.id, getComputedStyle(document.activeElement).outlineStyle]")
    assert focused == ["canvas", "solid"]
