"""Loads of a synthetic mat in the frame that its segment moves in."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.analyses.mat.show import mat_page
from tests.analyses.mat.samples import CENTRE, FORCE, MOMENT, refusal, shipped
from tests.cli.calls import MESHES, written

AXIS = np.array([0.2, 0.1, 1.0]) / np.linalg.norm([0.2, 0.1, 1.0])


def pose(time: np.ndarray) -> RigidTransform:
    """A turn of constant rate about one axis through a point that goes straight: slerp and lerp are exact."""
    turn = Rotation.from_rotvec(0.6 * time[:, None] * AXIS)
    return RigidTransform.from_components(np.array([0.3, 0.9, -0.1]) + np.outer(time, [0.1, -0.05, 0.02]), turn)


def poses(folder: Path, *time: float) -> Path:
    x = pose(np.array(time))
    quat = x.rotation.as_quat(scalar_first=True)
    rows = [",".join(f"{v:.15g}" for v in (t, *s, *q)) for t, s, q in zip(time, x.translation, quat, strict=True)]
    return written(folder / "motion.csv", "\n".join(["time [s], tx [m], ty [m], tz [m], qw, qx, qy, qz", *rows]) + "\n")


def test_loads_are_those_of_the_segment_carried_along(tmp_path: Path) -> None:
    parts = {"segment": ("upper=y > 20", "lower=y <= 20"), "registration": (1e-3, np.radians(2.0))}
    still = shipped(**parts)
    moving = shipped(**parts, point="100,900,-50", motion=poses(tmp_path, 0.0, 0.7, 1.3, 3.0))
    here, there = still.table(), moving.table()
    assert moving.warnings == () and len(there) == len(here)
    x, point = pose(here["time [s]"].to_numpy()), np.array([0.1, 0.9, -0.05])
    force = x.rotation.apply(np.array(here[FORCE]))
    np.testing.assert_allclose(there[FORCE], force, atol=1e-9)
    moment = x.rotation.apply(np.array(here[MOMENT])) + np.cross(x.translation - point, force)
    np.testing.assert_allclose(there[MOMENT], moment, atol=1e-9)
    np.testing.assert_allclose(there[CENTRE], 1e3 * x.apply(1e-3 * np.array(here[CENTRE])), atol=1e-6)
    for same in ("normal [N]", "perpendicular [N]", "area [mm^2]", "peak [Pa]"):
        np.testing.assert_allclose(there[same], here[same])
    own, carried = (r.table("segments") for r in (still, moving))
    for name in ("upper", "lower"):
        one, other = (np.array(each.loc[each["segment"] == name, FORCE]) for each in (own, carried))
        np.testing.assert_allclose(other, x.rotation.apply(one), atol=1e-9)
    told = moving.record.results
    assert told["motion"]["frames_left_out"] == 0 and told["load"]["frame"] == "that motion.csv leads to"
    np.testing.assert_allclose(moving.loads.wrench.origin, np.broadcast_to(point, (len(there), 3)))
    here, there = (r.table("uncertainty").iloc[:, 1:4].to_numpy() for r in (still, moving))
    np.testing.assert_allclose((here**2).sum(axis=1), (there**2).sum(axis=1), rtol=1e-9)
    assert np.abs(here - there).max() > 0.1
    words = str(mat_page(moving, np.array([moving.heaviest]), b"<svg/>").sections)
    assert "The picture stands still in the frame of thigh.stl" in words


def test_frames_without_a_pose_are_left_out_and_told(tmp_path: Path) -> None:
    result = shipped(motion=poses(tmp_path, 0.5, 1.0, 2.0))
    (line,) = result.warnings
    assert "75 of 151 frames are left out, they have no pose: the mat has frames from 0 to 3 s" in line
    time = result.table()["time [s]"]
    assert (time.iloc[0], time.iloc[-1], len(time)) == (0.5, 2.0, 76)
    assert len(result.table("frames_cells")) == 76 == len(result.frames.time)


def test_a_joint_of_a_model_carries_the_mat() -> None:
    """The shipped cycle lasts 1 s: its child body is the insert, in the frame of the femoral component."""
    model = {"motion": MESHES / "gait.mot", "osim": MESHES / "knee.osim", "joint": "knee_r"}
    child, parent = shipped(**model), shipped(**model, moving_body="parent")
    assert "100 of 151 frames are left out" in child.warnings[-1]
    assert child.record.results["load"]["frame"] == "of the parent body of joint knee_r"
    assert parent.record.results["load"]["frame"] == "of the child body of joint knee_r"
    gait = pd.read_csv(MESHES / "gait.csv", skipinitialspace=True)
    quat = gait[["qw", "qx", "qy", "qz"]].to_numpy()[::2]
    turn = Rotation.from_quat(quat, scalar_first=True)  # of the component in the insert: moving_body="parent"
    still = np.array(shipped().table()[FORCE])[:51]
    np.testing.assert_allclose(parent.table()[FORCE], turn.apply(still), atol=2e-3)
    np.testing.assert_allclose(child.table()[FORCE], turn.inv().apply(still), atol=2e-3)


@pytest.mark.parametrize(
    ("times", "options", "said"),
    [
        ((5.0, 6.0), {}, "no frame has a pose: the mat has frames from 0 to 3 s and the motion poses from 5 to 6"),
        ((0.0,), {}, "holds one pose"),
        ((5.0, 6.0), {"order": "XYZ"}, "`order`: has no effect here"),
    ],
)
def test_motions_that_cannot_carry_the_mat_are_refused(
    tmp_path: Path, times: tuple[float, ...], options: dict[str, Any], said: str
) -> None:
    with refusal(said):
        shipped(motion=poses(tmp_path, *times), **options)
