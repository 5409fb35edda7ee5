"""Joint angles in every form: beside products of plain matrices, through gimbal lock, and in the files of a job."""

from __future__ import annotations

from itertools import permutations
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

import geocontact as gc
from geocontact.data.multibody.joint_angles import joint_angles, joint_rotations
from geocontact.io.opensim.osim_multibody import read_multibody

MESHES = Path(__file__).resolve().parents[2] / "meshes"
SEQUENCES = [*map("".join, permutations("XYZ")), "XYX", "XZX", "YXY", "YZY", "ZXZ", "ZYZ"]


def about(axis: str, angle: float) -> np.ndarray:
    """A turn about one axis as a matrix of sines and cosines."""
    c, s = np.cos(angle), np.sin(angle)
    k = "XYZ".index(axis)
    matrix = np.zeros((3, 3))
    matrix[k, k] = 1.0
    i, j = (k + 1) % 3, (k + 2) % 3
    matrix[i, i] = matrix[j, j] = c
    matrix[j, i], matrix[i, j] = s, -s
    return matrix


@pytest.mark.parametrize("form", SEQUENCES)
def test_a_sequence_turns_about_its_axes_one_after_the_other(form: str) -> None:
    time = np.linspace(0.0, 1.0, 60)
    angles = np.column_stack([3.0 * time, 0.4 + 0.5 * np.sin(3.0 * time), -5.0 * time])
    made = [about(form[0], a) @ about(form[1], b) @ about(form[2], c) for a, b, c in angles]
    found = joint_angles(Rotation.from_matrix(np.array(made)), form)
    places = ("first", "second", "third")
    assert list(found.columns) == [f"{k} {axis.lower()}" for k, axis in zip(places, form, strict=True)]
    np.testing.assert_allclose(np.column_stack(list(found.columns.values())), angles, atol=1e-9)
    far = angles[:, 1] if len(set(form)) == 2 else 0.5 * np.pi - angles[:, 1]
    np.testing.assert_allclose(found.lock, far, atol=1e-9)


def test_isb_is_flexion_adduction_rotation() -> None:
    turned = Rotation.from_matrix(about("Z", 0.7) @ about("X", -0.2) @ about("Y", 0.1))
    found = joint_angles(turned, "ISB").columns
    np.testing.assert_allclose(np.column_stack(list(found.values())), [[0.7, -0.2, 0.1]])


@pytest.mark.parametrize("joint", ["shoulder_r", "acromial_l", "right Glenohumeral"])
def test_isb_of_the_shoulder_is_plane_elevation_rotation(joint: str) -> None:
    """Wu et al. 2005; an elbow beside it stays ZXY."""
    turned = Rotation.from_matrix(about("Y", 0.7) @ about("X", 1.2) @ about("Y", -0.4))
    found = joint_angles(turned, "ISB", joint).columns
    assert list(found) == ["first y", "second x", "third y"]
    np.testing.assert_allclose(np.column_stack(list(found.values())), [[0.7, 1.2, -0.4]])
    assert list(joint_angles(turned, "ISB", "elbow_r").columns) == ["first z", "second x", "third y"]


def test_gimbal_lock_leaves_the_second_angle_and_nothing_else() -> None:
    through = np.radians(np.linspace(80.0, 90.0, 41))
    made = [about("X", 0.3) @ about("Y", b) @ about("Z", 0.2) for b in through]
    found = joint_angles(Rotation.from_matrix(np.array(made)), "XYZ")
    first, second, third = found.columns.values()
    np.testing.assert_allclose(second, through, atol=1e-7)
    assert np.isnan([first[-1], third[-1]]).all() and np.isfinite(first[:-1]).all()
    np.testing.assert_allclose(first[:-1], 0.3, atol=1e-6)


def test_a_quaternion_goes_on_over_a_whole_turn() -> None:
    """Half the angle about an axis, without a jump of sign: w = cos, the rest the axis times sin."""
    angle = np.linspace(0.0, 6.2, 80)
    axis = np.array([2.0, -1.0, 2.0]) / 3.0
    found = joint_angles(Rotation.from_rotvec(angle[:, None] * axis), "quaternion").columns
    wanted = np.column_stack([np.cos(0.5 * angle), np.sin(0.5 * angle)[:, None] * axis])
    np.testing.assert_allclose(np.column_stack(list(found.values())), wanted, atol=1e-12)


def test_frames_of_a_joint_are_those_that_turn() -> None:
    """The pelvis of the shipped leg: its pose in the ground between the frames of the joint."""
    model = read_multibody(MESHES / "leg.osim")
    values = np.random.default_rng(5).uniform(-0.4, 0.4, (6, len(model.coordinates)))
    poses, found = model.poses(values), joint_rotations(model, values)
    assert found
    for joint in model.joints:
        if joint.name in found:
            between = poses[joint.parent].rotation.inv() * poses[joint.child].rotation
            own = joint.parent_offset.rotation * found[joint.name] * joint.child_offset.rotation.inv()
            np.testing.assert_allclose(own.as_matrix(), between.as_matrix(), atol=1e-12)


def test_inverse_kinematics_writes_them_and_says_where_they_lock(tmp_path: Path) -> None:
    markers = gc.virtual_markers(MESHES / "leg_swing.mot", model=MESHES / "leg.osim").write(tmp_path / "v")
    forms = {}
    for form in ("ISB", "quaternion"):
        found = gc.inverse_kinematics(markers / "markers.trc", model=MESHES / "leg.osim", joint_angles=form)
        forms[form] = found.table("angles")
    found.write(tmp_path / "out")
    assert (tmp_path / "out" / "angles.csv").is_file()
    columns = [name.split(" first z")[0] for name in forms["ISB"] if " first z" in name]
    assert columns
    for joint in columns:
        three = forms["ISB"][[f"{joint} {k} [deg]" for k in ("first z", "second x", "third y")]].to_numpy(float)
        four = forms["quaternion"][[f"{joint} {k} [-]" for k in "wxyz"]].to_numpy(float)
        for (a, b, c), (w, x, y, z) in zip(np.radians(three), four, strict=True):
            own = about("Z", a) @ about("X", b) @ about("Y", c)
            assert np.trace(own) == pytest.approx(4.0 * w**2 - 1.0, abs=1e-9)
            skew = [own[2, 1] - own[1, 2], own[0, 2] - own[2, 0], own[1, 0] - own[0, 1]]
            np.testing.assert_allclose(skew, 4.0 * w * np.array([x, y, z]), atol=1e-9)
    with pytest.warns(gc.InputWarning, match=r"second angle of XYX comes within .* of gimbal lock"):
        gc.inverse_kinematics(markers / "markers.trc", model=MESHES / "leg.osim", joint_angles="XYX")
