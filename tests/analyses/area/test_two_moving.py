"""Two bodies that both move in the laboratory: the same areas as of the one in the other."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.errors import InputError
from geocontact.io.motion.motion import read_motion
from tests.analyses.area.calls import area
from tests.cli.calls import FEMUR, INSERT, PLATE, SPHERE, agree, gait, poses, written

FRAMES = (0, 20, 40)


@pytest.fixture
def known(tmp_path: Path) -> Path:
    """Poses of the femoral component in the insert."""
    return gait(tmp_path, FRAMES)


def fixed_in_lab(times: np.ndarray) -> RigidTransform:
    """The insert on its way: it turns about a constant axis and moves along a line, at constant speeds."""
    place = np.array([1000.0, 50.0, -20.0]) + np.outer(times, [400.0, -30.0, 100.0])
    turn = Rotation.from_rotvec([0.5, -1.0, 0.2]) * Rotation.from_rotvec(np.outer(times, [0.3, 0.6, -0.2]))
    return RigidTransform.from_components(place, turn)


def rows(file: Path, pose: RigidTransform) -> Path:
    lines = [",".join(map(repr, map(float, matrix.ravel()))) for matrix in pose.as_matrix()]
    return written(file, "\n".join(lines) + "\n")


def table(file: Path, times: np.ndarray, pose: RigidTransform) -> Path:
    cells = np.column_stack([times, pose.translation, pose.rotation.as_quat(scalar_first=True)])
    head = "time [s], tx [mm], ty [mm], tz [mm], qw, qx, qy, qz"
    lines = [",".join(map(repr, map(float, row))) for row in cells]
    return written(file, "\n".join([head, *lines]) + "\n")


def in_lab(folder: Path, known: Path) -> tuple[np.ndarray, RigidTransform]:
    """Times and poses of the femoral component in the laboratory [mm]."""
    motion = read_motion(known)
    matrices = motion.poses.as_matrix()
    matrices[:, :3, 3] *= 1e3
    return motion.time, fixed_in_lab(motion.time) * RigidTransform.from_matrix(matrices)


def test_areas_are_those_of_the_relative_motion(tmp_path: Path, known: Path) -> None:
    """Poses in rows without times; nothing is interpolated."""
    times, moving = in_lab(tmp_path, known)
    given: dict[str, Any] = {"motion_fixed": str(rows(tmp_path / "insert.txt", fixed_in_lab(times))), "rate": 50.0}
    found = area(FEMUR, INSERT, rows(tmp_path / "femur.txt", moving), **given)
    ours, theirs = found.table(), area(FEMUR, INSERT, known).table()
    np.testing.assert_allclose(ours.pop("time [s]"), np.arange(3) / 50.0)
    agree(ours, theirs.drop(columns="time [s]"), areas=1e-5, lengths=1e-5)
    assert found.warnings == ()
    assert [entry["role"] for entry in found.record.inputs][-2:] == ["motion", "motion of fixed"]


def test_other_times_are_interpolated_and_told(tmp_path: Path, known: Path) -> None:
    """Exactly, where the fixed body turns and moves at constant speeds."""
    times, moving = in_lab(tmp_path, known)
    other = np.linspace(times[0] - 0.1, times[-1] + 0.2, 7)
    fixed = table(tmp_path / "insert.csv", other, fixed_in_lab(other))
    found = area(FEMUR, INSERT, table(tmp_path / "femur.csv", times, moving), motion_fixed=str(fixed))
    agree(found.table(), area(FEMUR, INSERT, known).table(), areas=1e-5, lengths=1e-5)
    (said,) = found.warnings
    assert "interpolated to those, translations linearly, rotations along the shortest arc" in said


def test_what_does_not_fit_is_refused(tmp_path: Path) -> None:
    moving, short = poses(tmp_path, (0, 20, 0), (0, 21, 0)), poses(tmp_path, (0, 0, 0), name="short.csv")
    for given, said in (
        ({"motion_fixed": str(short)}, "short.csv: is known from 0 to 0 s only, not from 0 to 1; cut `motion`"),
        ({"motion_fixed": (str(short), str(short))}, "`motion_fixed`: names 2 files for 1 of `motion`"),
        ({"rate": 100.0}, "`rate`: has no effect here: no pose without a time is read from"),
        ({"osim": "a.osim", "joint": "b", "motion_fixed": str(short)}, "`motion_fixed`: has no effect with `osim`"),
    ):
        with pytest.raises(InputError) as refused:
            area(SPHERE, PLATE, moving, **given)
        assert said in str(refused.value)
