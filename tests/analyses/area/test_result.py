"""What a result of the area analysis shows: page, figure and folders, of one motion and of several."""

from __future__ import annotations

from pathlib import Path

import pytest

from geocontact.analyses.area.result import AreaResult
from tests.analyses.area.calls import area
from tests.cli.calls import PLATE, SPHERE, inventory, poses, unpictured


@pytest.fixture
def several(tmp_path: Path) -> AreaResult:
    """The ball at two heights, a motion each."""
    files = [poses(tmp_path, (0, 20 + k, 0), name=f"{name}.csv") for k, name in enumerate(("slow", "fast"))]
    return area(SPHERE, PLATE, *files, rule="clip")


def test_page_of_one_motion_is_that_of_the_folder(tmp_path: Path) -> None:
    result = area(SPHERE, PLATE, poses(tmp_path, (0, 20, 0)), rule="clip")
    page = result.page(tmp_path / "page.html").read_text(encoding="utf-8")
    assert "Largest contact area on the fixed body" in page and "sphere_r20.stl" in page
    assert result._repr_html_().startswith("<p>area of FIXED within 4 mm") and "<img src=" in result._repr_html_()


def test_several_motions_have_folders_and_one_page_of_all_numbers(several: AreaResult, tmp_path: Path) -> None:
    assert several.folders == ("", "slow", "fast")
    assert several.table().equals(several.table("slow/area")), "the first motion comes first"
    page = several.page(tmp_path / "page.html").read_text(encoding="utf-8")
    assert "slow/area" in page and "fast/area" in page
    assert "Fast: area of FIXED within 4\u00a0mm" in page
    with unpictured():
        out = several.write(tmp_path / "out")
    files = {f"{name}/{file}" for name in ("slow", "fast") for file in ("area.csv", "run.json")}
    assert set(inventory(out)) == {"run.json", "slow", "fast"} | files


def test_a_comparison_of_one_motion_decides_for_all(tmp_path: Path) -> None:
    files = [poses(tmp_path, (0, 20 + k, 0), name=f"{name}.csv") for k, name in enumerate(("slow", "fast"))]
    measured = tmp_path / "measured.csv"
    alone = area(SPHERE, PLATE, files[0], rule="clip").table()["area_fixed [mm^2]"][0]
    measured.write_text(f"time [s],area_fixed [mm^2]\n0,{alone}\n")
    result = area(SPHERE, PLATE, *files, rule="clip", compare=measured)
    assert set(result.tables()) == {f"{name}/{t}" for name in ("slow", "fast") for t in ("area", "comparison")}
    assert not result.accepted and area(SPHERE, PLATE, files[0], rule="clip", compare=measured).accepted
