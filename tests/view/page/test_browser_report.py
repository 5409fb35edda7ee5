"""The page that the command line writes, in a browser, against the table it writes beside it."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any
from unittest import mock

import numpy as np
import pandas as pd
import pytest

from tests.cli.calls import FEMUR, INSERT, PLATE, SPHERE, Call, area, done, gait, poses
from tests.view.page.conftest import DESKTOP, PHONE, Open, rows
from tests.view.page.hostile import HOSTILE

pytestmark = pytest.mark.slow

SHOWN = {
    "contact area on the fixed body": ("area_fixed [mm^2]", 2),
    "lower bound (these meshes)": ("area_fixed_lower [mm^2]", 2),
    "upper bound (these meshes)": ("area_fixed_upper [mm^2]", 2),
    "medial part": ("area_fixed_medial [mm^2]", 2),
    "lateral part": ("area_fixed_lateral [mm^2]", 2),
    "contact area on the moving body": ("area_moving [mm^2]", 2),
    "smallest distance": ("min_distance [mm]", 3),
    "penetration of the fixed body": ("max_penetration_fixed [mm]", 3),
    "centroid x": ("centroid_x [mm]", 2),
    "centroid y": ("centroid_y [mm]", 2),
    "centroid z": ("centroid_z [mm]", 2),
}
"""Label under the cursor, column of area.csv, decimals."""


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """The synthetic knee in five frames, in a folder of spaces and quotes."""
    folder = tmp_path_factory.mktemp('it\'s a "knee" & more')
    options = ("--split", "z", "--side", "right", "--threshold", "1,4")
    motion = gait(folder, (0, 20, 40, 60, 80))
    return done(area(folder / "out", *options, moving=FEMUR, fixed=INSERT, motion=motion, picture=True))


@pytest.mark.parametrize("device", [DESKTOP, PHONE], ids=["1280x800", "390x844"])
def test_numbers_under_the_cursor_are_the_row_of_the_table(result: Call, opened: Open, device: dict[str, Any]) -> None:
    table = pd.read_csv(result.folder / "area.csv").query("`threshold [mm]` == 4").reset_index(drop=True)
    here = opened(result.folder / "report.html", device=device)
    assert here.frame() == int(np.argmax(table["area_fixed [mm^2]"]))
    here.tab.locator("#slider").focus()
    here.tab.keyboard.press("Home")
    pictures = set()
    for frame in range(len(table)):
        here.until(f"window.__geocontact.frame === {frame}")
        said = rows(here)
        for label, (column, digits) in SHOWN.items():
            value = table[column][frame]
            number = said[label].split()[0].replace("−", "-")
            assert number == ("–" if np.isnan(value) else f"{value:z.{digits}f}"), (frame, label)
        pictures.add(here.picture())
        here.tab.keyboard.press("ArrowRight")
    assert len(pictures) == len(table), "every frame looks different"
    assert here.complaints == [] and len(here.requests) == 1


def test_inputs_are_on_the_page_with_their_hashes(result: Call, opened: Open) -> None:
    here = opened(result.folder / "report.html")
    text = here.text("body")
    for entry in result.record()["inputs"]:
        assert entry["sha256"] in text and Path(entry["file"]).name in text
    assert "not a clinical device" in text


FILE_NAMES = [f"{name.replace('/', '∕')[:200]}.stl" for name in HOSTILE]
"""Every hostile text as the name of a mesh; a slash cannot be in one."""


@pytest.mark.parametrize(
    "first", [pytest.param(k, marks=() if k < 4 else pytest.mark.long) for k in range(0, len(FILE_NAMES), 2)]
)
def test_hostile_file_names_stay_text(opened: Open, tmp_path: Path, first: int) -> None:
    moving, fixed = FILE_NAMES[first], FILE_NAMES[(first + 1) % len(FILE_NAMES)]
    try:
        shutil.copy(SPHERE, tmp_path / moving)
        shutil.copy(PLATE, tmp_path / fixed)
    except OSError as error:
        pytest.skip(f"no file system for this name: {error.strerror}")
    motion = poses(tmp_path, (0, 20, 0))
    undrawn = mock.patch("geocontact.analyses.frame.pages.save_both", return_value=b"")
    with mock.patch("geocontact.analyses.area.motion_outputs.area_figure"), undrawn:
        result = done(
            area(tmp_path / "out", moving=tmp_path / moving, fixed=tmp_path / fixed, motion=motion, picture=True)
        )
    here = opened(result.folder / "report.html")
    assert here.tab.evaluate("'hacked' in window") is False
    assert here.complaints == [] and len(here.requests) == 1
    texts = here.tab.evaluate("[...document.querySelectorAll('bdi')].map(e => e.textContent)")
    for name in (moving, fixed):
        assert any(name in text for text in texts), name
