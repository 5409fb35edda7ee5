"""Input that is used with a reservation: the result holds it, and says it."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

from geocontact.analyses.area.result import AreaResult
from geocontact.analyses.area.result import area as analysis
from geocontact.data.errors import InputWarning
from tests.analyses.area.calls import area
from tests.cli.calls import (
    FEMUR,
    INSERT,
    KNEE,
    PLATE,
    SPHERE,
    agree,
    corners,
    poses,
    stl,
    storage,
    written,
)

JOINT = {"osim": KNEE, "joint": "knee_r"}
MAP = "rz=-knee_flexion,rx=-knee_adduction,tx=knee_tx,ty=knee_ty,tz=knee_tz"


def called(given: dict) -> AreaResult:
    """The analysis of bodies, motion and options."""
    return area(given.pop("moving"), given.pop("fixed"), given.pop("motion"), **given)


def altered(change: Callable[[np.ndarray], np.ndarray]) -> Callable[[Path], dict]:
    """A sphere whose corners were changed, on the plate."""

    def made(folder: Path) -> dict:
        return {
            "moving": written(folder / "changed.stl", stl(change(corners(SPHERE)))),
            "fixed": PLATE,
            "motion": poses(folder, (1, 19.8, 2)),
        }

    return made


def with_flat_face(points: np.ndarray) -> np.ndarray:
    """A face without area whose corners are one corner of the sphere: nothing is torn open."""
    return np.concatenate([points, np.repeat(points[:1, :1], 3, axis=1)])


def with_face_again(points: np.ndarray) -> np.ndarray:
    return np.concatenate([points, points[5:6]])


def without_a_far_face(points: np.ndarray) -> np.ndarray:
    return np.delete(points, np.argmax(points[:, :, 1].mean(axis=1)), axis=0)


def inside_out(points: np.ndarray) -> np.ndarray:
    return points[:, ::-1]


def inside_out_with_a_face_again(points: np.ndarray) -> np.ndarray:
    return with_face_again(inside_out(points))


def coordinates(folder: Path) -> Path:
    """The cycle without its rotation column."""
    file = storage(folder, [30])
    lines = file.read_text(encoding="utf-8").replace("nColumns=7", "nColumns=6").splitlines()
    start = lines.index("endheader") + 1
    rows = ["\t".join(np.delete(line.split(), 3)) for line in lines[start:]]
    return written(file, "\n".join([*lines[:start], *rows]) + "\n")


def knee(**options: object) -> Callable[[Path], dict]:
    """The insert on the femoral component by coordinates of which one is missing."""
    return lambda folder: {"moving": INSERT, "fixed": FEMUR, "motion": coordinates(folder), **options}


def stretched(length: float) -> Callable[[Path], dict]:
    return lambda folder: {"moving": SPHERE, "fixed": PLATE, "motion": poses(folder, (1, 19.8, 2, length, 0, 0, 0))}


def euler(unit: str, angle: float) -> Callable[[Path], dict]:
    """The sphere turned by Euler angles whose header says `unit`, read as radians on the user's word."""
    text = f"time [s],tx [mm],ty [mm],tz [mm],rx{unit},ry{unit},rz{unit}\n0,1,19.8,2,0.1,{angle},0.2\n"
    given = {"moving": SPHERE, "fixed": PLATE, "order": "XYZ", "angles": "rad"}
    return lambda folder: {**given, "motion": written(folder / "turned.csv", text)}


def contradictory(folder: Path) -> dict:
    """The cycle whose text says radians where its flag says degrees, read as degrees on the user's word."""
    file = storage(folder, [30])
    text = file.read_text(encoding="utf-8").replace("inDegrees=yes\n", "inDegrees=yes\nAngles are in radians.\n")
    return {"moving": INSERT, "fixed": FEMUR, "motion": written(file, text), **JOINT, "angles": "deg"}


WARNED: dict[str, tuple[Callable[[Path], dict], str, tuple[str, ...]]] = {
    "degenerate face": (altered(with_flat_face), "both", ("changed.stl: 1 degenerate face", "first is face 2880")),
    "duplicate face": (altered(with_face_again), "moving", ("changed.stl: 1 duplicate face", "first is face 2880")),
    "open body": (altered(without_a_far_face), "moving", ("changed.stl is open", "area_fixed is unsigned")),
    "faces pointing inwards": (altered(inside_out), "both", ("changed.stl: faces point inwards",)),
    "faces pointing inwards, one of them twice": (
        altered(inside_out_with_a_face_again),
        "moving",
        ("changed.stl: faces point inwards",),
    ),
    "a hole that is none": (
        altered(inside_out_with_a_face_again),
        "moving",
        ("area_fixed is unsigned", "its doubled faces alone keep it open: see `assume_closed` moving"),
    ),
    "missing coordinate": (
        knee(**JOINT),
        "both",
        ("gait.mot: no column for 1 coordinate", "knee_rotation = 0"),
    ),
    "unmapped rotation": (knee(map=MAP), "both", ("gait.mot: nothing is mapped to ry; taken as 0",)),
    "quaternion a little long": (
        stretched(1.0009),
        "both",
        ("poses.csv: quaternion length up to 1.0009", "normalised"),
    ),
    "quaternion a little short": (stretched(0.9991), "both", ("poses.csv: quaternion length", "normalised")),
    "angles against the header": (euler(" [deg]", 0.3), "both", ("turned.csv: says deg, read as rad as asked for",)),
    "angles where the header contradicts itself": (
        contradictory,
        "both",
        ("gait.mot line", "inDegrees=yes but the text says radians", "read as deg as asked for"),
    ),
    "degrees read as radians": (
        euler("", -45.0),
        "both",
        ("turned.csv line 2: column 'ry' reaches 45, much for radians", "`angles` deg"),
    ),
}


@pytest.mark.parametrize(("made", "signed", "said"), WARNED.values(), ids=WARNED.keys())
def test_doubtful_input_is_used_with_a_warning(
    tmp_path: Path, made: Callable[[Path], dict], signed: str, said: tuple[str, ...]
) -> None:
    result = called(made(tmp_path))
    assert any(all(part in line for part in said) for line in result.warnings), result.warnings
    assert all(f"warning: {line}" in str(result) for line in result.warnings)
    assert len(set(result.warnings)) == len(result.warnings) and result.motions[0].reservations == result.warnings
    assert list(result.table()["signed"]) == [signed]


def test_radians_of_an_ordinary_size_are_not_warned_of(tmp_path: Path) -> None:
    assert called(euler("", 3.1)(tmp_path)).warnings == ()


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> AreaResult:
    """The sphere on the plate, nothing wrong with it."""
    result = area(SPHERE, PLATE, poses(tmp_path_factory.mktemp("sound"), (1, 19.8, 2)))
    assert result.warnings == ()
    return result


@pytest.mark.parametrize("change", [with_flat_face, inside_out])
def test_what_was_warned_of_does_not_change_the_result(
    tmp_path: Path, sound: AreaResult, change: Callable[[np.ndarray], np.ndarray]
) -> None:
    result = called(altered(change)(tmp_path))
    agree(result.table(), sound.table(), areas=1e-9)


def test_quaternions_are_normalised(tmp_path: Path, sound: AreaResult) -> None:
    agree(called(stretched(1.0009)(tmp_path)).table(), sound.table(), areas=1e-9)


def test_a_missing_coordinate_keeps_its_default(tmp_path: Path) -> None:
    """By the model and by the map the rotation is 0, and so are the tables the same."""
    given = (INSERT, FEMUR, coordinates(tmp_path))
    by_model, by_map = area(*given, **JOINT).table(), area(*given, map=MAP).table()
    agree(by_model, by_map, areas=1e-9)


def test_gaps_in_a_column_that_is_not_used_do_not_matter(tmp_path: Path, sound: AreaResult) -> None:
    head = "time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz,force [N]"
    motion = written(tmp_path / "poses.csv", head + "\n0,1,19.8,2,1,0,0,0,nan\n")
    result = area(SPHERE, PLATE, motion)
    assert result.warnings == ()
    pd.testing.assert_frame_equal(result.table(), sound.table(), check_exact=True)


def test_bounds_that_cannot_be_reached_are_said(tmp_path: Path, sound: AreaResult) -> None:
    """A rule that does not divide triangles cannot narrow its bounds: asked for, not given, said."""
    result = area(SPHERE, PLATE, poses(tmp_path, (1, 19.8, 2)), rule="clip", bounds=1e-6)
    assert any("bounds" in line for line in result.warnings), "asked-for bounds were silently not delivered"


def test_an_angle_unit_against_the_file_is_said(tmp_path: Path) -> None:
    """Degrees read as radians on the user's word: the pose is another one, and the line says why."""
    file = storage(tmp_path, [0])
    text = file.read_text(encoding="utf-8").replace("6.603143", "0.1152").replace("-1.525067", "-0.0266")
    written(file, text)
    result = area(INSERT, FEMUR, file, **JOINT, angles="rad")
    assert any("says deg, read as rad as asked for" in line for line in result.warnings)


def test_reservations_are_python_warnings_too(tmp_path: Path) -> None:
    moving = written(tmp_path / "changed.stl", stl(without_a_far_face(corners(SPHERE))))
    with pytest.warns(InputWarning, match=r"changed\.stl is open .*: area_fixed is unsigned"):
        analysis(moving, PLATE, unit="mm", motion=(str(poses(tmp_path, (1, 19.8, 2))),))


def test_a_frame_far_off_is_told(tmp_path: Path) -> None:
    motion = poses(tmp_path, (0, 20, 0), (0, 50, 0), (0, 20, 0))
    said = " ".join(area(SPHERE, PLATE, motion, rule="clip").warnings)
    assert "1 of 3 frames have nothing within 4 mm" in said
    assert "farthest apart, 30 mm, in frame 2 of 3" in said and "exchanged" in said


@pytest.mark.parametrize(("height", "told"), [(19.5, False), (17.0, True)])
def test_rigid_bodies_that_overlap_are_told(tmp_path: Path, height: float, told: bool) -> None:
    said = " ".join(area(SPHERE, PLATE, poses(tmp_path, (0, height, 0)), rule="clip").warnings)
    assert ("the bodies overlap, by 3.00 mm at most" in said) == told
