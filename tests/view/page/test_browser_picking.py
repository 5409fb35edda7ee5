"""Landmarks picked in a real browser: coordinates, names, undo, keys, and the file as commands read it."""

from __future__ import annotations

import hashlib
import struct
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.bodies import chosen_faces, typed_axis, typed_centre
from geocontact.analyses.frame.surface_page import surface_page, write_surface_page
from geocontact.data.errors import InputWarning
from geocontact.io.recordings.landmarks import read_landmarks
from geocontact.io.recordings.mat_results import read_mat_landmarks
from geocontact.view.page.content import Scene
from geocontact.view.page.write import write_page
from tests.view.page.conftest import DESKTOP, PHONE, Open, Opened

pytestmark = pytest.mark.slow

MARGIN = 1.08  # of the camera's frame around the scene


def hill(n: int = 7) -> tuple[np.ndarray, np.ndarray]:
    """A height field over uneven steps, far from the origin [mm], and its triangles' corners in binary STL's floats."""
    step = np.array([0.0, 3.1, 7.7, 10.2, 16.9, 21.3, 27.8])[:n]
    x, y = np.meshgrid(211.3 + step, -57.9 + 0.8 * step, indexing="ij")
    z = 1013.7 + 6.0 * np.sin(0.2 * (x - 211.3)) * np.cos(0.15 * (y + 57.9))
    vertices = np.column_stack([x.ravel(), y.ravel(), z.ravel()]).astype(np.float32)
    corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    a, b, c, d = corner, corner + n, corner + n + 1, corner + 1
    return vertices, np.vstack([np.column_stack([a, b, c]), np.column_stack([a, c, d])])


def written_stl(path: Path, vertices: np.ndarray, faces: np.ndarray) -> Path:
    """Binary STL by hand."""
    rows = (struct.pack("<12fH", 0.0, 0.0, 0.0, *vertices[face].ravel().tolist(), 0) for face in faces)
    path.write_bytes(b"\0" * 80 + struct.pack("<I", len(faces)) + b"".join(rows))
    return path


def pixel(here: Opened, points: np.ndarray, vertices: np.ndarray) -> np.ndarray:
    """Where the orthographic camera of the view "+z" shows points [px on the page], from the page's box alone."""
    box = here.tab.locator("#canvas").bounding_box()
    assert box
    lower, upper = vertices.min(axis=0).astype(float), vertices.max(axis=0).astype(float)
    half, middle = 0.5 * (upper - lower), 0.5 * (upper + lower)
    tall = MARGIN * max(half[1], half[0] * box["height"] / box["width"])
    size = 2.0 * tall / box["height"]
    right, up = (points - middle)[:, 0] / size, (points - middle)[:, 1] / size
    return np.column_stack([box["x"] + 0.5 * box["width"] + right, box["y"] + 0.5 * box["height"] - up])


@pytest.fixture
def surface(tmp_path: Path) -> Path:
    return written_stl(tmp_path / "hill.stl", *hill())


def page_of(surface: Path) -> Path:
    return write_surface_page(surface, "mm", surface.with_suffix(".html"))


def from_above(here: Opened) -> Opened:
    here.tab.get_by_role("button", name="+z").click()
    here.tab.locator("#pick").click()
    return here


def click(here: Opened, place: np.ndarray) -> None:
    here.tab.mouse.click(float(place[0]), float(place[1]))


def save(here: Opened, path: Path) -> Path:
    with here.tab.expect_download() as waiting:
        here.tab.locator("#pick-save").click()
    waiting.value.save_as(path)
    assert waiting.value.suggested_filename == "hill_landmarks.csv"
    return path


def names(here: Opened) -> list[str]:
    return list(here.tab.locator("#pick-list input.name").evaluate_all("all => all.map(e => e.value)"))


@pytest.mark.parametrize("device", [DESKTOP, PHONE], ids=["1280x800", "390x844"])
@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_a_known_vertex_at_a_known_pixel_has_its_coordinates(
    opened: Open, surface: Path, tmp_path: Path, device: dict[str, object], scheme: str
) -> None:
    here = from_above(opened(page_of(surface), device=device, color_scheme=scheme))
    vertices, _ = hill()
    chosen = [10, 17, 32, 38]
    for place in pixel(here, vertices[chosen].astype(float), vertices):
        click(here, place)
    assert names(here) == ["L1", "L2", "L3", "L4"]
    found = read_landmarks(save(here, tmp_path / "picked.csv"))
    assert 1e3 * found.points == pytest.approx(vertices[chosen].astype(float), rel=1e-9)
    assert found.sha256 == hashlib.sha256(surface.read_bytes()).hexdigest()
    assert (found.mesh, found.unit) == ("hill.stl", "mm")
    assert not here.complaints
    assert here.requests == [page_of(surface).as_uri()], "offline"
    here.tab.locator("#pick-mat").check()
    size = device["viewport"]
    assert isinstance(size, dict)
    assert here.tab.evaluate("document.documentElement.scrollWidth") <= size["width"], "it does not scroll sideways"
    here.tab.get_by_role("button", name="move L4").click()
    assert here.tab.evaluate("document.getElementById('canvas').getBoundingClientRect().top") >= 0, (
        "the picture is seen"
    )


def test_a_point_on_a_face_lies_on_it_under_the_pixel(opened: Open, surface: Path, tmp_path: Path) -> None:
    here = from_above(opened(page_of(surface)))
    here.tab.locator("#pick-at").select_option("face")
    vertices, faces = hill()
    middle = vertices[faces[20]].astype(float).mean(axis=0)
    (place,) = pixel(here, middle[None], vertices)
    click(here, place)
    point = 1e3 * read_landmarks(save(here, tmp_path / "picked.csv")).points[0]
    a, b, c = vertices[faces[20]].astype(float)
    normal = np.cross(b - a, c - a)
    assert abs((point - a) @ normal / np.linalg.norm(normal)) < 1e-6
    box = here.tab.locator("#canvas").bounding_box()
    assert box
    half_pixel = 0.5 * MARGIN * float(np.ptp(vertices[:, 0])) / box["width"] * 2.0
    assert np.abs(point - middle)[:2].max() < 2.0 * half_pixel


def test_names_undo_and_delete(opened: Open, surface: Path) -> None:
    here = from_above(opened(page_of(surface)))
    vertices, _ = hill()
    for place in pixel(here, vertices[[10, 17, 32]].astype(float), vertices):
        click(here, place)
    first = here.tab.locator("#pick-list input.name").first
    first.fill("epicondyle, medial")
    first.press("u")  # a letter of the name, not the key
    first.press("p")
    assert names(here) == ["epicondyle, medialup", "L2", "L3"]
    here.tab.get_by_role("button", name="delete L2").click()
    assert names(here) == ["epicondyle, medialup", "L3"]
    here.tab.locator("#pick-undo").click()
    assert names(here) == ["epicondyle, medialup", "L2", "L3"]
    here.tab.locator("#pick-list input.name").nth(1).fill("L3")
    assert here.tab.locator("#pick-save").is_disabled()
    assert "Two landmarks are named L3" in here.text("#pick-hint")
    here.tab.keyboard.press("Escape")  # from the field to the picture
    here.tab.keyboard.press("u")
    assert names(here)[1] == "L2"
    assert here.tab.locator("#pick-save").is_enabled()


def test_a_drag_turns_the_picture_and_sets_nothing(opened: Open, surface: Path) -> None:
    here = from_above(opened(page_of(surface)))
    before = here.picture()
    vertices, _ = hill()
    (place,) = pixel(here, vertices[[24]].astype(float), vertices)
    here.tab.mouse.move(*place)
    here.tab.mouse.down()
    here.tab.mouse.move(place[0] + 60, place[1] + 20, steps=5)
    here.tab.mouse.up()
    assert names(here) == []
    assert here.picture() != before


def test_beside_the_surface_nothing_is_set(opened: Open, surface: Path) -> None:
    here = from_above(opened(page_of(surface)))
    box = here.tab.locator("#canvas").bounding_box()
    assert box
    click(here, np.array([box["x"] + 3, box["y"] + 3]))
    assert names(here) == []
    assert here.text("#pick-said") == "no surface there"


def test_keys_alone_set_and_undo_a_landmark(opened: Open, surface: Path, tmp_path: Path) -> None:
    here = opened(page_of(surface))
    here.tab.get_by_role("button", name="+z").press("Enter")
    canvas = here.tab.locator("#canvas")
    canvas.press("p")
    canvas.press("Enter")
    for _ in range(20):
        canvas.press("ArrowRight")
    canvas.press("Enter")
    assert names(here) == ["L1", "L2"]
    assert here.text("#pick-said").startswith("L2 at x ")
    found = 1e3 * read_landmarks(save(here, tmp_path / "picked.csv")).points
    assert found[1, 0] > found[0, 0], "the cross went to the right, along +x"
    vertices, _ = hill()
    off = np.linalg.norm(vertices[:, None].astype(float) - found, axis=2).min(axis=0)
    assert off.max() < 1e-6
    canvas.press("u")
    assert names(here) == ["L1"]


def test_every_control_has_a_name_for_screen_readers(opened: Open, surface: Path) -> None:
    here = from_above(opened(page_of(surface)))
    vertices, _ = hill()
    click(here, pixel(here, vertices[[24]].astype(float), vertices)[0])
    bare = here.tab.evaluate(
        "[...document.querySelectorAll('#picking button, #picking input, #picking select')].filter(e => "
        "!(e.getAttribute('aria-label') || e.textContent.trim() || e.labels?.[0]?.textContent.trim())).length"
    )
    assert bare == 0
    assert here.tab.get_by_role("region", name="Landmarks").count() == 1
    assert here.tab.locator("#pick").get_attribute("aria-pressed") == "true"


def test_what_is_cut_away_is_not_picked(opened: Open, surface: Path, tmp_path: Path) -> None:
    here = from_above(opened(page_of(surface)))
    vertices, _ = hill()
    (place,) = pixel(here, vertices[[10]].astype(float), vertices)
    here.tab.locator("#cut").select_option("0")
    flipped = here.tab.locator("#cut-flip")
    click(here, place)
    first = len(names(here))
    flipped.click()
    click(here, place)
    assert {first, len(names(here)) - first} == {0, 1}, "one half has the vertex, the other has not"


def test_the_file_chooses_a_region_and_places_a_mat(opened: Open, surface: Path, tmp_path: Path) -> None:
    here = from_above(opened(page_of(surface)))
    vertices, _ = hill()
    corners = [8, 36, 40, 12]  # rows 1 to 5, columns 1 to 5 of the grid
    for place in pixel(here, vertices[corners].astype(float), vertices):
        click(here, place)
    here.tab.locator("#pick-mat").check()
    assert here.tab.locator("#pick-save").is_disabled(), "places of the mat are missing"
    for k, (row, column) in enumerate([(0, 0), (4, 0), (4, 4), (0, 4)]):
        here.tab.locator("#pick-list input.row").nth(k).fill(str(row))
        here.tab.locator("#pick-list input.column").nth(k).fill(str(column))
    file = save(here, tmp_path / "corners.csv")
    marks = read_mat_landmarks(file, 4, 4)
    assert marks.place.tolist() == [[0, 0], [4, 0], [4, 4], [0, 4]]
    assert 1e3 * marks.point == pytest.approx(vertices[corners].astype(float), rel=1e-9)
    inside = chosen_faces("`region`", f"polygon:{file}", gc.read_surface(surface, "mm"), "mm")
    assert inside is not None
    assert int(inside.sum()) == 2 * 4 * 4, "the cells of the grid inside"
    body = gc.read_surface(surface, "mm")
    along = (vertices[36] - vertices[8]).astype(float)
    axis = typed_axis("`axis`", f"{file}:L1:L2", body, "mm")
    assert axis.direction == pytest.approx(1e-3 * along, rel=1e-9)
    assert axis.point == pytest.approx(1e-3 * vertices[8].astype(float), rel=1e-9)
    centre = typed_centre("`load_point`", f"{file}:L3", body, "mm")
    assert centre == pytest.approx(1e-3 * vertices[40].astype(float), rel=1e-9)
    with pytest.warns(InputWarning, match="a sphere does not describe this patch"):
        fitted = gc.fit_shape(surface, shape="sphere", unit="mm", region=f"polygon:{file}")
    assert (fitted.fitting.patch.faces == inside).all()


def test_a_landmark_is_moved_and_keeps_name_and_place(opened: Open, surface: Path, tmp_path: Path) -> None:
    here = from_above(opened(page_of(surface)))
    vertices, _ = hill()
    for place in pixel(here, vertices[[10, 17, 32]].astype(float), vertices):
        click(here, place)
    here.tab.locator("#pick-list input.name").nth(1).fill("medial")
    here.tab.get_by_role("button", name="move L2").click()
    assert here.text("#pick-hint") == "Click the new place of medial."
    click(here, pixel(here, vertices[[38]].astype(float), vertices)[0])
    assert names(here) == ["L1", "medial", "L3"]
    found = read_landmarks(save(here, tmp_path / "picked.csv"))
    assert 1e3 * found.points == pytest.approx(vertices[[10, 38, 32]].astype(float), rel=1e-9)
    click(here, pixel(here, vertices[[24]].astype(float), vertices)[0])
    assert names(here)[3] == "L4", "one is moved once"
    here.tab.locator("#pick-undo").click()
    here.tab.locator("#pick-undo").click()
    again = read_landmarks(save(here, tmp_path / "again.csv"))
    assert 1e3 * again.point("medial") == pytest.approx(vertices[17].astype(float), rel=1e-9)


def test_a_name_that_no_command_could_read_is_not_saved(opened: Open, surface: Path, tmp_path: Path) -> None:
    here = from_above(opened(page_of(surface)))
    vertices, _ = hill()
    click(here, pixel(here, vertices[[24]].astype(float), vertices)[0])
    field = here.tab.locator("#pick-list input.name").first
    for name in ("", "  ", "a:b", "em\u2003space", "zero\u200bwidth"):
        field.fill(name)
        assert here.tab.locator("#pick-save").is_disabled(), repr(name)
    for name in ('5" wide, left', "Trochanter major", "=A1", "\u00e9picondyle"):
        field.fill(name)
        assert read_landmarks(save(here, tmp_path / "picked.csv")).names == (name,)


def test_landmarks_of_a_file_stand_on_the_page_and_are_corrected(opened: Open, surface: Path, tmp_path: Path) -> None:
    vertices, _ = hill()
    rows = [f"{name},{k},2.5,{x},{y},{z}" for name, k, (x, y, z) in zip("PQ", (3, 4), vertices[[10, 17]], strict=True)]
    middle = 0.5 * (vertices[32] + vertices[33]).astype(float)
    rows.append("R,7,0.5,{},{},{}".format(*middle.tolist()))
    file = tmp_path / "before.csv"
    file.write_text("id,row,column,x [mm],y [mm],z [mm]\n" + "\n".join(rows) + "\n")
    page = write_surface_page(surface, "mm", tmp_path / "page.html", file)
    here = from_above(opened(page))
    assert names(here) == ["P", "Q", "R"]
    before = read_landmarks(file)
    unchanged = read_landmarks(save(here, tmp_path / "unchanged.csv"))
    assert unchanged.points == pytest.approx(before.points, rel=1e-11)
    assert unchanged.table[["row", "column"]].to_numpy().tolist() == [["3", "2.5"], ["4", "2.5"], ["7", "0.5"]]
    rings = here.tab.locator("#picked circle.landmark").evaluate_all(
        "all => all.map(e => [e.cx.baseVal.value, e.cy.baseVal.value])"
    )
    box = here.tab.locator("#canvas").bounding_box()
    assert box
    expected = pixel(here, np.vstack([vertices[[10, 17]].astype(float), middle]), vertices) - [box["x"], box["y"]]
    assert np.array(rings) == pytest.approx(expected, abs=0.5)
    here.tab.get_by_role("button", name="move Q").click()
    click(here, pixel(here, vertices[[38]].astype(float), vertices)[0])
    corrected = read_landmarks(save(here, tmp_path / "corrected.csv"))
    assert 1e3 * corrected.points == pytest.approx(np.vstack([vertices[[10, 38]].astype(float), middle]), rel=1e-9)
    assert corrected.sha256 == hashlib.sha256(surface.read_bytes()).hexdigest()


@pytest.mark.parametrize("unit", ["m", "cm"])
def test_a_mesh_in_another_unit_keeps_its_numbers(opened: Open, tmp_path: Path, unit: str) -> None:
    vertices, faces = hill()
    scaled = (vertices.astype(float) / {"m": 1e3, "cm": 10.0}[unit]).astype(np.float32)
    here = from_above(
        opened(write_surface_page(written_stl(tmp_path / "hill.stl", scaled, faces), unit, tmp_path / "p.html"))
    )
    click(here, pixel(here, scaled[[24]].astype(float), scaled)[0])
    assert here.text("#pick-list thead th:nth-child(2)") == f"x [{unit}]"
    file = save(here, tmp_path / "picked.csv")
    assert f"# unit = {unit}\n" in file.read_text()
    found = read_landmarks(file)
    cells = file.read_text().splitlines()[-1].split(",")[1:]
    assert np.array(cells, float) == pytest.approx(scaled[24].astype(float), rel=1e-9)
    assert found.points[0] == pytest.approx(1e-3 * vertices[24].astype(float), rel=1e-6)


def test_of_two_bodies_the_nearer_one_is_picked_and_each_has_its_file(
    opened: Open, surface: Path, tmp_path: Path
) -> None:
    vertices, faces = hill()
    lower = written_stl(tmp_path / "lower.stl", vertices - np.float32([0, 0, 20]), faces)
    first, second = (surface_page(gc.read_mesh(file, "mm")) for file in (surface, lower))
    scene = next(each for each in first.sections if isinstance(each, Scene))
    other = next(each for each in second.sections if isinstance(each, Scene))
    both = replace(scene, bodies=[*other.bodies, *scene.bodies])
    page = replace(first, sections=tuple(both if each is scene else each for each in first.sections))
    write_page(page, tmp_path / "both.html")
    here = from_above(opened(tmp_path / "both.html"))
    (place,) = pixel(here, vertices[[24]].astype(float), vertices)
    click(here, place)
    assert here.text("#pick-said").endswith(", on hill.stl"), "the upper one is in front"
    here.tab.get_by_role("button", name="−z").click()
    box = here.tab.locator("#canvas").bounding_box()
    assert box
    middle = [box["x"] + 0.5 * box["width"], box["y"] + 0.5 * box["height"]]
    click(here, np.array(middle))
    assert here.text("#pick-said").endswith(", on lower.stl")
    seen = here.tab.locator("#pick-list td.mesh").all_text_contents()
    assert seen == ["hill.stl", "lower.stl"]
    fields = here.tab.locator("#pick-list input.name")
    fields.nth(1).fill("L1")
    assert here.tab.locator("#pick-save").is_enabled(), "the same name on another mesh is another landmark"
    saved = []
    here.tab.on("download", lambda each: saved.append(each))
    here.tab.locator("#pick-save").click()
    here.tab.wait_for_timeout(1500)
    assert sorted(each.suggested_filename for each in saved) == ["hill_landmarks.csv", "lower_landmarks.csv"]
    for each in saved:
        each.save_as(tmp_path / each.suggested_filename)
    for name, file in (("hill", surface), ("lower", lower)):
        found = read_landmarks(tmp_path / f"{name}_landmarks.csv")
        assert found.sha256 == hashlib.sha256(file.read_bytes()).hexdigest()
        assert found.names == ("L1",)
    assert 1e3 * read_landmarks(tmp_path / "hill_landmarks.csv").points[0] == pytest.approx(
        vertices[24].astype(float), rel=1e-9
    )
