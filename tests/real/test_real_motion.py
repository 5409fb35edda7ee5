"""Motion from real files: every table, every joint against OpenSim, the poses that the sources describe."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from geocontact.data.errors import InputError, InputWarning
from geocontact.data.motion import Motion
from geocontact.io.motion.poses import motion_from_joint, motion_from_map
from geocontact.io.opensim.osim import mesh_placements, read_joint
from geocontact.io.opensim.osim_xml import read_model
from geocontact.io.text.columns import angles_of
from geocontact.io.text.tables import TextTable, read_table
from tests import opensim_oracle
from tests.elsewhere import Elsewhere

WORKSHOP = "gc4_jw_predsim_workshop"
DM_MAP = "rx=knee_flex_r,ry=knee_add_r,rz=knee_rot_r,tx=knee_ant_r,ty=knee_sup_r,tz=knee_lat_r"
JW_MAP = "rz=knee_flexion,rx=knee_adduction,ry=-knee_rotation,tx=knee_tx,ty=knee_ty,tz=knee_tz"

# Rows, columns without time, what the header says of angles; counted with awk.
TABLES: dict[str, tuple[int, int, str | None]] = {
    f"{WORKSHOP}/KCF_ref.mot": (327, 2, None),
    f"{WORKSHOP}/KneeProsthesis.mot": (41, 6, None),
    f"{WORKSHOP}/jw_ngait_og1_new_v4_converted.mot": (327, 59, None),
    f"{WORKSHOP}/KneeProsthesis_states2track.sto": (328, 12, "rad"),
    "gc6_dm_knee/fluoroscopy/Fluoroscopic Gait Data.sto": (101, 6, None),
    "gc6_dm_knee/gait/DM_bouncy5_grf.sto": (3419, 27, None),
    "gc6_dm_knee/gait/DM_ngait_og1_grf.sto": (3809, 27, None),
    "gc6_dm_knee/gait/DM_smooth1_grf.sto": (3699, 27, None),
    "opencap/squats1_videoAndMocap.mot": (801, 35, "deg"),
    "opencap/walking1_videoAndMocap.mot": (158, 35, "deg"),
    "opensim_walk/coordinates.sto": (1350, 31, "rad"),
    "opensim_walk/grf_walk.mot": (4778, 18, "rad"),
    "opensim_walk/inverse_dynamics.sto": (73, 23, "rad"),
    "opensim_walk/subject01_walk1_grf.mot": (1501, 18, "deg"),
    "opensim_walk/subject01_walk1_ik.mot": (73, 23, "deg"),
    "rmr_shoulder/ABD01.mot": (1091, 17, "deg"),
    "rmr_shoulder/ABD02.mot": (846, 17, "deg"),
    "rmr_shoulder/ABD03.mot": (787, 17, "deg"),
    "rmr_shoulder/FLX01.mot": (794, 17, "deg"),
    "rmr_shoulder/FLX02.mot": (848, 17, "deg"),
    "rmr_shoulder/SHRUG01.mot": (462, 17, "deg"),
}


def quietly(file: Path) -> TextTable:
    """A real table; coordinates.sto says nColumns=40 and has 32, which is warned of."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "^.*nColumns=40.*", InputWarning)
        return read_table(file)


@pytest.mark.parametrize("name", TABLES)
def test_every_real_table_reads(data_dir: Path, name: str) -> None:
    table = quietly(data_dir / name)
    assert (*table.values.shape, table.angles.unit) == TABLES[name]


def test_the_list_of_real_tables_is_complete(data_dir: Path) -> None:
    found = {file.relative_to(data_dir).as_posix() for ext in ("mot", "sto") for file in data_dir.rglob(f"*.{ext}")}
    assert found == set(TABLES)


def test_real_tables_agree_with_opensim(data_dir: Path, opensim: Elsewhere) -> None:
    for name in TABLES:
        ours = quietly(data_dir / name)
        column, row = ours.values.shape[1] - 1, len(ours.time) // 2
        theirs = opensim(opensim_oracle.cell, data_dir / name, row, column)
        assert theirs == (ours.time[row], ours.values[row, column])


def test_stale_column_count_is_said(data_dir: Path) -> None:
    with pytest.warns(InputWarning, match="line 3: header says 'nColumns=40' but 32 column labels follow"):
        read_table(data_dir / "opensim_walk/coordinates.sto")


def assert_poses_agree(
    opensim: Elsewhere, file: Path, motions: dict[str, Motion], table: TextTable, degrees: bool
) -> None:
    """Child body in parent body of each joint at several frames, to 1e-9 m and 1e-9 in the matrix."""
    frames = np.linspace(0, len(table.time) - 1, 9).astype(int)
    joints = {name: read_joint(file, name) for name in motions}
    samples = {}
    for joint in joints.values():
        for c in joint.coordinates:
            names = (c.name, f"/jointset/{joint.name}/{c.name}/value")
            found = [name for name in names if name in table.channels]
            if found:
                scale = np.pi / 180 if degrees and c.kind == "rotational" else 1.0
                samples[c.name] = table.column(found[0])[frames] * scale
    pairs = [(joint.child, joint.parent) for joint in joints.values()]
    theirs = opensim(opensim_oracle.poses, file, list(samples), np.column_stack(list(samples.values())), pairs)
    for i, (name, motion) in enumerate(motions.items()):
        np.testing.assert_allclose(motion.poses.as_matrix()[frames], theirs[:, i], atol=1e-9, err_msg=name)


@pytest.mark.parametrize(("motion", "degrees"), [("subject01_walk1_ik.mot", True), ("coordinates.sto", False)])
def test_every_joint_of_the_walking_model_agrees_with_opensim(
    data_dir: Path, opensim: Elsewhere, motion: str, degrees: bool
) -> None:
    """coordinates.sto is of another model: the six joints that have the same paths are compared."""
    file, table = data_dir / "opensim_walk/subject01_simbody.osim", quietly(data_dir / "opensim_walk" / motion)
    names = [str(joint.get("name")) for joint in read_model(file).findall("JointSet/objects/*")]
    motions, refused = {}, []
    for name in names:
        try:
            motions[name] = motion_from_joint(table, read_joint(file, name))
        except InputError as error:
            refused.append(str(error))
    assert all("no column for any coordinate" in line for line in refused)
    assert len(names) == 12 and len(motions) == (12 if degrees else 6)
    assert_poses_agree(opensim, file, motions, table, degrees)


@pytest.mark.parametrize(
    ("motion", "degrees"), [("KneeProsthesis.mot", True), ("KneeProsthesis_states2track.sto", False)]
)
def test_every_joint_of_the_knee_prosthesis_agrees_with_opensim(
    data_dir: Path, opensim: Elsewhere, motion: str, degrees: bool
) -> None:
    file, table = data_dir / WORKSHOP / "KneeProsthesis.osim", read_table(data_dir / WORKSHOP / motion)
    motions = {
        name: motion_from_joint(table, read_joint(file, name), angles="deg" if degrees else None)
        for name in ("femurToGround", "knee_joint")
    }
    assert_poses_agree(opensim, file, motions, table, degrees)


def test_reversed_knee_is_the_femur_in_the_tibia(data_dir: Path) -> None:
    """SOURCE.md: q is the femur in the tibia's frame, T(tx, ty, tz) Rz(flexion) Rx(adduction) R(0,-1,0)(rotation)."""
    table = read_table(data_dir / WORKSHOP / "KneeProsthesis.mot")
    joint = read_joint(data_dir / WORKSHOP / "KneeProsthesis.osim", "knee_joint")
    assert (joint.parent, joint.child, joint.reverse) == ("femoral_component", "tibia_component", True)
    by_joint = motion_from_joint(table, joint, moving="parent", angles="deg")
    by_map = motion_from_map(table, JW_MAP, angles="deg")
    np.testing.assert_allclose(by_joint.poses.as_matrix(), by_map.poses.as_matrix(), atol=1e-15)
    assert np.all((by_joint.poses.translation[:, 1] > 0.04) & (by_joint.poses.translation[:, 1] < 0.05))


def test_simm_files_ask_for_the_unit(data_dir: Path) -> None:
    table = read_table(data_dir / WORKSHOP / "KneeProsthesis.mot")
    with pytest.raises(InputError, match=r"header does not say .*; pass `angles` deg or rad \(SIMM"):
        motion_from_map(table, JW_MAP)


def test_fluoroscopy_of_dm(data_dir: Path) -> None:
    """SOURCE.md: T(x, y, z) Rx(xrot) Ry(yrot) Rz(zrot) in m and rad; zrot, labelled knee_rot, is the flexion."""
    table = read_table(data_dir / "gc6_dm_knee/fluoroscopy/Fluoroscopic Gait Data.sto")
    with pytest.raises(InputError, match="header does not say whether angles are degrees or radians; pass `angles`"):
        motion_from_map(table, DM_MAP)
    motion = motion_from_map(table, DM_MAP, angles="rad")
    assert len(motion) == 101
    x, y, z = (table.column(f"knee_{name}_r") for name in ("flex", "add", "rot"))
    expected = Rotation.from_rotvec(np.outer(x, [1, 0, 0])) * Rotation.from_rotvec(np.outer(y, [0, 1, 0]))
    expected = expected * Rotation.from_rotvec(np.outer(z, [0, 0, 1]))
    np.testing.assert_allclose(motion.poses.rotation.as_matrix(), expected.as_matrix(), atol=1e-15)
    np.testing.assert_array_equal(motion.poses.translation[0], [-0.0074, 0.0417, -0.001])
    flexion = np.degrees(motion.poses.rotation.as_euler("XYZ")[:, 2])
    assert -54 < flexion.min() < -52 and -6 < flexion.max() < -4


def test_walking_angles_beyond_two_turns_are_not_radians(data_dir: Path) -> None:
    table = read_table(data_dir / "opensim_walk/inverse_dynamics.sto")
    with pytest.raises(InputError, match=r"column 'hip_flexion_r_moment' reaches .* pass `angles`"):
        angles_of(table, ["hip_flexion_r_moment"])


def test_mesh_placements_of_the_walking_model(data_dir: Path) -> None:
    found = mesh_placements(data_dir / "opensim_walk/subject01_simbody.osim", "pelvis")
    assert list(found) == ["sacrum.vtp", "pelvis.vtp", "l_pelvis.vtp"]
    np.testing.assert_array_equal(found["pelvis.vtp"], np.diag([1.02458, 1.02458, 1.02458, 1.0]))
