"""Pressures on the page: colours, legend and numbers against the table and the maps written beside it."""

from __future__ import annotations

from typing import Any

import numpy as np
import pandas as pd
import pytest

from geocontact.contact.elasticity import layer_modulus
from geocontact.view.page.content import FaceMap, Scene
from tests.cli.calls import Call, done
from tests.cli.test_area_pressure import pressed
from tests.view.page.conftest import DESKTOP, PHONE, Open, Opened, rows, set_range
from tests.view.page.examples import small_page
from tests.view.page.pictures import pixels

pytestmark = pytest.mark.slow

M = layer_modulus(5e8, 0.46)

SHOWN = {
    "force, medial": ("force_medial [N]", 1),
    "force, lateral": ("force_lateral [N]", 1),
    "force, total": ("force [N]", 1),
    "largest pressure": ("peak [MPa]", 2),
    "area under pressure": ("pressed_area [mm^2]", 2),
    "centre of pressure x": ("cop_x [mm]", 2),
    "centre of pressure y": ("cop_y [mm]", 2),
    "centre of pressure z": ("cop_z [mm]", 2),
}
"""Label under the cursor, column of pressure.csv, decimals."""


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """Ball on a floor, pressed in less and less; the last frame is in the air."""
    folder = tmp_path_factory.mktemp("pressed")
    return done(pressed(folder, "--split", "z", "--side", "right", "--save-map", at=(3.0, -2.0), picture=True))


@pytest.mark.parametrize("device", [DESKTOP, PHONE], ids=["1280x800", "390x844"])
def test_numbers_under_the_cursor_are_the_row_of_the_table(result: Call, opened: Open, device: dict[str, Any]) -> None:
    table = pd.read_csv(result.folder / "pressure.csv")
    here = opened(result.folder / "report.html", device=device)
    assert here.frame() == int(np.argmax(table["force [N]"])) == 0
    for frame in range(len(table)):
        set_range(here, "#slider", frame)
        said = rows(here)
        for label, (column, digits) in SHOWN.items():
            value = table[column][frame]
            number = said[label].split()[0].replace("−", "-")
            assert number == ("–" if np.isnan(value) else f"{value:z.{digits}f}"), (frame, label)
    assert here.complaints == [] and len(here.requests) == 1
    assert here.tab.evaluate("document.documentElement.scrollWidth <= window.innerWidth"), "no sideways scrolling"


def seen_from_above(here: Opened) -> tuple[np.ndarray, float]:
    """Picture of the floor alone, and mm per pixel of it."""
    bar = here.tab.locator("#scale i").bounding_box()
    assert bar
    picture = pixels(here.picture())
    return picture, float(here.text("#scale span").split()[0]) / bar["width"]


def test_what_is_coloured_is_what_is_pressed(result: Call, opened: Open) -> None:
    here = opened(result.folder / "report.html")
    here.tab.get_by_role("button", name="+y").click()
    here.tab.get_by_label("ball.stl", exact=True).uncheck()
    with np.load(result.folder / "pressure.npz", allow_pickle=False) as maps:
        corners = maps["vertices"][maps["faces"]] * 1e3
        area = 0.5 * np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
        expected = [float(area[pressure > 0.0].sum()) for pressure in maps["pressure"]]
    assert expected[0] > expected[1] > expected[2] == 0.0
    for frame, faces in enumerate(expected):
        set_range(here, "#slider", frame)
        picture, size = seen_from_above(here)
        coloured = np.ptp(picture, axis=2) > 30
        assert coloured.sum() * size**2 == pytest.approx(faces, rel=0.03, abs=0.2), frame


def test_colours_can_be_those_of_the_distance_again(result: Call, opened: Open) -> None:
    here = opened(result.folder / "report.html")
    pressure = here.picture()
    marks = here.tab.locator("#legend svg text").all_text_contents()
    with np.load(result.folder / "pressure.npz", allow_pickle=False) as maps:
        largest = maps["pressure"].max() * 1e-6
    assert marks[0] == "0" and "none" in marks
    assert max(float(mark) for mark in marks if mark[0].isdigit()) == pytest.approx(largest, rel=1e-3)
    assert "mean pressure of each face [MPa]" in here.text("#legend p")
    choice = here.tab.locator("#colours")
    choice.select_option("1")
    assert "[mm]; line: 4 mm, hatched: overlap" in here.text("#legend p")
    assert here.tab.locator("#legend text.main").all_text_contents() == ["4"]
    distance = here.picture()
    assert distance != pressure and here.tab.locator("#legend svg").count() == 1
    set_range(here, "#slider", 1)
    assert here.picture() != distance, "the colours follow the frame"
    set_range(here, "#slider", 0)
    assert here.picture() == distance
    choice.select_option("0")
    assert here.picture() == pressure
    assert here.tab.locator("#legend text.main").count() == 0
    assert here.complaints == []


def test_a_page_of_distances_has_no_choice(opened: Open) -> None:
    assert opened(small_page()).tab.locator("#colours").count() == 0


def test_the_page_says_what_pressures_rest_on(result: Call) -> None:
    page = result.bytes("report.html").decode().replace("\N{NO-BREAK SPACE}", " ")
    modulus = f"confined modulus {M * 1e-6:.4g} MPa, thickness 12 … 12 mm where it is pressed"
    for said in (
        modulus,
        "The pose decides",
        "Pieces of half the size change",
        "a layer that they",
        "means over faces",
    ):
        assert said in page, said
    assert "no force is computed" not in page


def test_maps_of_bodies_and_faces_that_are_not_there_are_refused() -> None:
    scene = small_page().sections[0]
    assert isinstance(scene, Scene)
    for body, faces, said in ((2, 5, "no body 2"), (0, 5, "5 values for")):
        each = FaceMap("pressure", "MPa", body, np.zeros((9, faces)))
        with pytest.raises(ValueError, match=said):
            Scene(scene.bodies, scene.thresholds, scene.span, scene.value_name, scene.directions, maps=[each])
