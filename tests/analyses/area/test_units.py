"""Units: the same bodies written in m, cm, mm and inches give the same table; a unit that cannot be is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.area.result import AreaResult
from geocontact.data.errors import InputError
from geocontact.io.mesh.meshes import read_mesh
from tests.analyses.area.calls import area
from tests.cli.calls import FEMUR, INSERT, PLATE, SPHERE, agree, corners, gait, in_metres, shifted, stl, written

PER_MM = {"m": 1e-3, "cm": 0.1, "mm": 1.0, "in": 1 / 25.4}
WORDS = {"m": "metres", "cm": "centimetres", "mm": "millimetres", "in": "inches"}


@pytest.fixture(scope="module")
def knee(tmp_path_factory: pytest.TempPathFactory) -> AreaResult:
    """Options that hold lengths in the mesh unit, in mm."""
    folder = tmp_path_factory.mktemp("knee")
    return area(FEMUR, INSERT, gait(folder), **in_mesh_units(folder, "mm"))


def in_mesh_units(folder: Path, unit: str) -> dict[str, str]:
    """Options that hold lengths in the mesh unit; MOVING half a millimetre to the front."""
    return {
        "unit": unit,
        "split": f"z={4 * PER_MM[unit]!r}",
        "side": "right",
        "region": f"x > {-15 * PER_MM[unit]!r} and ny > 0.25",
        "place_moving": str(shifted(folder, (0.5 * PER_MM[unit], 0, 0))),
        "rule": "clip",
    }


def rewritten(folder: Path, mesh: Path, unit: str) -> Path:
    """The shipped mesh in another unit; float32 costs seven digits."""
    return written(folder / mesh.name, stl(corners(mesh) * PER_MM[unit]))


@pytest.mark.parametrize("unit", ["m", "cm", "in"])
def test_the_unit_of_the_meshes_does_not_matter(tmp_path: Path, knee: AreaResult, unit: str) -> None:
    """Areas to 1e-6, lengths to 1e-5 mm; the threshold and the motion keep their own units."""
    bodies = [rewritten(tmp_path, mesh, unit) for mesh in (FEMUR, INSERT)]
    result = area(*bodies, gait(tmp_path), **in_mesh_units(tmp_path, unit))
    agree(result.table(), knee.table(), areas=1e-6, lengths=1e-5)
    ours, theirs = (
        [length for entry in call.record.inputs for length in entry.get("box_mm", [])] for call in (result, knee)
    )
    assert ours == pytest.approx(theirs, rel=1e-6)


@pytest.mark.parametrize("unit", ["m", "in"])
def test_the_refined_area_does_not_depend_on_the_unit_either(tmp_path: Path, unit: str) -> None:
    """Which triangles are divided may hang on the last digit: areas within a tenth of the stated accuracy."""
    motion = gait(tmp_path, [30])
    bodies = [rewritten(tmp_path, mesh, unit) for mesh in (FEMUR, INSERT)]
    ours = area(*bodies, motion, unit=unit).table()
    theirs = area(FEMUR, INSERT, motion).table()
    names = ["area_fixed [mm^2]", "area_moving [mm^2]"]
    assert ours[names].to_numpy() == pytest.approx(theirs[names].to_numpy(), rel=1e-4)


@pytest.mark.parametrize(("true", "said"), [("m", "mm"), ("mm", "m"), ("m", "cm"), ("cm", "m")])
def test_an_absurd_unit_is_refused_with_the_likely_one(tmp_path: Path, true: str, said: str) -> None:
    bodies = [rewritten(tmp_path, mesh, true) for mesh in (FEMUR, INSERT)]
    with pytest.raises(InputError) as refused:
        area(*bodies, gait(tmp_path), unit=said)
    line = str(refused.value)
    likely = {"m": "m", "mm": "mm", "cm": "mm"}[true]  # a 7 x 6 x 6 of cm could be mm as well
    assert FEMUR.name in line and "bounding box" in line
    assert any(f"{WORDS[unit]}, pass `unit` {unit}" in line for unit in (likely, true))


@pytest.mark.parametrize("moving_in_metres", [True, False])
def test_a_unit_for_each_body_gives_the_same_table_to_the_last_digit(tmp_path: Path, moving_in_metres: bool) -> None:
    """Each body's region and place are in its own unit, the splitting plane is in that of FIXED."""
    own, other = ("m", "mm") if moving_in_metres else ("mm", "m")
    motion = gait(tmp_path, [0, 30])
    place = {unit: str(shifted(made(tmp_path / unit), (0.5 * PER_MM[unit], 0, 0))) for unit in ("m", "mm")}
    region = {unit: f"x > {-15 * PER_MM[unit]!r}" for unit in ("m", "mm")}
    split = {"m": "z=0.004", "mm": "z=4"}

    def options(unit: str, moving: str) -> dict[str, str]:
        places = {"place_moving": place[moving], "region_moving": region[moving], "region": region[unit]}
        return {"unit": unit, "split": split[unit], "side": "right", "rule": "clip", **places}

    bodies = [in_metres(tmp_path, FEMUR), INSERT] if moving_in_metres else [FEMUR, in_metres(tmp_path, INSERT)]
    apart = area(*bodies, motion, unit_moving=own, **options(other, own))
    pd.testing.assert_frame_equal(apart.table(), area(FEMUR, INSERT, motion, **options("mm", "mm")).table())
    assert [entry["unit"] for entry in apart.record.inputs if "unit" in entry] == [own, other]


def made(folder: Path) -> Path:
    folder.mkdir()
    return folder


def test_a_wrong_unit_of_one_body_names_its_own_option(tmp_path: Path) -> None:
    motion = gait(tmp_path, [0])
    with pytest.raises(InputError, match=rf"{FEMUR.name}: bounding box .* pass `unit_moving` mm$"):
        area(FEMUR, in_metres(tmp_path, INSERT), motion, unit="m", unit_moving="m")
    with pytest.raises(InputError, match=r"insert.*: bounding box .* pass `unit` m$"):
        area(FEMUR, in_metres(tmp_path, INSERT), motion, unit="mm", unit_moving="mm")
    with pytest.raises(InputError, match="`unit_moving`: 'km' is not a choice; one of m, cm, mm, in"):
        area(FEMUR, INSERT, motion, unit_moving="km")


def test_a_jittered_ball_has_the_areas_of_the_clean_one(tmp_path: Path) -> None:
    """2e-5 mm of rounding: every edge is open without a tolerance, and FIXED's area is unsigned."""
    clean = read_mesh(SPHERE, "mm").vertices[read_mesh(SPHERE, "mm").faces] * 1e3
    jitter = np.random.default_rng(4).normal(0.0, 2e-5, clean.shape)
    triangles = "".join(
        "facet normal 0 0 0\nouter loop\n"
        + "".join("vertex {!r} {!r} {!r}\n".format(*row) for row in face)
        + "endloop\nendfacet\n"
        for face in (clean + jitter).tolist()
    )
    ball = written(tmp_path / "ball.stl", f"solid\n{triangles}endsolid\n")
    motion = written(tmp_path / "m.csv", "time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz\n0,0.3,19,0.1,1,0,0,0\n")
    given = {"threshold": (1e-3, 4e-3), "rule": "clip"}
    merged = area(ball, PLATE, motion, merge_tolerance=gc.mm(3e-4), **given)
    expected = area(SPHERE, PLATE, motion, **given).table()
    assert list(merged.table()["signed"]) == list(expected["signed"])
    names = ["area_fixed [mm^2]", "area_moving [mm^2]"]
    np.testing.assert_allclose(merged.table()[names], expected[names], rtol=1e-5)
    assert any("of each other merged into 1442" in line for line in merged.warnings)
    assert list(area(ball, PLATE, motion, **given).table()["signed"]) != list(expected["signed"])
