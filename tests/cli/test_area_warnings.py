"""Input that is used with a reservation: exit 0, `warning: …` on stderr, the same words in run.json."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from tests.cli.calls import (
    FEMUR,
    INSERT,
    KNEE,
    PLATE,
    SPHERE,
    Call,
    agree,
    area,
    corners,
    done,
    poses,
    stl,
    storage,
    written,
)

MAP = "rz=-knee_flexion,rx=-knee_adduction,tx=knee_tx,ty=knee_ty,tz=knee_tz"


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


def coordinates(folder: Path) -> Path:
    """The cycle without its rotation column."""
    file = storage(folder, [30])
    lines = file.read_text(encoding="utf-8").replace("nColumns=7", "nColumns=6").splitlines()
    start = lines.index("endheader") + 1
    rows = ["\t".join(np.delete(line.split(), 3)) for line in lines[start:]]
    return written(file, "\n".join([*lines[:start], *rows]) + "\n")


def knee(*options: object) -> Callable[[Path], dict]:
    """The insert on the femoral component by coordinates of which one is missing."""
    return lambda folder: {"moving": INSERT, "fixed": FEMUR, "motion": coordinates(folder), "options": options}


def stretched(length: float) -> Callable[[Path], dict]:
    return lambda folder: {"moving": SPHERE, "fixed": PLATE, "motion": poses(folder, (1, 19.8, 2, length, 0, 0, 0))}


def euler(unit: str, angle: float) -> Callable[[Path], dict]:
    """The sphere turned by Euler angles whose header says `unit`, read as radians on the user's word."""
    text = f"time [s],tx [mm],ty [mm],tz [mm],rx{unit},ry{unit},rz{unit}\n0,1,19.8,2,0.1,{angle},0.2\n"
    options = ("--order", "XYZ", "--angles", "rad")
    return lambda folder: {
        "moving": SPHERE, "fixed": PLATE, "motion": written(folder / "turned.csv", text), "options": options
    }  # fmt: skip


def contradictory(folder: Path) -> dict:
    """The cycle whose text says radians where its flag says degrees, read as degrees on the user's word."""
    file = storage(folder, [30])
    text = file.read_text(encoding="utf-8").replace("inDegrees=yes\n", "inDegrees=yes\nAngles are in radians.\n")
    options = ("--osim", KNEE, "--joint", "knee_r", "--angles", "deg")
    return {"moving": INSERT, "fixed": FEMUR, "motion": written(file, text), "options": options}


WARNED: dict[str, tuple[Callable[[Path], dict], str, tuple[str, ...]]] = {
    "degenerate face": (altered(with_flat_face), "both", ("changed.stl: 1 degenerate face", "first is face 2880")),
    "duplicate face": (altered(with_face_again), "moving", ("changed.stl: 1 duplicate face", "first is face 2880")),
    "open body": (altered(without_a_far_face), "moving", ("changed.stl is open", "area_fixed is unsigned")),
    "faces pointing inwards": (altered(inside_out), "both", ("changed.stl: faces point inwards",)),
    "missing coordinate": (
        knee("--osim", KNEE, "--joint", "knee_r"),
        "both",
        ("gait.mot: no column for 1 coordinate", "knee_rotation = 0"),
    ),
    "unmapped rotation": (knee("--map", MAP), "both", ("gait.mot: nothing is mapped to ry; taken as 0",)),
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
        ("turned.csv line 2: column 'ry' reaches 45, much for radians", "pass --angles deg"),
    ),
}


@pytest.mark.parametrize(("made", "signed", "said"), WARNED.values(), ids=WARNED.keys())
def test_doubtful_input_is_used_with_a_warning(
    tmp_path: Path, made: Callable[[Path], dict], signed: str, said: tuple[str, ...]
) -> None:
    given = made(tmp_path)
    result = done(area(tmp_path / "out", *given.pop("options", ()), **given))
    assert any(all(part in line for part in said) for line in result.warnings), result.err
    assert result.record()["warnings"] == result.warnings
    assert len(set(result.warnings)) == len(result.warnings)
    assert list(result.table()["signed"]) == [signed]


def test_radians_of_an_ordinary_size_are_not_warned_of(tmp_path: Path) -> None:
    given = euler("", 3.1)(tmp_path)
    assert done(area(tmp_path / "out", *given.pop("options"), **given)).warnings == []


@pytest.fixture(scope="module")
def sound(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """The sphere on the plate, nothing wrong with it."""
    folder = tmp_path_factory.mktemp("sound")
    result = done(area(folder / "out", moving=SPHERE, fixed=PLATE, motion=poses(folder, (1, 19.8, 2))))
    assert result.warnings == []
    return result


@pytest.mark.parametrize("change", [with_flat_face, inside_out])
def test_what_was_warned_of_does_not_change_the_result(
    tmp_path: Path, sound: Call, change: Callable[[np.ndarray], np.ndarray]
) -> None:
    result = done(area(tmp_path / "out", **altered(change)(tmp_path)))
    agree(result.table(), sound.table(), areas=1e-9)


def test_quaternions_are_normalised(tmp_path: Path, sound: Call) -> None:
    agree(done(area(tmp_path / "out", **stretched(1.0009)(tmp_path))).table(), sound.table(), areas=1e-9)


def test_a_missing_coordinate_keeps_its_default(tmp_path: Path) -> None:
    """By the model and by the map the rotation is 0, and so are the tables the same."""
    bodies = {"moving": INSERT, "fixed": FEMUR, "motion": coordinates(tmp_path)}
    by_model = done(area(tmp_path / "a", "--osim", KNEE, "--joint", "knee_r", **bodies)).table()
    by_map = done(area(tmp_path / "b", "--map", MAP, **bodies)).table()
    agree(by_model, by_map, areas=1e-9)


def test_gaps_in_a_column_that_is_not_used_do_not_matter(tmp_path: Path, sound: Call) -> None:
    head = "time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz,force [N]"
    motion = written(tmp_path / "poses.csv", head + "\n0,1,19.8,2,1,0,0,0,nan\n")
    result = done(area(tmp_path / "out", moving=SPHERE, fixed=PLATE, motion=motion))
    assert result.warnings == []
    assert result.bytes() == sound.bytes()


def test_bounds_that_cannot_be_reached_are_said(tmp_path: Path, sound: Call) -> None:
    """A rule that does not divide triangles cannot narrow its bounds: asked for, not given, said."""
    options = ("--rule", "clip", "--bounds", "1e-6")
    result = done(area(tmp_path / "out", *options, moving=SPHERE, fixed=PLATE, motion=poses(tmp_path, (1, 19.8, 2))))
    assert any("bounds" in line for line in result.warnings), "asked-for bounds were silently not delivered"


def test_an_angle_unit_against_the_file_is_said(tmp_path: Path) -> None:
    """Degrees read as radians on the user's word: the pose is another one, and the line says why."""
    file = storage(tmp_path, [0])
    text = file.read_text(encoding="utf-8").replace("6.603143", "0.1152").replace("-1.525067", "-0.0266")
    written(file, text)
    options = ("--osim", KNEE, "--joint", "knee_r", "--angles", "rad")
    result = done(area(tmp_path / "out", *options, moving=INSERT, fixed=FEMUR, motion=file))
    assert any("says deg, read as rad as asked for" in line for line in result.warnings)
