"""What the picture shows, measured: contours, poses, colours, the saved file."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest

from geocontact.view.page.content import Scene
from tests.view.page.conftest import Open, set_range
from tests.view.page.examples import small_page
from tests.view.page.pictures import dark_runs, pixels


def test_contour_lies_where_the_closed_form_says(opened: Open) -> None:
    page = small_page()
    scene = page.sections[0]
    assert isinstance(scene, Scene)
    here = opened(page)
    here.tab.get_by_role("button", name="superior").click()
    here.tab.get_by_label("ball", exact=True).uncheck()
    bar = here.tab.locator("#scale i").bounding_box()
    assert bar
    size = float(here.text("#scale span").split()[0]) / bar["width"]
    for frame in (1, 4, 7):
        set_range(here, "#slider", frame)
        picture = pixels(here.picture())
        poses = scene.bodies[1].poses
        assert poses is not None
        height = poses[frame].translation[1]
        runs = dark_runs(picture[:, picture.shape[1] // 2 - 1])  # through x: anterior is up, the ball rolls along it
        expected = 2e3 * np.sqrt((0.02 + scene.threshold) ** 2 - height**2)
        assert size * (runs[-1] - runs[0]) == pytest.approx(expected, abs=0.35)


def test_bodies_stand_where_their_poses_say(opened: Open) -> None:
    here = opened(small_page())
    here.tab.get_by_role("button", name="medial").click()
    here.tab.get_by_label("plate", exact=True).uncheck()
    set_range(here, "[data-opacity='1']", 1.0)
    bar = here.tab.locator("#scale i").bounding_box()
    assert bar
    size = float(here.text("#scale span").split()[0]) / bar["width"]
    centres = []
    for frame in (0, 4, 8):
        set_range(here, "#slider", frame)
        picture = pixels(here.picture())
        rows, columns = np.nonzero(np.abs(picture - picture[5, 5]).sum(axis=2) > 6)
        centres.append(0.5 * np.array([rows.min() + rows.max(), columns.min() + columns.max()]) * size)
    down, left = np.diff(centres, axis=0).T
    assert left == pytest.approx([-10.0, -10.0], abs=0.3), "seen from medial, anterior is left"
    assert down == pytest.approx([2.0, -2.0], abs=0.3), "the ball dips by 2 mm and rises again"


def test_overlap_contact_and_beyond_have_their_colours(opened: Open) -> None:
    here = opened(small_page())
    here.tab.get_by_role("button", name="superior").click()
    here.tab.get_by_label("ball", exact=True).uncheck()
    seen = pixels(here.picture())
    red, green, blue = seen[seen.shape[0] // 2, seen.shape[1] // 2]
    assert red > 2 * max(green, blue), "the ball dips into the middle: red, not the yellow of touch"
    middle = seen[seen.shape[0] // 2 - 8 : seen.shape[0] // 2 + 8, seen.shape[1] // 2 - 8 : seen.shape[1] // 2 + 8, 0]
    assert np.ptp(middle) > 40, "hatched, for eyes that do not tell red from green"
    side = seen[seen.shape[0] // 2, int(seen.shape[1] * 0.5 + seen.shape[0] * 0.42)]
    assert np.ptp(side) < 20, "grey beyond what was asked"


def test_the_picture_can_be_saved(opened: Open, tmp_path: Path) -> None:
    from PIL import Image

    here = opened(small_page())
    with here.tab.expect_download() as download:
        here.tab.locator("#png").click()
    download.value.save_as(tmp_path / "saved.png")
    saved = np.asarray(Image.open(tmp_path / "saved.png").convert("RGB")).astype(int)
    shown = pixels(here.picture())
    high = shown.shape[0]
    assert saved.shape[1] == shown.shape[1]
    assert np.array_equal(saved[high // 2, : shown.shape[1] // 2], shown[high // 2, : shown.shape[1] // 2])
    assert (np.ptp(saved[high:], axis=2) > 80).sum() > 1000, "the colours of the legend are below"
    assert (saved[high + 44 :].max(axis=2) < 80).sum() > 200, "and the words of the caption"
    assert here.complaints == []


def test_the_legend_says_unit_limits_and_threshold(opened: Open) -> None:
    here = opened(small_page())
    marks = here.tab.locator("#legend svg text").all_text_contents()
    assert {"−1", "0", "1", "4", "6", "beyond"} <= set(marks)
    assert here.tab.locator("#legend text.main").all_text_contents() == ["4", "1"]
    assert re.search(r"signed distance \[mm\].*4, 1 mm", here.text("#legend p"))
