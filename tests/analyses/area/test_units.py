"""Units: the same bodies written in m, cm, mm and inches give the same table; a unit that cannot be is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from geocontact.analyses.area.result import AreaResult
from geocontact.data.errors import InputError
from tests.analyses.area.calls import area
from tests.cli.calls import FEMUR, INSERT, agree, corners, gait, shifted, stl, written

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
