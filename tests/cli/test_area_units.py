"""Units: the same bodies written in m, cm, mm and inches give the same table; a unit that cannot be is refused."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.calls import FEMUR, INSERT, Call, agree, area, corners, done, gait, shifted, stl, written

PER_MM = {"m": 1e-3, "cm": 0.1, "mm": 1.0, "in": 1 / 25.4}
WORDS = {"m": "metres", "cm": "centimetres", "mm": "millimetres", "in": "inches"}


@pytest.fixture(scope="module")
def knee(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """Options that hold lengths in the mesh unit, in mm."""
    folder = tmp_path_factory.mktemp("knee")
    options = ("--split", "z=4", "--region", "x > -15 and ny > 0.25", *placed(folder, "mm"), "--rule", "clip")
    return done(area(folder / "out", *options, motion=gait(folder)))


def placed(folder: Path, unit: str) -> tuple[str, Path]:
    """MOVING half a millimetre to the front."""
    return "--place-moving", shifted(folder, (0.5 * PER_MM[unit], 0, 0))


def rewritten(folder: Path, mesh: Path, unit: str) -> Path:
    """The shipped mesh in another unit; float32 costs seven digits."""
    return written(folder / mesh.name, stl(corners(mesh) * PER_MM[unit]))


@pytest.mark.parametrize("unit", ["m", "cm", "in"])
def test_the_unit_of_the_meshes_does_not_matter(tmp_path: Path, knee: Call, unit: str) -> None:
    """Areas to 1e-6, lengths to 1e-5 mm; the threshold and the motion keep their own units."""
    options = (
        "--split", f"z={4 * PER_MM[unit]!r}", "--region", f"x > {-15 * PER_MM[unit]!r} and ny > 0.25",
        *placed(tmp_path, unit), "--rule", "clip",
    )  # fmt: skip
    bodies = {"moving": rewritten(tmp_path, FEMUR, unit), "fixed": rewritten(tmp_path, INSERT, unit)}
    result = done(area(tmp_path / "out", *options, **bodies, motion=gait(tmp_path), unit=unit))
    agree(result.table(), knee.table(), areas=1e-6, lengths=1e-5)
    ours, theirs = (
        [length for entry in call.record()["inputs"] for length in entry.get("box_mm", [])] for call in (result, knee)
    )
    assert ours == pytest.approx(theirs, rel=1e-6)


@pytest.mark.parametrize("unit", ["m", "in"])
def test_the_refined_area_does_not_depend_on_the_unit_either(tmp_path: Path, unit: str) -> None:
    """Which triangles are divided may hang on the last digit: areas within a tenth of the stated accuracy."""
    motion = gait(tmp_path, [30])
    bodies = {"moving": rewritten(tmp_path, FEMUR, unit), "fixed": rewritten(tmp_path, INSERT, unit)}
    ours = done(area(tmp_path / "a", **bodies, motion=motion, unit=unit)).table()
    theirs = done(area(tmp_path / "b", motion=motion)).table()
    names = ["area_fixed [mm^2]", "area_moving [mm^2]"]
    assert ours[names].to_numpy() == pytest.approx(theirs[names].to_numpy(), rel=1e-4)


@pytest.mark.parametrize(("true", "said"), [("m", "mm"), ("mm", "m"), ("m", "cm"), ("cm", "m")])
def test_an_absurd_unit_is_refused_with_the_likely_one(tmp_path: Path, true: str, said: str) -> None:
    bodies = {"moving": rewritten(tmp_path, FEMUR, true), "fixed": rewritten(tmp_path, INSERT, true)}
    result = area(tmp_path / "out", **bodies, motion=gait(tmp_path), unit=said)
    assert result.code == 2
    (line,) = result.complaints
    likely = {"m": "m", "mm": "mm", "cm": "mm"}[true]  # a 7 x 6 x 6 of cm could be mm as well
    assert FEMUR.name in line and "bounding box" in line
    assert f"{WORDS[likely]}, pass --unit {likely}" in line or f"{WORDS[true]}, pass --unit {true}" in line
    assert not (tmp_path / "out").exists()
