"""The threshold on the 3-D picture of a form: areas are those of the command, coloured is what is within."""

from __future__ import annotations

import asyncio
import csv
import json
import re
import warnings
from base64 import b64decode
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from nicegui import Client, run
from nicegui.page import page

import geocontact as gc
from geocontact.analyses.frame.file_content import Content
from geocontact.app import within
from geocontact.app.faces import Found
from geocontact.app.fields import Form, fields_of
from geocontact.app.file_view import FileView
from geocontact.app.files import contents, known_file
from geocontact.app.form_view import FormView
from geocontact.app.picture import chooser
from geocontact.app.samples import sample
from geocontact.app.threshold_view import ThresholdView, threshold_of
from geocontact.cli.demo import sample_folder
from tests.app.conftest import Window
from tests.app.test_surface_view import marked_pixels
from tests.app.test_window import COMMANDS, run_words, until
from tests.browsers import awaited

if TYPE_CHECKING:
    from playwright.sync_api import Page

AREAS = re.compile(r"(area_\w+) ([\d.]+) mm\^2")
DIGIT = 0.00501  # mm^2; areas are shown with two digits


def asked(form: Form, folder: Path, unit: str = "mm") -> dict[str, Any]:
    return within.answer({"command": form.command, "filled": form.kept(), "unit": unit, "folder": str(folder)})


def rows_of(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def agrees(line: str, row: Mapping[str, Any]) -> None:
    """All areas of a line are those of a row of area.csv, and it has those of each side."""
    shown = {name: float(area) for name, area in AREAS.findall(line)}
    asked_for = {f"{name} [mm^2]" for name in shown}
    assert asked_for == {each for each in row if re.fullmatch(r"area_(fixed|moving)(_medial|_lateral)? .mm.2.", each)}
    for name, area in shown.items():
        assert area == pytest.approx(float(row[f"{name} [mm^2]"]), abs=DIGIT), name


def test_areas_are_those_of_the_command_in_its_first_frame(tmp_path: Path) -> None:
    """Thresholds from 0 to beyond the slider, distances measured once; with sides and a region."""
    form = Form.of_words(sample("area", tmp_path).words)
    motion = tmp_path / "two.csv"
    lines = (sample_folder() / "forms" / "gait_11.csv").read_text("utf-8").splitlines()
    motion.write_text("\n".join(lines[:3]) + "\n", encoding="utf-8")
    form.values |= {"threshold": "4,0,0.3,2.5,25", "region": "ny>0.1", "motion": str(motion)}
    found = asked(form, tmp_path)
    files = [sample_folder() / f"{name}_right_coarse.stl" for name in ("femoral_component", "tibial_insert")]
    options = {"unit": "mm", "motion": motion, "split": "z", "side": "right", "region": "ny>0.1"}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)  # 25 mm is unusual, bounds within 0 stay apart
        table = gc.area(*files, threshold=gc.mm(4, 0, 0.3, 2.5, 25), **options).table()
    lines = found["said"].splitlines()
    assert [line.split(":")[0] for line in lines] == [f"within {each} mm" for each in ("4", "0", "0.3", "2.5", "25")]
    for line, row in zip(lines, table.head(5).to_dict("records"), strict=True):
        agrees(line, row)
    assert found["about"].startswith("frame 1 of 2, 0 s: femoral_component_right_coarse.stl (moving) on tibial_insert_")
    form.values |= {"threshold": "0.3"}
    again = asked(form, tmp_path)  # refined farther than beside 0
    agrees(again["said"], gc.area(*files, threshold=gc.mm(0.3), **options).table().to_dict("records")[0])
    assert Path(again["page"]).parent == tmp_path


def test_areas_of_pairs_are_those_of_each_pair(tmp_path: Path) -> None:
    form = Form.of_words(sample("pairs", tmp_path).words)
    form.values |= {"threshold": "1.5"}
    found = asked(form, tmp_path, "cm")
    result = gc.area_pairs(sample_folder() / "knee_pairs.toml", threshold=gc.mm(1.5), rule="clip")
    result.write(tmp_path / "out")
    lines = found["said"].splitlines()
    for name, line in zip(("medial", "lateral", "patellofemoral"), lines, strict=True):
        assert line.startswith(f"{name} within 0.15 cm: ")
        agrees(line, rows_of(tmp_path / "out" / name / "area.csv")[0])
    assert len(found["marked"]["within"]) == 3  # femoral component, insert, patella


def test_levels_are_distances_against_a_box_in_closed_form(tmp_path: Path) -> None:
    """A ball in a plate as both are stored: within is where the distance to the box is not above the threshold."""
    names = ("sphere_r20", "plate_80x80x12")
    files = [sample_folder() / f"{name}.stl" for name in names]
    ball, plate = (gc.read_surface(file, "mm") for file in files)
    lower, upper = plate.vertices.min(axis=0), plate.vertices.max(axis=0)
    beyond = np.maximum(lower - ball.vertices, ball.vertices - upper)
    distance = np.where(
        (beyond <= 0.0).all(axis=1), beyond.max(axis=1), np.linalg.norm(np.maximum(beyond, 0.0), axis=1)
    )
    form = Form("area", dict(zip(("moving", "fixed"), map(str, files), strict=True)) | {"unit": "mm"})
    edge = ball.edge_length.max()
    for threshold in (0.5e-3, 3e-3, 8e-3):
        form.values |= {"threshold": f"{threshold * 1e3:g}"}
        found = asked(form, tmp_path)
        assert found["about"].startswith("as stored, since no motion is filled in: sphere_r20.stl (moving) on plate")
        level = np.frombuffer(b64decode(found["marked"]["within"][1]), np.uint8).astype(float)
        assert 0 < (level <= 127).sum() < len(level)
        assert ((level <= 127) == (distance <= threshold)).all()
        linear = 127.0 + 127.0 * np.clip((distance - threshold) / edge, -1.0, 1.0)
        assert np.abs(level - linear).max() <= 1.0


def test_bodies_as_stored_have_sides(tmp_path: Path) -> None:
    """The side of the body is no motion: areas are those of a motion of one frame that leaves the bodies in place."""
    form = Form.of_words(sample("area", tmp_path).words)
    form.values["motion"] = ""
    assert form.values["side"] == "right"
    found = asked(form, tmp_path)
    assert found.get("about", "").startswith("as stored, since no motion is filled in: "), found["said"]
    still = tmp_path / "still.csv"
    still.write_text("time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz\n0,0,0,0,1,0,0,0\n", encoding="utf-8")
    form.values["motion"] = str(still)
    assert asked(form, tmp_path)["said"] == found["said"] and "area_fixed_medial" in found["said"]
    form.values |= {"motion": "", "rate": "100"}
    assert "--motion" in asked(form, tmp_path)["said"]  # something is said of a motion that is missing


def test_what_cannot_be_shown_is_said_in_one_line(tmp_path: Path) -> None:
    """A mesh that is missing or is not there, a unit that is missing or wrong, a threshold that is none."""
    form = Form.of_words(sample("area", tmp_path).words)
    whole = dict(form.values)
    for name, value, words in (
        ("moving", "", "MOVING is missing"),
        ("fixed", str(tmp_path / "none.stl"), "none.stl: there is no such file"),
        ("unit", "", "--unit is missing"),
        ("unit", "m", "is too large"),
        ("threshold", "x", "--threshold: 'x' is not a finite number"),
        ("motion", str(tmp_path / "none.csv"), "none.csv: there is no such file"),
    ):
        form.values = whole | {name: value}
        found = asked(form, tmp_path)
        assert found["said"].startswith("not shown: ") and words in found["said"], found["said"]
        assert "\n" not in found["said"] and "marked" not in found
    form.values = whole | {"threshold": "x"}
    at = form.at(asked(form, tmp_path)["said"])
    assert at is not None and at.name == "threshold"


def test_a_file_that_changes_is_read_anew(tmp_path: Path) -> None:
    form = Form.of_words(sample("area", tmp_path).words)
    motion = tmp_path / "gait.csv"
    lines = Path(form.values["motion"]).read_text("utf-8").splitlines()
    motion.write_text("\n".join(lines), encoding="utf-8")
    form.values["motion"] = str(motion)
    first = asked(form, tmp_path)["said"]
    motion.write_text("\n".join([lines[0], *lines[3:]]) + "\n", encoding="utf-8")
    found = asked(form, tmp_path)
    assert "frame 1 of 9" in found["about"] and found["said"] != first


def test_forms_with_the_picture_declare_a_threshold_and_bodies() -> None:
    shown = {command for command in COMMANDS if threshold_of(Form(command))}
    assert shown == {"area", "pairs"}
    assert any(one.name == "threshold" for one in fields_of("modulus"))  # of areas that were computed: no surfaces


async def _while_an_answer_lasts(form: Form, view: FileView, picture: ThresholdView, last: Path) -> None:
    """Eight places of a slider and a file come while the first answer is awaited."""
    first = asyncio.ensure_future(picture.show())
    await asyncio.sleep(0.05)
    looks = []
    for k in range(8):
        form.values["threshold"] = f"{k}"
        looks += [asyncio.ensure_future(each) for each in (picture.colour(), view.look())]
        await asyncio.sleep(0.005)
    await asyncio.gather(first, *looks)
    form.values["threshold"] = "8"
    asking = asyncio.ensure_future(view.look())
    await asyncio.sleep(0.05)
    form.values["moving"] = str(last)
    await view.look()
    await asking


def test_what_a_slider_was_moved_over_is_not_asked_and_files_are_looked_at(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    questions: list[str] = []

    async def slowly(called: Any, what: Any) -> Any:
        await asyncio.sleep(0.2)
        return [Content(kind=path.name) for path in what] if called is contents else called(what)

    def answer(asked: dict[str, Any]) -> Found:
        questions.append(json.loads(asked["filled"])["values"]["threshold"])
        return Found("", {"within": []}, page="page", thresholds=[1e-3])

    monkeypatch.setattr("geocontact.app.elements.below_home", str)  # no request
    monkeypatch.setattr(chooser, "ask", answer)
    monkeypatch.setattr(run, "io_bound", slowly)
    client = Client(page(""), request=None)
    monkeypatch.setattr(client, "run_javascript", lambda script: script)
    form = Form.of_words(sample("area", tmp_path).words)
    with client.content:
        view = FileView(FormView(form, "up", lambda: None), tmp_path, tmp_path, str, "up")
        view.look_at_all()
        last = Path(str(form.values["fixed"]))
        awaited(_while_an_answer_lasts(form, view, view._pictures["threshold"][0], last))
    assert questions[0] == "4" and questions[-3:-1] == ["7", "8"] and len(questions) <= 5, questions
    assert view._shown["moving"] == (known_file(last),)


def test_a_folder_that_others_change_deep_inside_is_said_anew(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """While it is shown, and nothing is typed."""
    read: list[str] = []

    async def at_once(called: Any, what: Any) -> Any:
        read.extend(path.name for path in what)
        return [Content(kind=f"look {len(read)}") for _ in what]

    monkeypatch.setattr(run, "io_bound", at_once)
    deep = tmp_path / "session" / "MarkerData" / "raw" / "first"
    deep.mkdir(parents=True)
    (deep / "walk.trc").write_text("one", encoding="utf-8")
    client = Client(page(""), request=None)
    form = Form("markers", {"coordinates": str(tmp_path / "session")})
    with client.content:
        view = FileView(FormView(form, "up", lambda: None), tmp_path, tmp_path, str, "up")
        awaited(view.look())
        assert not view.changed() and not read  # of a form that nobody has filled in by hand
        view.look_at_all()
        assert view.changed()
        awaited(view.look())
        assert not view.changed() and read == ["session"]
        (deep / "walk.trc").write_text("another", encoding="utf-8")
        assert view.changed()
        awaited(view.look())
        assert not view.changed() and read == ["session", "session"]


def said(tab: Page) -> str:
    return str(tab.locator(".picture .lines").inner_text())


def awaits(tab: Page, words: str) -> None:
    until(tab, f"(document.querySelector('.picture .lines')?.textContent ?? '').startsWith('{words}')", 120.0)


def on_fixed(found: dict[str, Any]) -> np.ndarray:
    """Levels of the vertices of the fixed body."""
    return np.frombuffer(b64decode(found["marked"]["within"][0]), np.uint8)


def coloured(tab: Page, count: int) -> bool:
    """Whether the picture comes to colour so many vertices of the first body."""
    frame = next(each for each in tab.frames if "/page/" in each.url)
    for _ in range(400):
        if frame.evaluate("window.__geocontact.marked") == count:
            return True
        tab.wait_for_timeout(50)
    return False


def field(tab: Page, selector: str) -> float:
    return float(tab.locator(selector).input_value())


@pytest.mark.slow
def test_the_slider_and_the_field_move_each_other(window: Window, tmp_path: Path) -> None:
    """By keyboard and as typed; areas, number and field are of one threshold, and those of area.csv of its command."""
    tab = window.tab("form/area?sample=1")
    tab.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
    tab.get_by_role("button", name="show the threshold in 3-D").click()
    awaits(tab, "within 4 mm: area_fixed ")
    frame = tab.frame_locator(".picture iframe")
    frame.locator("html[data-ready]").wait_for(timeout=60_000)
    until(tab, "document.querySelector('.picture input[type=range]').value === '4'", 20.0)
    levels = on_fixed(asked(Form.of_words(sample("area", window.folder).words), tmp_path))
    assert coloured(tab, (levels < 128).sum())
    slider = tab.get_by_label("threshold [mm]", exact=True)
    slider.focus()
    for _ in range(40):
        tab.keyboard.press("ArrowLeft")
    awaits(tab, "within 2 mm: area_fixed ")
    assert field(tab, '[name="threshold"]') == field(tab, ".picture input[type=number]") == 2.0
    words = Form.of_words(sample("area", window.folder).words)
    words.values |= {"threshold": "2"}
    fewer = on_fixed(asked(words, tmp_path))
    assert 0 < (fewer < 128).sum() < (levels < 128).sum() and coloured(tab, (fewer < 128).sum())
    assert len(marked_pixels(frame)[0]) > 200
    until(tab, "document.querySelector('[aria-label=\"command line\"]').textContent.includes('--threshold=2mm')", 20.0)
    run_words(words.words(tmp_path / "out"), tmp_path)
    agrees(said(tab), rows_of(tmp_path / "out" / "area.csv")[0])
    assert "frame 1 of 11" in tab.locator(".picture p").last.inner_text()
    tab.locator('[name="threshold"]').fill("0.1,3.25")
    awaits(tab, "within 0.1 mm: ")
    until(tab, "document.querySelector('.picture input[type=number]').value === '3.25'", 20.0)
    assert field(tab, ".picture input[type=range]") == 3.25
    tab.get_by_label("threshold [mm], as a number").fill("1.5")
    until(tab, "document.querySelector('[name=threshold]').value === '0.1,1.5'", 20.0)
    until(tab, "document.querySelector('.picture .lines').textContent.includes('within 1.5 mm')", 60.0)
    tab.close()


@pytest.mark.slow
def test_units_mistakes_and_a_phone(window: Window) -> None:
    """Another unit gives another slider; a threshold that cannot be leaves the picture, a file that is not takes it."""
    tab = window.tab("form/area?sample=1")
    tab.set_viewport_size({"width": 390, "height": 844})
    tab.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
    tab.get_by_role("button", name="show the threshold in 3-D").click()
    awaits(tab, "within 4 mm: ")
    tab.locator('[name="threshold"]').fill("0.5")
    tab.locator('[name="threshold-unit"]').select_option("cm")
    awaits(tab, "within 0.5 cm: ")
    slider = tab.get_by_label("threshold [cm]", exact=True)
    assert slider.get_attribute("max") == "2" and slider.input_value() == "0.5"
    number = tab.locator(".picture input[type=number]")
    assert number.get_attribute("aria-describedby") == tab.locator(".picture p").last.get_attribute("id")
    assert tab.evaluate("document.documentElement.scrollWidth") == 390
    box = tab.locator(".picture iframe").bounding_box()
    assert box is not None and box["width"] > 300.0
    number.fill("-1")
    tab.get_by_text("not shown: --threshold").wait_for(timeout=60_000)
    number.fill("0.2")
    awaits(tab, "within 0.2 cm: ")
    tab.locator('[name="motion"]').fill("none.csv")
    tab.get_by_text("not shown: none.csv: there is no such file").wait_for(timeout=60_000)
    assert tab.locator(".picture iframe").count() == 0
    tab.close()
