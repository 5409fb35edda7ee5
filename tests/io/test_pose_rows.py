"""Poses as rows of 16 or 12 numbers, and as columns r11 … r33."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.data.errors import InputError, InputWarning
from geocontact.io.motion.motion import read_motion

TIME = np.array([0.0, 0.5, 1.0])
POSES = RigidTransform.from_components(
    np.array([[1.0, 2.0, 3.0], [-4.0, 5.0, 6.0], [7.0, -8.0, 9.0]]) * 1e-3,
    Rotation.from_rotvec([[0.1, 0.2, 0.3], [-1.0, 0.5, 0.0], [0.0, 0.0, 3.0]]),
)
IN_MM = POSES.as_matrix() * np.array([[1, 1, 1, 1e3]] * 3 + [[1, 1, 1, 1]])


def rows(folder: Path, matrices: np.ndarray, name: str = "poses.txt", separator: str = ",", digits: int = 12) -> Path:
    file = folder / name
    lines = [separator.join(f"{cell:.{digits}g}" for cell in row) for row in matrices.reshape(len(matrices), -1)]
    file.write_text("# one frame a line\n" + "\n".join(lines) + "\n\n", encoding="utf-8")
    return file


@pytest.mark.parametrize("size", [16, 12])
@pytest.mark.parametrize(("name", "separator"), [("poses.txt", ","), ("poses.csv", ", "), ("poses.txt", "\t")])
def test_rows_are_the_matrices_they_were_written_from(tmp_path: Path, size: int, name: str, separator: str) -> None:
    file = rows(tmp_path, IN_MM[:, : size // 4], name, separator)
    motion = read_motion(file, unit="mm", rate=2.0)
    np.testing.assert_allclose(motion.poses.as_matrix(), POSES.as_matrix(), atol=1e-11)
    np.testing.assert_allclose(motion.time, TIME, atol=1e-15)


def test_columns_of_a_table_are_the_same_motion(tmp_path: Path) -> None:
    """In any order, with times and units of their own."""
    head = "time [ms], ty [cm], tx [mm], tz [m], " + ", ".join(f"r{i}{j}" for j in (1, 2, 3) for i in (1, 2, 3))
    lines = [head]
    for time, pose in zip(TIME, POSES, strict=True):
        x, y, z = pose.translation
        turn = pose.rotation.as_matrix().T.ravel()  # column by column, as the header says
        lines.append(",".join(map(repr, map(float, (time * 1e3, y * 1e2, x * 1e3, z, *turn)))))
    file = tmp_path / "poses.csv"
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    motion = read_motion(file)
    np.testing.assert_allclose(motion.poses.as_matrix(), POSES.as_matrix(), atol=1e-12)
    np.testing.assert_allclose(motion.time, TIME)


def test_five_digits_are_silent_and_three_are_told(tmp_path: Path) -> None:
    """The nearest rotation is taken: orthonormal again, and as near as the digits were."""
    exact = POSES.as_matrix()
    found = read_motion(rows(tmp_path, IN_MM, digits=5), unit="mm", rate=1.0).poses.as_matrix()
    np.testing.assert_allclose(found, exact, atol=2e-5)
    with pytest.warns(InputWarning, match=r"off orthonormal in \d of 3 frames, by up to .* the nearest rotations"):
        found = read_motion(rows(tmp_path, IN_MM, digits=2), unit="mm", rate=1.0).poses.as_matrix()
    turn = found[:, :3, :3]
    np.testing.assert_allclose(turn @ np.swapaxes(turn, 1, 2), np.tile(np.eye(3), (3, 1, 1)), atol=1e-14)


SPOILT = {
    "column by column": (
        np.swapaxes(IN_MM, 1, 2),
        {},
        "line 4: the last row of the matrix is not 0 0 0 1; write it row",
    ),
    "scaled": (np.diag([1.1, 1.1, 1.1, 1]) @ IN_MM, {}, "off orthonormal by 0.21"),
    "mirrored": (np.diag([1, 1, -1, 1]) @ IN_MM, {}, "line 2: rotation part mirrors"),
    "not finite": (np.where(np.isclose(IN_MM, 9.0), np.nan, IN_MM), {}, "line 4: the pose is not finite"),
    "without a rate": (IN_MM, {"rate": None}, "rows of poses hold no times; pass `rate`"),
    "without a unit": (IN_MM, {"unit": None}, "do not say in which unit they are; pass `unit`"),
    "with a map": (IN_MM, {"mapping": "rx=a"}, "`map`: has no effect on rows of poses"),
}


@pytest.mark.parametrize(("matrices", "given", "said"), SPOILT.values(), ids=SPOILT)
def test_what_is_no_pose_is_refused(tmp_path: Path, matrices: np.ndarray, given: dict, said: str) -> None:
    with pytest.raises(InputError) as refused:
        read_motion(rows(tmp_path, matrices), **{"unit": "mm", "rate": 1.0, **given})
    assert said in str(refused.value)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("1,0,0,0,0,1,0,0,0,0,1,0\n1,0,0\n", "line 2: 3 cells where 12 numbers are a pose"),
        ("1,0,0,0,0,1,0,0,0,0,1,0\n1,0,0,0,0,1,0,0,0,0,1,x\n", "line 2: 12 cells where 12 numbers are a pose"),
        ("1,0,0,0\n0,1,0,0\n", "the first row of a .txt is not the 16 or 12 numbers of a pose"),
    ],
)
def test_rows_of_another_length_are_refused(tmp_path: Path, text: str, said: str) -> None:
    file = tmp_path / "poses.txt"
    file.write_text(text, encoding="utf-8")
    with pytest.raises(InputError, match=said):
        read_motion(file, unit="mm", rate=1.0)


def test_a_rotation_in_two_ways_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "poses.csv"
    file.write_text("time [s],tx [m],ty [m],tz [m],qw,qx,qy,qz,r11\n0,0,0,0,1,0,0,0,1\n", encoding="utf-8")
    with pytest.raises(InputError, match=r"both ways \(qw, qx, qy, qz and r11\); keep the quaternion, the matrix"):
        read_motion(file)
