"""What the picture shows, measured: contours, poses, colours, the saved file."""

from __future__ import annotations

import csv
import io
import re
from base64 import b64encode
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from geocontact.view.page.content import Scene, Table
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
    """At print size; brought to the size of the page it is what the page shows."""
    here = opened(small_page())
    with here.tab.expect_download() as download:
        here.tab.locator("#png").click()
    download.value.save_as(tmp_path / "saved.png")
    shown = pixels(here.picture())
    high, wide = shown.shape[:2]
    large = Image.open(tmp_path / "saved.png").convert("RGB")
    small = large.resize((wide, round(large.height * wide / large.width)), Image.Resampling.BOX)
    saved = np.asarray(small).astype(int)
    middle, half = high // 2, wide // 2
    assert np.abs(saved[middle, :half] - shown[middle, :half]).mean() < 4.0
    assert (np.ptp(saved[high:], axis=2) > 80).sum() > 1000, "the colours of the legend are below"
    assert (saved[high + 44 :].max(axis=2) < 80).sum() > 200, "and the words of the caption"
    assert here.complaints == []


def test_the_legend_says_unit_limits_and_threshold(opened: Open) -> None:
    here = opened(small_page())
    marks = here.tab.locator("#legend svg text").all_text_contents()
    assert {"−1", "0", "1", "4", "6", "beyond"} <= set(marks)
    assert here.tab.locator("#legend text.main").all_text_contents() == ["4", "1"]
    assert re.search(r"signed distance \[mm\].*4, 1 mm", here.text("#legend p"))


def test_a_picture_is_saved_at_print_size_and_the_page_stays_as_it_was(opened: Open, tmp_path: Path) -> None:
    here = opened(small_page())
    before = here.tab.evaluate("[canvas.width, canvas.height]")
    with here.tab.expect_download() as download:
        here.tab.locator("#png").click()
    assert download.value.suggested_filename == "area_of_plate_near_ball.png"
    download.value.save_as(tmp_path / "saved.png")
    with Image.open(tmp_path / "saved.png") as saved:
        assert saved.width == 2400
    assert here.tab.evaluate("[canvas.width, canvas.height]") == before


def test_a_table_is_saved_as_csv(opened: Open, tmp_path: Path) -> None:
    """Cells with commas and quotes are quoted, a typographic minus is a plain one."""
    cells = [["a, b", "\u22121.5"], ['say "no"', "2 \u2212 1"]]
    here = opened(replace(small_page(), sections=(Table("Two <b>rows</b>", ("name", "value [mm]"), cells),)))
    with here.tab.expect_download() as download:
        here.tab.get_by_role("button", name="save CSV").click()
    assert download.value.suggested_filename == "two_b_rows_b.csv"
    download.value.save_as(tmp_path / "table.csv")
    text = (tmp_path / "table.csv").read_bytes().decode("utf-8-sig")
    assert list(csv.reader(io.StringIO(text))) == [
        ["name", "value [mm]"],
        ["a, b", "-1.5"],
        ['say "no"', "2 \u2212 1"],
    ]


def test_one_loop_is_saved_as_a_video(opened: Open, tmp_path: Path) -> None:
    """The recording lasts as long as the loop, shows the ball move, and leaves the cursor where it was."""
    here = opened(small_page())
    here.tab.locator("#speed").select_option("3")
    set_range(here, "#slider", 2)
    with here.tab.expect_download(timeout=60_000) as download:
        here.tab.locator("#film").click()
        assert here.tab.locator("#film").is_disabled()
    here.tab.wait_for_function("!document.getElementById('film').disabled")
    file = tmp_path / download.value.suggested_filename
    download.value.save_as(file)
    assert file.suffix in (".webm", ".mp4") and file.stat().st_size > 10_000
    assert here.tab.evaluate("Number(slider.value)") == 2 and here.text("#film") == "save video"
    blank = here.tab.context.new_page()
    data = b64encode(file.read_bytes()).decode("ascii")
    played = blank.evaluate(PLAYED, f"data:video/{file.suffix[1:]};base64,{data}")
    blank.close()
    assert played["width"] % 2 == 0 and played["height"] % 2 == 0
    assert 2.0 < played["seconds"] < 12.0, "3 s where the machine keeps up"
    assert played["changed"] > 0.002, "largest share of the pixels that differ from the beginning"


PLAYED = """async (address) => {
  const video = Object.assign(document.createElement("video"), { muted: true });
  await new Promise((done, failed) => {
    video.onloadeddata = done;
    video.onerror = () => failed(video.error.message);
    video.src = address;
  });
  const at = async (second) => {
    const there = new Promise((done) => (video.onseeked = done));
    video.currentTime = second;
    await there;
    const size = { width: video.videoWidth, height: video.videoHeight };
    const canvas = Object.assign(document.createElement("canvas"), size);
    canvas.getContext("2d").drawImage(video, 0, 0);
    return canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
  };
  const known = new Promise((done) => (video.ondurationchange = () => Number.isFinite(video.duration) && done()));
  if (!Number.isFinite(video.duration)) video.currentTime = 1e6; // it is known once its end was looked for
  if (!Number.isFinite(video.duration)) await known;
  const seconds = video.duration;
  const one = await at(0.05);
  let changed = 0; // of the instant that is farthest from the beginning: where that is depends on the first frame
  for (const part of [0.25, 0.5, 0.75]) {
    const other = await at(part * seconds);
    let count = 0;
    for (let k = 0; k < one.length; k += 4) count += Math.abs(one[k] - other[k]) > 40;
    changed = Math.max(changed, count);
  }
  return { width: video.videoWidth, height: video.videoHeight, seconds, changed: changed / (one.length / 4) };
}"""
