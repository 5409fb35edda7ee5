"""STL files whose header names anatomical axes, as 3D Slicer writes them."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

import geocontact as gc
from geocontact.data.errors import InputError
from tests.analyses.area.calls import area
from tests.cli.calls import PLATE, SPHERE, poses, shifted, written

SIDES = [("LPS", "right", "+"), ("LPS", "left", "-"), ("RAS", "right", "-")]


def from_slicer(folder: Path, mesh: Path, space: str) -> Path:
    """The same mesh with 3D Slicer's header."""
    head = f"3D Slicer output. SPACE={space}".encode().ljust(80, b" ")
    return written(folder / f"{space}_{mesh.name}", head + mesh.read_bytes()[80:])


@pytest.mark.parametrize(
    ("head", "space"),
    [
        (b"3D Slicer output. SPACE=LPS".ljust(80), "LPS"),
        (b"3D Slicer output. SPACE=RAS".ljust(80), "RAS"),
        (b"ITK SPACE=XYZ".ljust(80), ""),
        (b"made with NOSPACE=LPS".ljust(80), ""),
    ],
)
def test_the_header_of_a_binary_file(tmp_path: Path, head: bytes, space: str) -> None:
    assert gc.read_mesh(written(tmp_path / "a.stl", head + SPHERE.read_bytes()[80:]), "mm").space == space


def test_the_first_line_of_an_ascii_file(tmp_path: Path) -> None:
    facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 30 0 0\nvertex 0 30 0\nendloop\nendfacet\n"
    text = f"solid 3D Slicer output. SPACE=RAS\n{facet}endsolid\n"
    assert gc.read_mesh(written(tmp_path / "a.stl", text), "mm").space == "RAS"


def test_axes_are_told_and_recorded(tmp_path: Path) -> None:
    moving, fixed = (from_slicer(tmp_path, mesh, "LPS") for mesh in (SPHERE, PLATE))
    found = area(moving, fixed, poses(tmp_path, (0, 20, 0)))
    assert f"{moving.name}: its header says SPACE=LPS, x to the left, y to the back, z up" in found.sentences
    assert [entry.get("space") for entry in found.record.inputs[:2]] == ["LPS", "LPS"]


def test_two_spaces_are_refused_unless_one_body_is_placed(tmp_path: Path) -> None:
    moving, fixed = from_slicer(tmp_path, SPHERE, "LPS"), from_slicer(tmp_path, PLATE, "RAS")
    motion = poses(tmp_path, (0, 20, 0))
    with pytest.raises(InputError, match=r"is in LPS and RAS_plate.* in RAS: their x and y point opposite ways"):
        area(moving, fixed, motion)
    assert area(moving, fixed, motion, place_moving=str(shifted(tmp_path, (0, 0, 0)))).table()["area_fixed [mm^2]"][0]


@pytest.mark.parametrize(("space", "side", "medial"), SIDES)
def test_a_side_decides_nothing_where_z_points_up(tmp_path: Path, space: str, side: Any, medial: str) -> None:
    fixed, motion = from_slicer(tmp_path, PLATE, space), poses(tmp_path, (0, 20, 0))
    with pytest.raises(InputError) as refused:
        area(SPHERE, fixed, motion, split="z", side=side)
    assert str(refused.value).endswith(f"give `split` x and `medial` {medial}")
