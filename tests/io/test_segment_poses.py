"""Poses of segments in .c3d files as Theia writes them: units, gaps, and what cannot be poses; all synthetic."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.errors import InputError
from geocontact.io.mocap.segment_poses import read_c3d_poses
from tests.segment_files import write_matrices

ezc3d = pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")


def matrices() -> np.ndarray:
    """Two segments in five frames, the second turned by a quarter about z and 2 of the file's units along x."""
    found = np.tile(np.eye(4), (2, 5, 1, 1))
    found[1, :, :2, :2] = [[0.0, -1.0], [1.0, 0.0]]
    found[1, :, 0, 3] = 2.0
    return found


@pytest.mark.parametrize(("unit", "metre"), [("mm", 1e-3), ("m", 1.0)])
def test_columns_are_axes_and_lengths_have_the_unit_of_points(unit: str, metre: float, tmp_path: Path) -> None:
    made = matrices()
    made[0, 3] = np.nan
    found = read_c3d_poses(write_matrices(ezc3d, tmp_path / "a.c3d", ("pelvis", "l_thigh"), made, unit))
    assert found.names == ("pelvis", "l_thigh") and np.allclose(np.diff(found.time), 0.01)
    assert found.there.tolist() == [[frame != 3, True] for frame in range(5)]
    assert found.origins is not None
    np.testing.assert_allclose(found.origins[:, 1], np.tile([2.0 * metre, 0.0, 0.0], (5, 1)), rtol=1e-6)
    np.testing.assert_allclose(found.rotations[0, 1][:, 0], [0.0, 1.0, 0.0], atol=1e-7)


def test_an_unreliable_pose_is_missing(tmp_path: Path) -> None:
    """The 17th number of a pose, written into the file by hand: the last 2 * 5 * 17 of it are the poses."""
    file = write_matrices(ezc3d, tmp_path / "a.c3d", ("pelvis", "l_thigh"), matrices(), "mm")
    whole = file.read_bytes()
    numbers = np.frombuffer(whole[-170 * 4 :], "<f4").reshape(5, 2, 17).copy()
    np.testing.assert_array_equal(numbers[:, :, 16], 0.0)
    numbers[2, 1, 16], numbers[4, 0, 16] = -1.0, 1.0
    file.write_bytes(whole[: -170 * 4] + numbers.tobytes())
    found = read_c3d_poses(file)
    assert found.there.tolist() == [[True, frame != 2] for frame in range(5)]
    assert found.origins is not None and np.isnan(found.origins[2, 1]).all()


def test_what_is_no_pose_is_refused(tmp_path: Path) -> None:
    mirrored, sheared = matrices(), matrices()
    mirrored[1, 2, :3, 2] *= -1.0
    sheared[0, 1, 0, 1] = 0.1
    for made, unit, more, line in (
        (mirrored, "mm", {}, "ROTATION: the matrix of l_thigh in frame 3 is no rotation"),
        (sheared, "mm", {}, "ROTATION: the matrix of pelvis in frame 2 is no rotation"),
        (matrices(), "", {}, "POINT:UNITS: is empty: the unit of its points is unknown; state it with `c3d_unit`"),
        (matrices(), "mm", {"RATE": [60.0]}, "ROTATION:RATE: is 60 Hz, 1 poses in each frame of POINT:RATE 100 Hz"),
    ):
        file = write_matrices(ezc3d, tmp_path / "a.c3d", ("pelvis", "l_thigh"), made, unit, **more)
        with pytest.raises(InputError, match=line):
            read_c3d_poses(file)
