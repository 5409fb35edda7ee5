"""What of a run goes into its page, its stills and its series for ParaView."""

from __future__ import annotations

import html
import re
import sys
from pathlib import Path
from unittest import mock

import numpy as np
import pytest

from geocontact.view.surfaces.still import Still
from tests.cli.calls import FEMUR, INSERT, PLATE, SPHERE, Call, area, done, gait, poses, written

NOTE = "drawn by matplotlib: there is no driver here"


def text(result: Call, folder: str = "") -> str:
    """Texts of a page without its data."""
    page = result.bytes(f"{folder}/report.html" if folder else "report.html").decode()
    page = re.sub(r"<(script|style)\b.*?</\1>", " ", page, flags=re.DOTALL)
    return " ".join(html.unescape(re.sub(r"<[^>]+>", " ", page)).split())


@pytest.fixture(scope="module")
def everything(tmp_path_factory: pytest.TempPathFactory) -> tuple[Call, mock.Mock, mock.Mock]:
    """A knee with a comparison, stills and the series, the last two only noted down; most contact in frame 2 of 3."""
    folder = tmp_path_factory.mktemp("report")
    measured = written(folder / "measured.csv", "time [s],threshold [mm],area_fixed [mm^2]\n0.3,4,2400\n")
    options = (
        "--threshold",
        "4,1",
        "--split",
        "z",
        "--side",
        "right",
        "--compare",
        measured,
        "--tolerance",
        "90%",
        "--bounds",
        "1e-9",
    )
    patched = "geocontact.analyses.area.figure"
    with (
        mock.patch(f"{patched}.draw_stills", return_value=(Still(Path("x.png"), "matplotlib", NOTE),)) as stills,
        mock.patch(f"{patched}.write_vtp_series") as series,
        mock.patch("geocontact.analyses.area.result.FRAMES", 1),
        mock.patch("geocontact.analyses.area.bodies.PATIENT", 1),
    ):
        result = done(
            area(folder / "out", *options, "--stills", "--paraview", moving=FEMUR, fixed=INSERT,
                 motion=gait(folder, (30, 57, 75)), picture=True)
        )  # fmt: skip
    return result, stills, series


def test_page_tells_the_whole_run(everything: tuple[Call, mock.Mock, mock.Mock]) -> None:
    result, *_ = everything
    said = text(result)
    for part in (
        f"MOVING {FEMUR.name} on FIXED {INSERT.name}",
        "Compared with the measured areas", "2400",
        "How it was made", "threshold 4,1", "split z",
        "How much the threshold matters",
        "medial (−z)",
        NOTE,
        *(warning for warning in result.warnings if "bounds of area_fixed" in warning),
    ):  # fmt: skip
        assert part in said, part
    assert any("bounds of area_fixed" in warning for warning in result.warnings)
    assert NOTE in result.warnings


def test_stills_show_the_frame_of_most_contact_from_the_medial_side_too(
    everything: tuple[Call, mock.Mock, mock.Mock],
) -> None:
    result, stills, _ = everything
    table = result.table().query("`threshold [mm]` == 4").reset_index(drop=True)
    largest = int(table["area_fixed [mm^2]"].idxmax())
    scene, views, _title = stills.call_args.args
    assert scene.time == table["time [s]"][largest]
    assert largest == 1
    assert {file.name: view.seen_from for file, view in views.items()} == {
        "still_medial.png": (0.0, 0.0, -1.0),
        "still_lateral.png": (0.0, 0.0, 1.0),
        "still_plus_x.png": (1.0, 0.0, 0.0),
        "still_minus_x.png": (-1.0, 0.0, 0.0),
        "still_plus_y.png": (0.0, 1.0, 0.0),
        "still_minus_y.png": (0.0, -1.0, 0.0),
    }


def test_series_for_paraview_has_every_frame(everything: tuple[Call, mock.Mock, mock.Mock]) -> None:
    result, _, series = everything
    given = series.call_args.args[0]
    assert list(given.time) == sorted(set(result.table()["time [s]"])) and len(given.fixed.distance) == 3


def test_each_motion_has_its_own_inputs_and_reservations(tmp_path: Path) -> None:
    files = [poses(tmp_path, (0, 20 + k, 0), name=f"{name}.csv") for k, name in enumerate(("slow", "fast"))]
    words = [word for file in files for word in ("--motion", file)]
    result = done(area(tmp_path / "out", *words, moving=SPHERE, fixed=PLATE, picture=True))
    slow, fast = (text(result, name) for name in ("slow", "fast"))
    assert "slow.csv" in slow and "fast.csv" in fast
    for said, other in ((slow, files[1]), (fast, files[0])):
        digest = next(i["sha256"] for i in result.record()["inputs"] if Path(i["file"]).name == other.name)
        assert digest not in said


@pytest.mark.parametrize("threshold", ["0", "0mm,1"])
def test_a_threshold_of_zero_is_an_analysis_like_any_other(tmp_path: Path, threshold: str) -> None:
    motion = poses(tmp_path, (0, 19.5, 0), (0, 22, 0))
    result = done(
        area(tmp_path / "out", "--threshold", threshold, moving=SPHERE, fixed=PLATE, motion=motion, picture=True)
    )
    assert result.table()["area_fixed [mm^2]"].iloc[0] > 0.0
    assert "0 mm" in text(result)


def test_series_for_paraview_needs_pyvista_before_anything_is_computed(tmp_path: Path) -> None:
    motion = poses(tmp_path, (0, 20, 0))
    with (
        mock.patch.dict(sys.modules, {"pyvista": None}),
        mock.patch("geocontact.analyses.area.result.area_evolution") as computed,
    ):
        result = area(tmp_path / "out", "--paraview", moving=SPHERE, fixed=PLATE, motion=motion)
    assert result.code == 2 and len(result.complaints) == 1 and "pyvista" in result.err
    assert not computed.called and not (tmp_path / "out").exists()


def test_long_motions_write_a_page_of_few_frames(tmp_path: Path) -> None:
    """The frame of most contact is the 4th of 9; the page shows it and counts as the table does."""
    heights = (22.0, 24.0, 23.0, 20.5, 26.0, 21.0, 22.0, 23.0, 30.0)
    motion = poses(tmp_path, *((0, height, 0) for height in heights))
    with mock.patch("geocontact.analyses.area.result.FRAMES", 3), mock.patch("geocontact.analyses.area.page.FRAMES", 3):
        result = done(area(tmp_path / "out", moving=SPHERE, fixed=PLATE, motion=motion, picture=True))
    said = text(result)
    assert "4 mm of sphere_r20, at 3 s" in said and "of 9 frames" in said
    assert f"{result.table()['area_fixed [mm^2]'].iloc[3]:.2f}" in said
    assert np.argmax(result.table()["area_fixed [mm^2]"]) == 3
