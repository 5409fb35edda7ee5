"""Several closed surfaces in one file: the area of the outer one by hand, and what is said where all count."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.area.result import AreaResult
from tests.analyses.area.calls import area
from tests.cli.calls import poses, stl, written
from tests.geometry.bodies import cube, joined

HEIGHTS = (2, 1, -1)  # of MOVING above FIXED [mm]
RIGHT = [20 * 20 + 80 * (3 - height) for height in HEIGHTS]  # mm²: FIXED's top and a strip of its four sides
BOX = cube((0, -2.5, 0), (10, 2.5, 10))
OVERLAPPING = joined(cube((-4, -2.5, 0), (6, 2.5, 10)), cube((4, -2.5, 0), (6, 2.5, 10)))
CAVITY = joined(BOX, (cube((0, -2.85, 0), (8, 1.65, 8))[0], BOX[1][:, ::-1]))  # 1.2 mm below the top, wound inwards
INSIDE = {"cavity": [0.0, 256 + 64 * 0.8, 256 + 64 * 2.8], "overlapping": [128, 176, 272]}
"""mm² by hand. Cavity: its top of 16 · 16 and of its four sides what is less than 3 mm below MOVING. Overlapping: the
top of 4 · 20 that both have; per mm of depth the two ends of 20 mm in the other box, and twice 4 mm of common sides."""


def file(folder: Path, name: str, body, offset: float = 0.0) -> Path:
    return written(folder / f"{name}.stl", stl((body[0] + (offset, 0, 0))[body[1]]))


def called(folder: Path, body, offset: float = 0.0, **options) -> AreaResult:
    above = file(folder, "above", cube((0, 5, 0), (20, 5, 20)), offset)
    fixed = file(folder, "fixed", body, offset)
    motion = poses(folder, *((0, height, 0) for height in HEIGHTS))
    return area(above, fixed, motion, threshold=3e-3, **options)


def areas(result: AreaResult) -> list[float]:
    return list(result.motions[0].evolution.fixed.area[:, 0] * 1e6)


@pytest.mark.parametrize("body", [OVERLAPPING, CAVITY], ids=["overlapping", "cavity"])
def test_the_outer_surface_is_that_of_one_box(body, tmp_path: Path) -> None:
    found = called(tmp_path, body, outer="fixed")
    np.testing.assert_allclose(areas(found), RIGHT, rtol=1e-9)
    np.testing.assert_allclose(found.motions[0].evolution.min_distance * 1e3, HEIGHTS, atol=1e-9)
    assert found.motions[0].evolution.signed == "both"
    assert not any("closed surfaces" in line for line in found.warnings)
    assert any("its outer surface counts" in line for line in found.sentences)


@pytest.mark.parametrize(("body", "kind"), [(OVERLAPPING, "overlapping"), (CAVITY, "cavity")])
def test_what_lies_inside_is_said_in_one_warning(body, kind: str, tmp_path: Path) -> None:
    found = called(tmp_path, body, bounds=0.01)
    inside = np.array(areas(found)) - RIGHT
    np.testing.assert_allclose(inside, INSIDE[kind], atol=1.0)
    words = {"overlapping": "that overlap", "cavity": "one inside the other"}[kind]
    (line,) = [line for line in found.warnings if "closed surfaces" in line]
    assert line.startswith(f"fixed.stl holds 2 closed surfaces{', ' if kind == 'cavity' else ' '}{words}: ")
    assert (
        f"{inside.max():.1f} of the {areas(found)[2]:.1f} mm^2 of area_fixed within 3 mm in frame 3 of 3, 2 s" in line
    )
    assert line.endswith("`outer` fixed counts the outer surface alone")
    (given,) = [each for each in found.record.inputs if each["role"] == "fixed"]
    assert given["closed_surfaces"] == 2


def test_moving_has_an_outer_surface_too(tmp_path: Path) -> None:
    above = joined(cube((-8, 5, 0), (12, 5, 20)), cube((8, 5, 0), (12, 5, 20)))
    moving, fixed = file(tmp_path, "above", above), file(tmp_path, "fixed", BOX)
    motion = poses(tmp_path, *((0, height, 0) for height in HEIGHTS))
    found = area(moving, fixed, motion, threshold=3e-3, outer="both")
    strip = np.sqrt(9.0 - np.array([4.0, 1.0]))  # about FIXED's top, round at its corners
    right = 400 + 80 * strip + np.pi * strip**2
    np.testing.assert_allclose(found.motions[0].evolution.moving.area[:2, 0] * 1e6, right, rtol=0.01)
    twice = area(moving, fixed, motion, threshold=3e-3)
    assert any("of area_moving within 3 mm" in line for line in twice.warnings)
    assert any("`outer` moving" in line for line in twice.warnings)


def test_a_deep_cavity_is_no_reservation(tmp_path: Path) -> None:
    deep = joined(cube((0, -10, 0), 10), cube((0, -10, 0), 4))
    found = called(tmp_path, deep)
    assert not any("closed surfaces" in line for line in found.warnings)
    assert any("one inside the other; nothing of area_fixed within 3 mm lies inside" in s for s in found.sentences)


def test_a_region_names_faces_of_the_file(tmp_path: Path) -> None:
    named = written(tmp_path / "faces.txt", "\n".join(str(k) for k in range(12)))
    found = called(tmp_path, CAVITY, outer="fixed", region=str(named))
    np.testing.assert_allclose(areas(found), RIGHT, rtol=1e-9)
    up = called(tmp_path, OVERLAPPING, outer="fixed", region="ny > 0.5")
    np.testing.assert_allclose(areas(up), [400, 400, 400], rtol=1e-9)


def test_nothing_to_leave_out_is_said(tmp_path: Path) -> None:
    found = called(tmp_path, BOX, outer="both")
    assert any("`outer` both leaves nothing out" in line for line in found.warnings)
    np.testing.assert_allclose(areas(found), RIGHT, rtol=1e-9)


@pytest.mark.parametrize("offset", [0.0, 1e3, 1e4, 1e5, 1e6])
def test_overlap_is_warned_of_wherever_the_bodies_are(offset: float, tmp_path: Path) -> None:
    """1 mm of overlap, in coordinates that single precision holds exactly: the same words at any distance."""
    found = called(tmp_path, BOX, offset)
    assert [line for line in found.warnings if "the bodies overlap" in line] == [
        line for line in called(tmp_path, BOX).warnings if "the bodies overlap" in line
    ]
    assert any("the bodies overlap, by 1.00 mm at most" in line for line in found.warnings)


def test_the_results_hold_the_area_inside(tmp_path: Path) -> None:
    told = called(tmp_path, CAVITY).record.results["inner_surfaces_fixed"]
    assert json.loads(json.dumps(told))["closed_surfaces"] == 2
    assert told["largest_inner_area_mm2"] == pytest.approx(INSIDE["cavity"][2], rel=0.05)
