"""`geocontact mat --motion`: loads of a synthetic mat in the frame that its segment moves in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest
from scipy.spatial.transform import RigidTransform, Rotation

from tests.cli.calls import MESHES, Call, call, done, written

GIVEN = MESHES / "mat_thigh_16x8"
AXIS = np.array([0.2, 0.1, 1.0]) / np.linalg.norm([0.2, 0.1, 1.0])
TURNS, SHIFTS = [f"f{a} [N]" for a in "xyz"], [f"cop_{a} [mm]" for a in "xyz"]
MOMENTS = [f"m{a} [N m]" for a in "xyz"]


def pose(time: np.ndarray) -> RigidTransform:
    """A turn of constant rate about one axis through a point that goes straight: slerp and lerp are exact."""
    turn = Rotation.from_rotvec(0.6 * time[:, None] * AXIS)
    return RigidTransform.from_components(np.array([0.3, 0.9, -0.1]) + np.outer(time, [0.1, -0.05, 0.02]), turn)


def poses(folder: Path, time: np.ndarray) -> Path:
    x = pose(time)
    quat = x.rotation.as_quat(scalar_first=True)
    rows = [",".join(f"{v:.15g}" for v in (t, *s, *q)) for t, s, q in zip(time, x.translation, quat, strict=True)]
    return written(folder / "motion.csv", "\n".join(["time [s], tx [m], ty [m], tz [m], qw, qx, qy, qz", *rows]) + "\n")


def mat(folder: Path, *options: object) -> Call:
    folder.mkdir(exist_ok=True)
    return call(
        "mat", GIVEN / "frames.csv", "--layout", GIVEN / "layout.toml", "--surface", MESHES / "thigh.stl", "--unit",
        "mm", "--landmarks", GIVEN / "landmarks.csv", "--cutoff", "0", "--out", folder / "out", *options,
        folder=folder / "out",
    )  # fmt: skip


def table(result: Call, name: str = "wrench.csv") -> pd.DataFrame:
    return pd.read_csv(result.folder / name, comment="#")


def test_loads_are_those_of_the_segment_carried_along(tmp_path: Path) -> None:
    segment = ("--segment", "upper=y > 20", "--segment", "lower=y <= 20", "--registration", "1mm,2deg")
    still = done(mat(tmp_path / "still", *segment))
    moving = done(mat(tmp_path / "moving", *segment, "--point", "100,900,-50",
                      "--motion", poses(tmp_path, np.array([0.0, 0.7, 1.3, 3.0]))))  # fmt: skip
    here, there = table(still), table(moving)
    assert moving.warnings == [] and len(there) == len(here)
    x, point = pose(here["time [s]"].to_numpy()), np.array([0.1, 0.9, -0.05])
    force = x.rotation.apply(here[TURNS].to_numpy())
    np.testing.assert_allclose(there[TURNS], force, atol=1e-9)
    moment = x.rotation.apply(here[MOMENTS].to_numpy()) + np.cross(x.translation - point, force)
    np.testing.assert_allclose(there[MOMENTS], moment, atol=1e-9)
    np.testing.assert_allclose(there[SHIFTS], 1e3 * x.apply(1e-3 * here[SHIFTS].to_numpy()), atol=1e-6)
    for same in ("normal [N]", "perpendicular [N]", "area [mm^2]", "peak [Pa]"):
        np.testing.assert_allclose(there[same], here[same])
    head = moving.bytes("wrench.csv").decode().splitlines()[:2]
    assert head[0] == "# point_mm = 100, 900, -50" and head[1].startswith("# frame = that motion.csv leads to;")
    own, carried = (table(r, "segments.csv") for r in (still, moving))
    for name in ("upper", "lower"):
        one, other = (each.loc[each["segment"] == name, TURNS].to_numpy() for each in (own, carried))
        np.testing.assert_allclose(other, x.rotation.apply(one), atol=1e-9)
    told = moving.record()["results"]
    assert told["motion"]["frames_left_out"] == 0 and told["load"]["frame"] == "that motion.csv leads to"
    here, there = (table(r, "uncertainty.csv")[[f"sd_f{a} [N]" for a in "xyz"]].to_numpy() for r in (still, moving))
    np.testing.assert_allclose((here**2).sum(axis=1), (there**2).sum(axis=1), rtol=1e-9)
    assert np.abs(here - there).max() > 0.1
    page = (moving.folder / "report.html").read_text(encoding="utf-8")
    assert "The picture stands still in the frame of thigh.stl" in page


def test_frames_without_a_pose_are_left_out_and_told(tmp_path: Path) -> None:
    result = done(mat(tmp_path, "--motion", poses(tmp_path, np.array([0.5, 1.0, 2.0]))))
    assert len(result.warnings) == 1
    assert "75 of 151 frames are left out, they have no pose: the mat has frames from 0 to 3 s" in result.warnings[0]
    time = table(result)["time [s]"]
    assert (time.iloc[0], time.iloc[-1], len(time)) == (0.5, 2.0, 76)
    assert len(table(result, "frames_cells.csv")) == 76


def test_a_joint_of_a_model_carries_the_mat(tmp_path: Path) -> None:
    """The shipped cycle lasts 1 s: its child body is the insert, in the frame of the femoral component."""
    model = ("--motion", MESHES / "gait.mot", "--osim", MESHES / "knee.osim", "--joint", "knee_r")
    child, parent = done(mat(tmp_path / "c", *model)), done(mat(tmp_path / "p", *model, "--moving", "parent"))
    assert "100 of 151 frames are left out" in child.warnings[-1]
    assert child.record()["results"]["load"]["frame"] == "of the parent body of joint knee_r"
    assert parent.record()["results"]["load"]["frame"] == "of the child body of joint knee_r"
    gait = pd.read_csv(MESHES / "gait.csv", skipinitialspace=True)
    quat = gait[["qw", "qx", "qy", "qz"]].to_numpy()[::2]
    turn = Rotation.from_quat(quat, scalar_first=True)  # of the component in the insert: --moving parent
    still = table(done(mat(tmp_path / "s")))[TURNS].to_numpy()[:51]
    np.testing.assert_allclose(table(parent)[TURNS], turn.apply(still), atol=2e-3)
    np.testing.assert_allclose(table(child)[TURNS], turn.inv().apply(still), atol=2e-3)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--osim", "x.osim"), "--osim: does nothing without --motion"),
        (("--map", "rz=a"), "--map: does nothing without --motion"),
        (
            ("--motion", "late"),
            "no frame has a pose: the mat has frames from 0 to 3 s and the motion poses from 5 to 6",
        ),
        (("--motion", "one"), "holds one pose"),
        (("--motion", "late", "--order", "XYZ"), "--order: does nothing here"),
        (("--motion", "late", "--moving", "parent"), "--moving: parent needs a joint"),
    ],
)
def test_what_makes_no_sense_is_one_line(tmp_path: Path, options: tuple[str, ...], said: str) -> None:
    files = {"late": np.array([5.0, 6.0]), "one": np.array([0.0])}
    given = [poses(tmp_path, files[each]) if each in files else each for each in options]
    result = mat(tmp_path, *given)
    assert result.code == 2, result.err
    assert len(result.complaints) == 1 and said in result.complaints[0], result.err
    assert not result.folder.exists()
