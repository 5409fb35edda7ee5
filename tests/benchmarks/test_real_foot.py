"""From markers to the pose of a foot: a rigid foot whose markers, pose and belt are known. Synthetic."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from benchmarks.prosthesis import real_foot
from benchmarks.prosthesis.real_foot import Standing, Step

TIME = np.linspace(0.0, 0.8, 81)
HEIGHT, RISE, LENGTH = 0.05, 0.1, 0.25
FLAT = (TIME >= 0.2) & (TIME <= 0.4)


def walked(belt: float = 0.0) -> tuple[Step, np.ndarray, np.ndarray, np.ndarray]:
    """Markers of a foot that stands flat for a while, and its pose."""
    rolled = np.where(TIME < 0.2, 0.5 * (0.2 - TIME), np.where(TIME > 0.4, 0.4 - TIME, 0.0))
    x, y = 0.3 + 0.1 * rolled**2 - belt * TIME, 0.2 * rolled**2
    marker = {}
    for name, along, up in (("heel", 0.0, HEIGHT), ("front", LENGTH * np.cos(RISE), HEIGHT + LENGTH * np.sin(RISE))):
        s, c = np.sin(rolled), np.cos(rolled)
        marker[name] = np.column_stack([x + along * c - up * s, y + along * s + up * c])
    return Step("right", TIME, marker["heel"], marker["front"], FLAT), x, y, rolled


def test_the_pose_of_a_rigid_foot_is_found() -> None:
    step, x, y, pitch = walked()
    standing = Standing.of([step])
    assert (standing.height, standing.rise, standing.length) == pytest.approx((HEIGHT, RISE, LENGTH), abs=1e-12)
    table = real_foot.pose(step, standing)
    for name, true in (("x [m]", x), ("y [m]", y), ("pitch [rad]", pitch)):
        np.testing.assert_allclose(table[name], true, atol=1e-12)


def test_the_belt_runs_as_fast_as_standing_heels_do() -> None:
    assert real_foot.belt_speed([walked(1.1)[0], walked(1.3)[0]]) == pytest.approx(1.2, abs=1e-12)


def test_steps_that_the_recording_cuts_short_are_left_out() -> None:
    time = np.linspace(0.0, 4.0, 4001)
    force = 700.0 * ((time < 0.3) | ((time > 1.0) & (time < 1.7)) | (time > 3.2))
    assert np.round(real_foot.stances(time, force), 2).tolist() == [[1.0, 1.7], [3.2, 4.0]]


def test_spheres_of_a_flat_foot_are_as_deep_as_asked_for() -> None:
    table = real_foot.spheres(0.24, 0.004)
    np.testing.assert_allclose(table["radius [m]"] - table["py [m]"], 0.004)
    assert table["zone"].value_counts().to_dict() == dict.fromkeys(real_foot.ZONES, 4)
    assert table["px [m]"].iloc[[0, -1]].tolist() == [0.0, 0.24]


def test_markers_are_read_by_name(tmp_path: Path) -> None:
    head = "PathFileType\t4\nDataRate\tCameraRate\tNumFrames\tNumMarkers\tUnits\n100\t100\t2\t2\t{}\n"
    text = head + "Frame#\tTime\tHeel\t\t\tToe\t\t\n\t\tX1\tY1\tZ1\tX2\tY2\tZ2\n\n"
    text += "1\t0.0\t1\t2\t3\t4\t5\t6\n2\t0.01\t7\t8\t9\t10\t11\t12\n"
    file = tmp_path / "two.trc"
    file.write_text(text.format("mm"), encoding="utf-8")
    time, points = real_foot.markers(file)
    assert time.tolist() == [0.0, 0.01]
    np.testing.assert_allclose(points["Toe"], [[0.004, 0.005], [0.010, 0.011]])
    file.write_text(text.format("m"), encoding="utf-8")
    with pytest.raises(SystemExit, match="not in mm"):
        real_foot.markers(file)
