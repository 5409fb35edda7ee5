"""Faces that count, sides and landmarks on the 3-D picture of a form, against numpy on the STL's own bytes."""

from __future__ import annotations

import io
import struct
from base64 import b64decode
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import pytest
from nicegui import Client
from nicegui.elements.mixins.text_element import TextElement
from nicegui.page import page

from geocontact.app import picture, surface_view
from geocontact.app.faces import Chooser, Found
from geocontact.app.fields import Form, fields_of
from geocontact.app.landmark_uses import _USES
from geocontact.app.region_box import NAMES, STEPS, Box
from geocontact.app.surface_view import SurfaceView
from geocontact.cli.demo import sample_folder
from tests.app.conftest import Window
from tests.app.test_window import drop, until
from tests.browsers import awaited

if TYPE_CHECKING:
    from playwright.sync_api import FrameLocator, Page

INSERT = sample_folder() / "tibial_insert_right_coarse.stl"
MARGIN = 1.08  # of the camera's frame around the scene
BLUE, ORANGE = 0.35, -0.35  # (blue - red) / (blue + red) of marked pixels is beyond these


def corners(file: Path) -> np.ndarray:
    """Corners of each face [mm], read from a binary STL by hand."""
    data = file.read_bytes()
    (count,) = struct.unpack_from("<I", data, 80)
    rows = np.frombuffer(data, np.dtype([("v", "<f4", (4, 3)), ("a", "<u2")]), count, 84)
    return rows["v"][:, 1:].astype(float)


def of_faces(file: Path) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Centroids [mm], unit normals and areas [mm^2]."""
    a, b, c = corners(file).transpose(1, 0, 2)
    across = np.cross(b - a, c - a)
    size = np.linalg.norm(across, axis=1)
    return (a + b + c) / 3.0, across / size[:, None], 0.5 * size


@pytest.fixture(scope="module")
def chooser() -> Iterator[Chooser]:
    one = Chooser()
    yield one
    one.close()


def asked(**more: object) -> dict[str, object]:
    return {"surface": str(INSERT), "unit": "mm", "option": "`region`"} | more


def bits(marked: dict[str, object] | None) -> np.ndarray:
    assert marked is not None
    raw = np.frombuffer(b64decode(str(marked["faces"])), np.uint8)
    return np.unpackbits(raw, bitorder="little")[: int(str(marked["count"]))].astype(bool)


def test_the_faces_are_those_of_the_expression(chooser: Chooser, tmp_path: Path) -> None:
    """Number, each face and area, for an expression, a file of face numbers and a body that is turned and shifted."""
    centroid, normal, area = of_faces(INSERT)
    found = chooser.ask(asked(region="ny>0.25 and abs(z)<30"))
    expected = (normal[:, 1] > 0.25) & (np.abs(centroid[:, 2]) < 30.0)
    assert 0 < expected.sum() < len(expected) and (bits(found.marked) == expected).all()
    assert found.said == f"{expected.sum()} of {len(expected)} faces count, {area[expected].sum():.1f} mm^2"
    (tmp_path / "faces.txt").write_text("7\n3\n")
    assert np.flatnonzero(bits(chooser.ask(asked(region=str(tmp_path / "faces.txt"))).marked)).tolist() == [3, 7]
    turn = tmp_path / "pose.txt"
    turn.write_text("0 -1 0 5\n1 0 0 0\n0 0 1 -2\n0 0 0 1\n")  # x' = 5 - y, y' = x
    found = chooser.ask(asked(region="x<0", placement=str(turn), split="z=1", side="left"))
    assert (bits(found.marked) == (5.0 - centroid[:, 1] < 0.0)).all()
    assert found.marked is not None and found.marked["medial"] == pytest.approx([0.0, 0.0, 1.0, 3.0])  # z - 2 > 1
    assert found.box is not None
    assert found.box[0] == pytest.approx([5.0 - centroid[:, 1].max(), 5.0 - centroid[:, 1].min()])


def test_what_the_analysis_refuses_is_said_in_its_words(chooser: Chooser) -> None:
    assert "'qq' is not understood" in chooser.ask(asked(region="qq>1")).said
    assert "holds for no face" in chooser.ask(asked(region="y>1e4")).said
    assert "outward depends on other options" in chooser.ask(asked(region="outward>0", elsewhere="outward,radial")).said
    found = chooser.ask(asked(split="z"))
    assert "does not say which side of the plane is medial" in found.said and found.marked is None


def test_a_process_that_ends_is_started_anew() -> None:
    """Killed in between, and one that lasts too long; the last answer does not depend on it."""
    one = Chooser()
    first = one.ask(asked())
    assert one._process is not None
    one._process.kill()
    one._process.wait()
    assert one.ask(asked()) == first
    one.close()
    late = Chooser(patience=1e-3)
    assert "ended with" in late.ask(asked()).said
    late.close()


def test_a_box_writes_the_expression_of_its_limits() -> None:
    box = Box(((-20.0, 20.0), (0.0, 8.0), (-35.0, 35.0), *((-1.0, 1.0),) * 3))
    assert box.expression == ""
    for name, end, step in (("x", 0, 250), ("z", 1, 500), ("ny", 0, 750)):
        box.drag(NAMES.index(name), end, step)
    assert box.expression == "x>-10 and z<0 and ny>0.5"
    box.drag(0, 0, 0)
    box.drag(2, 1, STEPS)
    assert box.expression == "ny>0.5"


def test_uses_of_landmarks_are_options_that_speak_of_them() -> None:
    for (command, surface), uses in _USES.items():
        known = {one.name: one for one in fields_of(command)}
        assert known[surface].kind == "file", (command, surface)
        for use in uses:
            said = f"{use.field}: {known[use.field].words}"
            assert "landmark" in said.lower() or "The same for" in said, use


def test_a_picture_in_another_unit_is_taken_away(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By the look after the unit was changed, and where it is changed while the page or an answer is awaited."""
    form = Form("area", {"fixed": str(INSERT), "unit": "mm"})
    named = {each.name: each for each in form.fields}
    questions: list[dict[str, Any]] = []
    changes = {"page": "", "answer": ""}

    def write(_path: Path, _unit: str, _out: Path) -> str:
        form.values["unit"] = changes["page"] or form.values["unit"]
        return ""

    def answer(asked: dict[str, Any]) -> Found:
        questions.append(asked)
        form.values["unit"] = changes["answer"] or form.values["unit"]
        return Found("12 faces", {"faces": ""}, [[0.0, 1.0]] * 6)

    async def at_once(called: Callable[..., Any], *words: Any) -> Any:
        return called(*words)

    monkeypatch.setattr("geocontact.app.elements.below_home", str)  # no request
    monkeypatch.setattr(surface_view, "write_page", write)
    monkeypatch.setattr(picture.chooser, "ask", answer)
    monkeypatch.setattr(surface_view.aside, "io_bound", at_once)
    client = Client(page(""), request=None)
    monkeypatch.setattr(client, "run_javascript", lambda script: script)

    def pictures() -> list[str]:
        return [one.tag for one in client.elements.values() if one.tag in ("iframe", "input")]

    def words() -> str:
        return " ".join(one.text for one in client.elements.values() if isinstance(one, TextElement))

    with client.content:
        view = SurfaceView(form, named["fixed"], [named["unit"]], INSERT, tmp_path, str, "up")
        awaited(view.show())
        assert pictures() == ["iframe", *["input"] * 12] and "x [mm]" in words()
        awaited(view.colour())
        assert len(pictures()) == 13 and len(questions) == 1
        form.values["unit"] = "cm"
        awaited(view.colour())
        assert pictures() == [] and "the picture was in mm: show it again" in words() and len(questions) == 1
        awaited(view.show())
        assert len(pictures()) == 13 and "x [cm]" in words() and "[mm]" not in words() and "again" not in words()
        changes["page"] = "m"
        awaited(view.show())
        assert pictures() == [] and "the picture was in cm" in words() and len(questions) == 2
        changes["page"], changes["answer"] = "", "in"
        awaited(view.show())
        assert pictures() == [] and "the picture was in m:" in words() and questions[-1]["unit"] == "m"


def shown(tab: Page) -> FrameLocator:
    """The picture of the insert in the field `fixed` of `area`, from above."""
    drop(tab, "fixed", INSERT)
    tab.get_by_role("button", name=f"use mm for {INSERT.name}").click()
    until(tab, "document.querySelector('[aria-label=\"command line\"]').textContent.includes('--unit=mm')", 20.0)
    tab.get_by_role("button", name=f"show {INSERT.name} in 3-D").click()
    frame = tab.frame_locator(".picture iframe")
    frame.locator("html[data-ready]").wait_for(timeout=60_000)
    frame.get_by_role("button", name="+y").click()
    return frame


def on_screen(points: np.ndarray, vertices: np.ndarray, box: dict[str, float]) -> np.ndarray:
    """Where the orthographic camera of the view "+y", z to the right and x up, shows points [px]."""
    seen = vertices[:, [2, 0]]
    half, middle = 0.5 * np.ptp(seen, axis=0), 0.5 * (seen.min(axis=0) + seen.max(axis=0))
    size = 2.0 * MARGIN * max(half[1], half[0] * box["height"] / box["width"]) / box["height"]
    right, up = ((points[:, [2, 0]] - middle) / size).T
    return np.column_stack([box["x"] + 0.5 * box["width"] + right, box["y"] + 0.5 * box["height"] - up])


def counted(tab: Page, words: str) -> None:
    until(tab, f"(document.querySelector('.picture p.help')?.textContent ?? '').startsWith('{words}')", 60.0)


def marked_pixels(frame: FrameLocator) -> tuple[np.ndarray, np.ndarray]:
    """Columns from left to right, 0 to 1, of blue and of orange pixels of the picture."""
    from PIL import Image

    drawn = str(frame.locator("#canvas").evaluate("canvas => canvas.toDataURL()")).partition(",")[2]
    shot = Image.open(io.BytesIO(b64decode(drawn))).convert("RGB")
    red, _, blue = np.asarray(shot, float).transpose(2, 0, 1)
    tone = (blue - red) / np.maximum(blue + red, 1.0)
    wide = red.shape[1]
    return np.nonzero(tone > BLUE)[1] / wide, np.nonzero(tone < ORANGE)[1] / wide


@pytest.mark.slow
def test_faces_of_the_region_are_coloured_at_once(window: Window) -> None:
    """Their number is that of `--region`; sides are cut at the plane, as typed and as a slider is dragged."""
    tab = window.tab("form/area")
    frame = shown(tab)
    centroid, normal, _ = of_faces(INSERT)
    total = len(centroid)
    counted(tab, f"{total} of {total}")
    tab.evaluate("document.querySelectorAll('details').forEach(each => { each.open = true; })")
    tab.locator('[name="region"]').fill("ny>0.25 and z<0")
    number = int(((normal[:, 1] > 0.25) & (centroid[:, 2] < 0.0)).sum())
    counted(tab, f"{number} of {total}")
    blue, orange = marked_pixels(frame)
    assert len(orange) == 0 and len(blue) > 1000
    half = blue.max() < 0.51 or blue.min() > 0.49
    assert half, (blue.min(), blue.max())
    tab.locator('[name="region"]').fill("")
    tab.locator('[name="split"]').fill("z")
    tab.locator('[name="side"]').select_option("right")
    until(tab, "document.querySelector('.picture p.help').textContent.includes('medial is -z')", 30.0)
    medial, lateral = marked_pixels(frame)
    assert min(len(medial), len(lateral)) > 1000
    assert max(medial.min(), lateral.min()) == pytest.approx(min(medial.max(), lateral.max()), abs=0.01)
    assert (medial.mean() < 0.5) == (blue.mean() < 0.5)  # medial of a right one is z < 0
    slider = tab.get_by_label(f"ny from, of {INSERT.name}")
    slider.fill("700")
    until(tab, "document.querySelector('[name=region]').value === 'ny>0.4'", 20.0)
    counted(tab, f"{int((normal[:, 1] > 0.4).sum())} of {total}")
    tab.locator('[name="unit"]').select_option("cm")
    tab.get_by_text("the picture was in mm: show it again").wait_for(timeout=20_000)
    assert tab.locator(".picture iframe").count() == 0
    tab.close()


@pytest.mark.slow
def test_landmarks_of_the_picture_fill_the_fields_that_read_them(window: Window) -> None:
    """Three vertices are picked; the file has their coordinates, and `--region` counts the faces inside them."""
    tab = window.tab("form/area")
    frame = shown(tab)
    vertices = np.unique(corners(INSERT).reshape(-1, 3), axis=0)
    centroid, normal, _ = of_faces(INSERT)
    top = np.unique(corners(INSERT)[normal[:, 1] > 0.7].reshape(-1, 3), axis=0)
    aims = np.array([[-10.0, 12.0], [10.0, 12.0], [0.0, 30.0]])
    picked = np.array([top[np.argmin(np.linalg.norm(top[:, [0, 2]] - aim, axis=1))] for aim in aims])
    frame.locator("#pick").click()
    frame.locator("#canvas").scroll_into_view_if_needed()
    box = frame.locator("#canvas").bounding_box()
    assert box
    for x, y in on_screen(picked, vertices, dict(box)):
        tab.mouse.click(float(x), float(y))
    frame.get_by_role("button", name="use in the form").click()
    tab.get_by_role("button", name="--region: inside them").click()
    until(tab, "document.querySelector('[name=region]').value.startsWith('polygon:')", 20.0)
    file = Path(tab.locator('[name="region"]').input_value().removeprefix("polygon:"))
    assert file.is_relative_to(window.folder)
    rows = [line for line in file.read_text("utf-8").splitlines() if not line.startswith("#")]
    found = np.array([[float(each) for each in row.split(",")[1:]] for row in rows[1:]])
    assert rows[0] == "id,x [mm],y [mm],z [mm]" and found.shape == (3, 3)
    assert np.abs(found - picked).max() < 1e-6
    corner = np.vstack([found[:, [0, 2]].T, np.ones(3)])
    shares = np.linalg.solve(corner, np.vstack([centroid[:, [0, 2]].T, np.ones(len(centroid))]))
    inside = int(((shares > 0.0).all(axis=0) & (normal[:, 1] > 0.5)).sum())
    said = "document.querySelector('.picture p.help').textContent"
    until(tab, f"/^\\d+ of/.test({said}) && !({said}).startsWith('{len(centroid)} of')", 30.0)
    number = int(str(tab.evaluate(said)).split()[0])
    assert number > 0 and abs(number - inside) <= 0.1 * inside  # the polygon is seen along its own normal
    tab.close()
