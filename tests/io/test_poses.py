"""Motions from pose tables, joints, maps and knee angles, and single 4x4 poses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.joint import JointModel
from geocontact.data.multibody.knee_angles import tibia_in_femur
from geocontact.io.motion.motion import read_motion
from geocontact.io.motion.poses import (
    motion_from_csv,
    motion_from_grood_suntay,
    motion_from_joint,
    motion_from_map,
    read_pose,
)
from geocontact.io.opensim.osim import read_joint
from geocontact.io.text.tables import TextTable, read_table

QUATERNION = "time [s],tx [mm],ty [cm],tz [m],qw,qx,qy,qz\n0,100,20,0.3,1,0,0,0\n1,0,0,0,0.6,0,0,0.8\n"
EULER = "time [s],tx [mm],ty [mm],tz [mm],rx [deg],ry [rad],rz [deg]\n0,1,2,3,30,-0.4,50\n1,0,0,0,0,0,90\n"
HEAD = "Coordinates\nversion=1\ninDegrees=yes\nendheader\n"
KNEE = HEAD + "time\tfe\taa\tie\tap\tpd\n0\t30\t4\t-6\t0.01\t0.04\n1\t-60\t1\t2\t0\t0\n"
ANGLE = st.floats(-1.5, 1.5)
SIDES: tuple[str, str] = ("right", "left")


def written(folder: Path, text: str, name: str) -> Path:
    file = folder / name
    file.write_text(text, encoding="utf-8")
    return file


def rotation(axis: str, angle: float) -> np.ndarray:
    """Rotation matrix about one axis, written out."""
    c, s = np.cos(angle), np.sin(angle)
    x, y, z = [[1, 0, 0], [0, c, -s], [0, s, c]], [[c, 0, s], [0, 1, 0], [-s, 0, c]], [[c, -s, 0], [s, c, 0], [0, 0, 1]]
    return np.array({"x": x, "y": y, "z": z}[axis], dtype=float)


def test_quaternion_poses_with_mixed_length_units(tmp_path: Path) -> None:
    motion = motion_from_csv(written(tmp_path, QUATERNION, "gait.csv"))
    np.testing.assert_allclose(motion.poses.translation, [[0.1, 0.2, 0.3], [0.0, 0.0, 0.0]], atol=1e-15)
    np.testing.assert_allclose(motion.poses.rotation.as_matrix()[0], np.eye(3), atol=1e-15)
    np.testing.assert_allclose(
        motion.poses.rotation.as_matrix()[1], rotation("z", 2 * np.arctan2(0.8, 0.6)), atol=1e-15
    )
    assert len(motion) == 2


@pytest.mark.parametrize("order", ["XYZ", "zxy", "YXZ"])
def test_euler_poses_are_intrinsic(tmp_path: Path, order: str) -> None:
    motion = motion_from_csv(written(tmp_path, EULER, "gait.csv"), order=order)
    angle = {"x": np.radians(30), "y": -0.4, "z": np.radians(50)}
    first, second, third = list(order.lower())
    expected = rotation(first, angle[first]) @ rotation(second, angle[second]) @ rotation(third, angle[third])
    np.testing.assert_allclose(motion.poses.rotation.as_matrix()[0], expected, atol=1e-15)
    np.testing.assert_allclose(motion.poses.translation[0], [0.001, 0.002, 0.003], atol=1e-18)


def test_nearly_unit_quaternions_are_normalised_with_a_warning(tmp_path: Path) -> None:
    file = written(tmp_path, QUATERNION.replace("0.6,0,0,0.8", "0.6005,0,0,0.8"), "gait.csv")
    with pytest.warns(InputWarning, match=r"quaternion length up to 1\.000300 \(line 3\); normalised"):
        matrix = motion_from_csv(file).poses.rotation.as_matrix()[1]
    np.testing.assert_allclose(matrix @ matrix.T, np.eye(3), atol=1e-15)


BAD_CSV = {
    "zero quaternion": (QUATERNION.replace("1,0,0,0\n", "0,0,0,0\n", 1), "line 2: quaternion has length 0, not 1"),
    "long quaternion": (QUATERNION.replace("0.6,", "0.61,"), "line 3: quaternion has length 1.006, not 1"),
    "half a quaternion": (QUATERNION.replace("qw,", "w,"), "no column qw; columns are: tx, ty, tz, w, qx, qy, qz"),
    "no rotation": ("time [s],tx [m],ty [m],tz [m]\n0,0,0,0\n", "no column qw, qx, qy, qz"),
    "missing tz": (QUATERNION.replace("tz [m]", "z [m]"), "no column 'tz'; columns are: tx, ty, z,"),
    "length without unit": (QUATERNION.replace("tx [mm]", "tx"), "column 'tx' has no unit; write e.g. `tx [mm]`"),
    "NaN": (QUATERNION.replace("20,0.3", "nan,0.3"), "line 2: column 'ty' is nan in 1 of 2 rows"),
    "NaN in the quaternion": (QUATERNION.replace("0.8", "nan"), "line 3: column 'qz' is nan"),
    "both ways": (
        QUATERNION.replace("time [s],", "time [s],rx [deg],").replace("\n0,", "\n0,0,").replace("\n1,", "\n1,0,"),
        "both",
    ),
    "time stands": (QUATERNION.replace("\n1,", "\n0,"), "line 3: time 0 does not follow 0"),
    "Euler without order": (EULER, "Euler columns without an order; pass `order`"),
}


@pytest.mark.parametrize(("text", "message"), BAD_CSV.values(), ids=BAD_CSV.keys())
def test_bad_pose_tables_are_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        motion_from_csv(written(tmp_path, text, "gait.csv"))
    assert message in str(caught.value)


@pytest.mark.parametrize("order", ["XY", "XYX", "ABC", "XYZX", ""])
def test_bad_orders_are_refused(tmp_path: Path, order: str) -> None:
    with pytest.raises(InputError, match="`order`: "):
        motion_from_csv(written(tmp_path, EULER, "gait.csv"), order=order)


def test_missing_euler_column_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no column 'ry'; columns are: tx, ty, tz, rx, y, rz"):
        motion_from_csv(written(tmp_path, EULER.replace("ry", "y"), "gait.csv"), order="XYZ")


def knee(folder: Path, text: str = KNEE) -> TextTable:
    return read_table(written(folder, text, "gait.mot"))


def test_map_turns_in_the_order_written_and_negates(tmp_path: Path) -> None:
    motion = motion_from_map(knee(tmp_path), "rz=fe,rx=-aa,ry=ie,tx=ap,ty=pd,tz=-ap")
    expected = rotation("z", np.radians(30)) @ rotation("x", np.radians(-4)) @ rotation("y", np.radians(-6))
    np.testing.assert_allclose(motion.poses.rotation.as_matrix()[0], expected, atol=1e-15)
    np.testing.assert_allclose(motion.poses.translation[0], [0.01, 0.04, -0.01], atol=1e-18)


def test_order_overrules_the_order_written(tmp_path: Path) -> None:
    mapping = "rz=fe,rx=aa,ry=ie,tx=ap,ty=pd,tz=ap"
    motion = motion_from_map(knee(tmp_path), mapping, order="yzx")
    expected = rotation("y", np.radians(-6)) @ rotation("z", np.radians(30)) @ rotation("x", np.radians(4))
    np.testing.assert_allclose(motion.poses.rotation.as_matrix()[0], expected, atol=1e-15)
    with pytest.raises(InputError, match="`order`: 'XY' does not order the axes Z, X, Y"):
        motion_from_map(knee(tmp_path), mapping, order="XY")


def test_unmapped_coordinates_are_zero_with_a_warning(tmp_path: Path) -> None:
    with pytest.warns(InputWarning, match="nothing is mapped to rx, ry, ty, tz; taken as 0"):
        motion = motion_from_map(knee(tmp_path), "rz=fe,tx=ap")
    np.testing.assert_allclose(motion.poses.rotation.as_matrix()[0], rotation("z", np.radians(30)), atol=1e-15)
    np.testing.assert_array_equal(motion.poses.translation[0], [0.01, 0, 0])


@pytest.mark.parametrize(
    ("mapping", "message"),
    [
        ("rz=hip", "no column 'hip'; columns are: fe, aa, ie, ap, pd"),
        ("rw=fe", "`map`: unknown target 'rw'; targets are: rx, ry, rz, tx, ty, tz"),
        ("rz=fe,rz=aa", "`map`: target 'rz' is given twice"),
    ],
)
def test_bad_maps_are_refused(tmp_path: Path, mapping: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        motion_from_map(knee(tmp_path), mapping)
    assert message in str(caught.value)


def test_map_of_a_csv_takes_units_from_its_headers(tmp_path: Path) -> None:
    table = read_table(written(tmp_path, "time [s],fe [deg],ap [mm]\n0,30,10\n", "gait.csv"))
    with pytest.warns(InputWarning, match="nothing is mapped"):
        motion = motion_from_map(table, "ry=fe,tz=ap")
    np.testing.assert_allclose(motion.poses.rotation.as_matrix()[0], rotation("y", np.radians(30)), atol=1e-15)
    np.testing.assert_allclose(motion.poses.translation[0], [0, 0, 0.01], atol=1e-18)


def test_map_refuses_a_file_that_does_not_tell_its_angles(tmp_path: Path) -> None:
    silent = KNEE.replace("inDegrees=yes\n", "")
    with pytest.raises(InputError, match=r"gait\.mot: header does not say whether .* pass `angles` deg or rad"):
        motion_from_map(knee(tmp_path, silent), "rz=fe")


JOINT = """<OpenSimDocument Version="40000"><Model name="m"><BodySet name="bodyset"><objects><Body name="femur"/>
<Body name="tibia"/></objects></BodySet><JointSet name="jointset"><objects><CustomJoint name="knee">
<socket_parent_frame>/bodyset/femur</socket_parent_frame><socket_child_frame>/bodyset/tibia</socket_child_frame>
<coordinates><Coordinate name="fe"/><Coordinate name="pd"><default_value>0.042</default_value></Coordinate>
<Coordinate name="aa"/></coordinates><SpatialTransform>
<TransformAxis name="rotation1"><coordinates>fe</coordinates><axis>0 0 1</axis><LinearFunction name="function">
<coefficients>1 0</coefficients></LinearFunction></TransformAxis>
<TransformAxis name="rotation2"><coordinates>aa</coordinates><axis>1 0 0</axis><LinearFunction name="function">
<coefficients>AA 0</coefficients></LinearFunction></TransformAxis>
<TransformAxis name="translation2"><coordinates>pd</coordinates><axis>0 1 0</axis><LinearFunction name="function">
<coefficients>1 0</coefficients></LinearFunction></TransformAxis></SpatialTransform></CustomJoint></objects></JointSet>
</Model></OpenSimDocument>"""


def joint(folder: Path, slope: str = "1") -> JointModel:
    return read_joint(written(folder, JOINT.replace("AA", slope), "knee.osim"), "knee")


def test_a_model_without_a_joint_lists_those_it_has(tmp_path: Path) -> None:
    model = written(tmp_path, JOINT, "knee.osim")
    with pytest.raises(InputError, match="`joint`: is missing with `osim`; joints of the model are: knee"):
        read_motion(written(tmp_path, KNEE, "gait.mot"), osim=model)


@pytest.mark.parametrize("name", ["fe", "knee/fe/value", "/jointset/knee/fe/value"])
def test_joint_poses_by_name_or_path(tmp_path: Path, name: str) -> None:
    motion = motion_from_joint(knee(tmp_path, KNEE.replace("fe", name)), joint(tmp_path))
    expected = rotation("z", np.radians(30)) @ rotation("x", np.radians(4))
    np.testing.assert_allclose(motion.poses.rotation.as_matrix()[0], expected, atol=1e-15)
    np.testing.assert_allclose(motion.poses.translation[0], [0, 0.04, 0], atol=1e-18)


def test_parent_moving_is_the_inverse_pose(tmp_path: Path) -> None:
    child = motion_from_joint(knee(tmp_path), joint(tmp_path)).poses
    parent = motion_from_joint(knee(tmp_path), joint(tmp_path), moving="parent").poses
    np.testing.assert_allclose((child * parent).as_matrix(), np.tile(np.eye(4), (2, 1, 1)), atol=1e-15)


def test_coordinates_without_a_column_take_their_default_with_a_warning(tmp_path: Path) -> None:
    with pytest.warns(InputWarning, match=r"no column for 1 coordinate\(s\) of joint knee; default taken: pd = 0\.042"):
        motion = motion_from_joint(knee(tmp_path, KNEE.replace("pd", "other")), joint(tmp_path))
    np.testing.assert_allclose(motion.poses.translation, [[0, 0.042, 0], [0, 0.042, 0]], atol=1e-18)


def test_table_without_any_coordinate_is_refused(tmp_path: Path) -> None:
    other = KNEE.replace("fe", "a").replace("\taa", "\tb").replace("pd", "c")
    with pytest.raises(
        InputError, match=r"no column for any coordinate of joint knee \(fe, pd, aa\); columns are: a, b"
    ):
        motion_from_joint(knee(tmp_path, other), joint(tmp_path))


def test_coupled_coordinates_stay_in_radians_in_a_file_in_degrees(tmp_path: Path) -> None:
    """OpenSim converts plain rotations only; a coordinate with a factor is written as the model has it."""
    with pytest.warns(InputWarning, match="column 'aa' is not a plain rotation; read in rad or m"):
        motion = motion_from_joint(knee(tmp_path), joint(tmp_path, slope="2"))
    expected = rotation("z", np.radians(30)) @ rotation("x", 2 * 4.0)
    np.testing.assert_allclose(motion.poses.rotation.as_matrix()[0], expected, atol=1e-14)


def test_moving_must_be_a_body_of_the_joint(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="`moving_body`: 'femur'"):
        motion_from_joint(knee(tmp_path), joint(tmp_path), moving="femur")


def test_a_wrong_degree_flag_is_noticed_by_size(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"line 7: column 'fe' reaches 60, too much for .* pass `angles` deg or rad"):
        motion_from_joint(knee(tmp_path, KNEE.replace("=yes", "=no")), joint(tmp_path))


@settings(deadline=None)
@given(st.floats(-3.1, 3.1), ANGLE, st.floats(-3.1, 3.1), st.sampled_from(SIDES))
def test_knee_angles_by_the_definition_with_the_floating_axis(
    flexion: float, adduction: float, turn: float, side: str
) -> None:
    """Read back from the axes: e1 = z of the femur, e3 = y of the tibia, e2 = e3 x e1; a left knee is mirrored."""
    tibia = tibia_in_femur(np.array([flexion]), np.array([adduction]), np.array([turn]), side).as_matrix()[0]
    sign = 1.0 if side == "right" else -1.0
    e3 = tibia[:, 1]
    e2 = np.cross(e3, [0.0, 0.0, 1.0]) / np.hypot(e3[0], e3[1])
    in_tibia = tibia.T @ e2
    found = [np.arctan2(-e2[1], e2[0]), sign * np.arcsin(e3[2]), sign * np.arctan2(in_tibia[2], in_tibia[0])]
    np.testing.assert_allclose(found, [flexion, adduction, turn], atol=1e-12)


@settings(deadline=None)
@given(ANGLE, ANGLE, ANGLE, st.sampled_from(SIDES))
def test_knee_matrix_is_an_euler_sequence(flexion: float, adduction: float, turn: float, side: str) -> None:
    sign = 1 if side == "right" else -1
    euler = Rotation.from_euler("ZXY", [-flexion, sign * adduction, sign * turn])
    ours = tibia_in_femur(np.array([flexion]), np.array([adduction]), np.array([turn]), side)
    np.testing.assert_allclose(ours.as_matrix()[0], euler.as_matrix(), atol=1e-14)


@given(ANGLE, ANGLE, ANGLE)
@settings(deadline=None)
def test_left_knee_is_the_mirror_image_of_the_right(flexion: float, adduction: float, turn: float) -> None:
    angles = np.array([flexion]), np.array([adduction]), np.array([turn])
    mirror = np.diag([1.0, 1.0, -1.0])
    right, left = (tibia_in_femur(*angles, side=side).as_matrix()[0] for side in SIDES)
    np.testing.assert_allclose(left, mirror @ right @ mirror, atol=1e-14)


@pytest.mark.parametrize(("side", "midline"), [("right", -1.0), ("left", 1.0)])
def test_signs_of_knee_angles(side: str, midline: float) -> None:
    """x anterior, y proximal, z to the right: where the distal tibia and its front go for each angle of 0.1 rad."""
    zero, small = np.zeros(1), np.full(1, 0.1)
    distal, front = np.array([0.0, -1.0, 0.0]), np.array([1.0, 0.0, 0.0])
    assert tibia_in_femur(small, zero, zero, side).apply(distal)[0, 0] < -0.09  # flexion: backwards
    assert midline * tibia_in_femur(zero, small, zero, side).apply(distal)[0, 2] > 0.09  # adduction: to the midline
    assert midline * tibia_in_femur(zero, zero, small, side).apply(front)[0, 2] > 0.09  # internal: front to the midline


def test_knee_angle_columns_by_map(tmp_path: Path) -> None:
    mapping = "flexion=fe,adduction=aa,rotation=-ie,tx=ap,ty=pd,tz=ap"
    tibia = motion_from_grood_suntay(knee(tmp_path), mapping, "left")
    expected = rotation("z", np.radians(-30)) @ rotation("x", np.radians(-4)) @ rotation("y", np.radians(-6))
    np.testing.assert_allclose(tibia.poses.rotation.as_matrix()[0], expected, atol=1e-15)
    femur = motion_from_grood_suntay(knee(tmp_path), mapping, "left", moving="femur")
    np.testing.assert_allclose(femur.poses.rotation.as_matrix()[0], expected.T, atol=1e-15)
    for motion in (tibia, femur):  # translation: origin of MOVING in FIXED either way
        np.testing.assert_allclose(motion.poses.translation[0], [0.01, 0.04, 0.01], atol=1e-18)


def test_knee_angle_columns_by_their_own_names(tmp_path: Path) -> None:
    table = knee(tmp_path, KNEE.replace("fe\taa\tie", "flexion\tadduction\trotation"))
    with pytest.warns(InputWarning, match="nothing is mapped to tx, ty, tz; taken as 0"):
        motion = motion_from_grood_suntay(table, None, "right")
    expected = rotation("z", np.radians(-30)) @ rotation("x", np.radians(4)) @ rotation("y", np.radians(-6))
    np.testing.assert_allclose(motion.poses.rotation.as_matrix()[0], expected, atol=1e-15)
    with pytest.raises(InputError, match="no columns flexion, adduction, rotation; name them with `map`"):
        motion_from_grood_suntay(knee(tmp_path), None, "right")


@pytest.mark.parametrize(
    ("side", "moving", "place"), [("both", "tibia", "`side`"), ("right", "child", "`moving_body`")]
)
def test_side_and_moving_body_are_checked(tmp_path: Path, side: str, moving: str, place: str) -> None:
    with pytest.raises(InputError, match=place):
        motion_from_grood_suntay(knee(tmp_path), "flexion=fe,tx=ap", side, moving)


POSE = "# tray in tibia\n0, -1, 0, 10\n1, 0, 0, 20\n0, 0, 1, 30\n0, 0, 0, 1\n"


@pytest.mark.parametrize("text", [POSE, POSE.replace(",", " "), POSE.replace("\n", "\r\n")])
def test_pose_matrix_in_the_unit_of_the_mesh(tmp_path: Path, text: str) -> None:
    pose = read_pose(written(tmp_path, text, "place.txt"), "mm")
    np.testing.assert_allclose(pose.apply([1.0, 0.0, 0.0]), [0.01, 1.02, 0.03], atol=1e-15)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (POSE.replace("0, 0, 0, 1\n", ""), "not a 4x4 matrix"),
        (POSE.replace("30", "thirty"), "not a 4x4 matrix"),
        (POSE.replace("30", "nan"), "not a 4x4 matrix of finite numbers"),
        (POSE.replace("0, -1,", "0, -1.001,"), "rotation part is off orthonormal by 0.002"),
        (POSE.replace("0, -1,", "0, 1,"), "rotation part mirrors"),
        (POSE.replace("0, 0, 0, 1", "10, 20, 30, 1"), "the last row of the matrix is not 0 0 0 1"),
        ("", "the file is empty"),
        ("1 " * 50000, "more than the 65536 bytes that are read; give 4 rows of 4 numbers"),
    ],
)
def test_bad_pose_matrices_are_refused(tmp_path: Path, text: str, message: str) -> None:
    with pytest.raises(InputError) as caught:
        read_pose(written(tmp_path, text, "place.txt"))
    assert message in str(caught.value)


def test_unknown_unit_of_a_pose(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="'furlong' is not a unit of length here; give one of m, cm, mm"):
        read_pose(written(tmp_path, POSE, "place.txt"), "furlong")


def test_missing_pose_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"none\.txt: there is no such file"):
        read_pose(tmp_path / "none.txt")
