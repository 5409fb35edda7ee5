"""Splitting planes beside the body, penetration without an inside, thresholds finer than triangles, units of meshes."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.area import bodies
from geocontact.analyses.area.result import area as analysis
from geocontact.data.errors import InputError
from tests.analyses.area.calls import area
from tests.cli.calls import FEMUR, INSERT, PLATE, SPHERE, corners, gait, poses, stl, written


@pytest.mark.parametrize(
    ("given", "said"),
    [
        (
            {"split": "z=500"},
            "z = 500 mm does not cut tibial_insert_right_coarse.stl, whose faces go from -37.5 to 37.5 mm; write for",
        ),
        ({"split": "z=-37.5"}, "`split`: z = -37.5 mm does not cut"),
        ({"split": "z", "region": "z>5"}, "whose faces that count go from "),
    ],
)
def test_a_plane_beside_the_body_is_refused_with_where_the_body_is(tmp_path: Path, given: dict, said: str) -> None:
    with pytest.raises(InputError) as refused:
        area(FEMUR, INSERT, gait(tmp_path), side="right", **given)
    assert said in str(refused.value)


def test_a_plane_just_within_the_body_is_used(tmp_path: Path) -> None:
    result = area(FEMUR, INSERT, gait(tmp_path, [0]), split="z=37", side="right")
    assert result.motions[0].evolution.fixed.negative[0, 0] > 0.0


def opened(folder: Path, name: str, body: Path) -> Path:
    """A body with one face less."""
    return written(folder / name, stl(corners(body)[1:]))


def test_zero_counts_what_is_inside(tmp_path: Path) -> None:
    """A cap of a sphere 0.2 mm deep in a plate: 2 pi r h of the sphere, less what facets cut off."""
    result = area(SPHERE, PLATE, poses(tmp_path, (1, 19.8, 2)), threshold=0.0)
    found = result.motions[0].evolution.moving.area[0, 0]
    assert found == pytest.approx(2.0 * np.pi * 20e-3 * 0.2e-3, rel=0.25)
    with pytest.raises(InputError, match="`threshold`: 0 counts what is inside the other body"):
        area(
            opened(tmp_path, "a.stl", PLATE), opened(tmp_path, "b.stl", SPHERE), poses(tmp_path, (1, 19.8, 2)),
            threshold=0.0,
        )  # fmt: skip


@pytest.mark.parametrize(
    ("given", "pieces"),
    [
        ({"threshold": 0.0}, bodies.FEW),
        ({"threshold": 1e-5}, bodies.FEW),
        ({"threshold": 1e-4}, bodies.BRIEF),
        ({"threshold": 0.0, "bounds": 0.05}, bodies.PATIENT),
    ],
)
def test_thresholds_finer_than_triangles_are_not_divided_for_long(tmp_path: Path, given: dict, pieces: int) -> None:
    given["threshold"] = (given["threshold"],)
    options = analysis.options(FEMUR, INSERT, unit="mm", motion=str(gait(tmp_path)), **given)
    assert bodies.read(options).settings.refinement.pieces == pieces


def test_bounds_that_stay_wide_say_how_to_narrow_them(tmp_path: Path) -> None:
    result = area(FEMUR, INSERT, gait(tmp_path, [25]), threshold=0.0)
    assert any("asked for 10.0% (`bounds` 10% divides triangles longer)" in line for line in result.warnings)


def test_an_implant_in_mm_is_refused_in_inches(tmp_path: Path) -> None:
    """106 mm would be 2.7 m."""
    with pytest.raises(InputError, match="too large for an implant or a body; the file looks like millimetres, pass"):
        area(FEMUR, INSERT, gait(tmp_path), unit="in")


def test_more_than_the_whole_is_no_share() -> None:
    with pytest.raises(InputError, match="`bounds`: 200 % cannot be a share"):
        analysis.options(FEMUR, INSERT, unit="mm", motion="gait.csv", bounds=2.0)
