"""Landmarks from a synthetic second scan instead of a file."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh

from tests.analyses.mat.samples import CENTRE, FORCE, refusal, shipped, truth
from tests.cli.calls import MESHES
from tests.geometry.drape.second_scan import corners, with_mat

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def second(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A scan with a mat of 3 mm on it, noisy by 0.2 mm."""
    file = tmp_path_factory.mktemp("second") / "thigh_with_mat.stl"
    scan = with_mat(3.0, 0.2)
    trimesh.Trimesh(1e3 * scan.vertices, scan.faces, process=False).export(file)
    return file


def near(corner: int) -> str:
    """Some millimetres beside a true corner."""
    return ",".join(f"{x:.1f}" for x in 1e3 * corners()[corner] + [3.0, -4.0, 2.0])


def test_the_mat_is_found_and_gives_the_wrench_of_its_closed_form(second: Path) -> None:
    result = shipped(landmarks=None, scan_with_mat=second, first_corner=near(0))
    told = result.record.results["second scan"]
    assert told["mat_thickness_mm"] == pytest.approx(3.0, abs=0.2)
    assert told["mat_mm"] == pytest.approx([226.27, 113.14], abs=0.01)
    missed = np.linalg.norm(np.array(told["corners_mm"])[:, None] - 1e3 * corners()[None], axis=2).min(axis=1)
    assert missed.max() < 1.0
    ours, exactly = result.table(), truth()
    k = int(exactly["normal [N]"].argmax())
    assert np.linalg.norm(ours.loc[k, FORCE] - exactly.loc[k, FORCE]) < 0.01 * exactly.loc[k, "normal [N]"]
    assert np.linalg.norm(ours.loc[k, CENTRE] - exactly.loc[k, CENTRE]) < 1.5
    listed = {each["role"]: each for each in result.record.inputs}
    assert listed["scan with the mat"]["faces"] == 63720


def test_the_other_end_may_be_the_first(second: Path) -> None:
    """The recording turned by half a turn: the load is at the other end, 40 mm and more away."""
    ours, exactly = shipped(landmarks=None, scan_with_mat=second, first_corner=near(2)).table(), truth()
    early = int(np.argmax(exactly["normal [N]"].to_numpy() > 10.0))
    assert exactly.loc[early, "cop_y [mm]"] < 0.0 < 40.0 < ours.loc[early, "cop_y [mm]"]


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ({}, "`first_corner`: the outline does not show which corner is that of the first cell; it may be "),
        ({"first_corner": near(1)}, "cannot be that of the first cell"),
        ({"first_corner": near(0), "seen_from": "body"}, "check the corner and `seen_from`"),
        ({"first_corner": near(0), "mat_edge": 0.02}, "stands off is 187 × 73 mm, the mat 226 × 113"),
    ],
)
def test_what_the_second_scan_does_not_show_is_refused(second: Path, options: dict[str, Any], said: str) -> None:
    with refusal(said):
        shipped(landmarks=None, scan_with_mat=second, **options)


def test_a_second_scan_without_the_mat_is_refused() -> None:
    with refusal("is the mat on it?"):
        shipped(landmarks=None, scan_with_mat=MESHES / "thigh.stl")
