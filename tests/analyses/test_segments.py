"""Inverse kinematics from poses of segments and orientations of sensors; all files are synthetic."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.optimize import least_squares
from scipy.spatial.transform import RigidTransform, Rotation

import geocontact as gc
from geocontact.analyses.motion.folder_inputs import folder_inputs
from geocontact.data.errors import InputError
from geocontact.io.text.tables import read_table
from tests import opensim_oracle
from tests.cli.calls import MESHES, call, done
from tests.elsewhere import Elsewhere
from tests.segment_files import RATE, write_sensors, write_theia

pytestmark = pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")

LEG = MESHES / "leg.osim"
NAMES = ("tilt", "list", "turn", "tx", "ty", "tz", "hip_x", "hip_y", "hip_z", "knee", "ankle")
ANGLES = tuple(name for name in NAMES if name not in ("tx", "ty", "tz"))
BODIES = ("pelvis", "femur_r", "tibia_r", "foot_r")
THEIA = dict(zip(BODIES, ("pelvis", "r_thigh", "r_shank", "r_foot"), strict=True))
LABORATORY = "x,z,-y"
TURN = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]])
"""From x, y up, z to a laboratory whose z is up."""
FORWARD = np.array([[0.0, 0.0, -1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]])
"""A frame in the pelvis whose -z axis is the pelvis' x axis."""
MOUNTED = {"pelvis": Rotation.from_matrix(FORWARD), **{b: Rotation.random(rng=k) for k, b in enumerate(BODIES[1:])}}
"""R_BS: the foot's has nothing to do with the body's axes, as of a sensor that was strapped on."""
OFFSET = {
    "pelvis": np.zeros(3),
    "femur_r": [0.02, -0.01, 0.03],
    "tibia_r": [0.0, 0.05, 0.0],
    "foot_r": [0.1, 0.0, 0.01],
}
PLACE = RigidTransform.from_components([0.7, 0.02, -1.9], Rotation.from_rotvec([0.0, np.radians(140.0), 0.0]))
"""Where the person stands in the laboratory for the calibration, and faces."""


def leg(q: np.ndarray) -> dict[str, RigidTransform]:
    """Poses of the bodies of leg.osim, by hand: a free joint, a ball joint, two pins."""

    def pin(angle: np.ndarray) -> RigidTransform:
        return RigidTransform.from_components([0.0, -0.4, 0.0], Rotation.from_euler("z", angle.reshape(-1, 1)))

    pelvis = RigidTransform.from_components(q[:, 3:6], Rotation.from_euler("XYZ", q[:, :3]))
    femur = pelvis * RigidTransform.from_components([0.0, -0.1, 0.1], Rotation.from_euler("XYZ", q[:, 6:9]))
    tibia = femur * pin(q[:, 9])
    return dict(zip(BODIES, (pelvis, femur, tibia, tibia * pin(q[:, 10])), strict=True))


def swing(frames: int = 60) -> np.ndarray:
    """Coordinates [rad, m] of somebody who walks away while the leg swings."""
    phase = 2.0 * np.pi * (np.arange(frames)[:, None] / 50.0 + np.linspace(0.0, 0.8, len(NAMES)))
    q = 0.3 * np.sin(phase)
    q[:, 3:6] += [0.2, 1.0, -0.5]
    q[:, 1] += np.radians(20.0)
    return q


def segments(q: np.ndarray, at: RigidTransform | None = None) -> dict[str, RigidTransform]:
    """Poses of the segments in the laboratory, the person standing at a place of it."""
    upright = RigidTransform.from_rotation(Rotation.from_matrix(TURN))
    place = upright if at is None else upright * at
    return {
        THEIA[body]: place * pose * RigidTransform.from_components(OFFSET[body], MOUNTED[body])
        for body, pose in leg(q).items()
    }


def sensors(q: np.ndarray, at: RigidTransform | None = None) -> dict[str, np.ndarray]:
    """The same as quaternions w, x, y, z of sensors that have the names of bodies."""
    poses = segments(q, at)
    return {f"{body}_imu": poses[THEIA[body]].rotation.as_quat(scalar_first=True) for body in BODIES}


STANDING = np.zeros((2, len(NAMES)))


@pytest.fixture
def poses(tmp_path: Path) -> tuple[Path, Path]:
    """A walk and a calibration as Theia writes them."""
    pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    walk = {"worldbody": RigidTransform.from_translation(np.zeros((60, 3))), **segments(swing())}
    return (
        write_theia(tmp_path / "walk.c3d", walk),
        write_theia(tmp_path / "static.c3d", segments(STANDING, PLACE)),
    )


def found(result: gc.analyses.IkResult, names: tuple[str, ...] = NAMES) -> np.ndarray:
    return np.column_stack([result.coordinates[name] for name in names])


def test_poses_of_a_planted_swing_give_its_coordinates(poses: tuple[Path, Path]) -> None:
    """Wherever the person stands and faces in the calibration, and however segments lie in their bodies."""
    walk, standing = poses
    result = gc.inverse_kinematics(walk, model=LEG, calibration=standing, heading="pelvis=-z", axes=LABORATORY)
    assert np.abs(found(result) - swing()).max() < 1e-6
    assert result.fit_outcome == "fits" and result.rms_mm < 1e-3
    assert any("worldbody" in line and "r_thigh for femur_r" in line for line in result.warnings)
    assert list(result.table("segments"))[:3] == ["time [s]", "pelvis [deg]", "r_thigh [deg]"]


def test_without_a_calibration_the_first_frame_is_one(poses: tuple[Path, Path], tmp_path: Path) -> None:
    """Angles then count from the first frame; a heading that is wrong turns the axes of the joints."""
    _, standing = poses
    q = swing()
    q[0] = 0.0
    whole = write_theia(tmp_path / "whole.c3d", segments(q))
    result = gc.inverse_kinematics(whole, model=LEG, axes=LABORATORY)
    assert np.abs(found(result, ANGLES) - np.delete(q, (3, 4, 5), axis=1)).max() < 1e-6
    assert any(line.startswith("the first frame places segments in bodies") for line in result.warnings)
    turned = gc.inverse_kinematics(whole, model=LEG, axes=LABORATORY, calibration=standing)
    assert np.abs(found(turned, ("hip_z",)) - q[:, 8:9]).max() > np.radians(5.0)


def test_sensors_of_a_planted_swing_give_its_angles(tmp_path: Path) -> None:
    """Orientations know no place: shifts stay at the model's default, and it is said."""
    time = np.arange(60) / RATE
    walk = write_sensors(tmp_path / "walk.sto", time, sensors(swing()))
    standing = write_sensors(tmp_path / "standing.sto", time[:2], sensors(STANDING, PLACE))
    result = gc.inverse_kinematics(walk, model=LEG, calibration=standing, heading="pelvis_imu=-z", axes=LABORATORY)
    assert np.abs(found(result, ANGLES) - np.delete(swing(), (3, 4, 5), axis=1)).max() < 1e-6
    assert np.all(found(result, ("tx", "ty", "tz")) == 0.0)
    assert any("no frame determines tx, ty, tz" in line for line in result.warnings)
    assert np.isnan(result.rms_mm) and "mm" not in result.summary["segments"]["pelvis_imu"]
    assert list(result.table("segments")) == ["time [s]", *(f"{body}_imu [deg]" for body in BODIES)]


def gone(metres: float, backwards: bool = False) -> np.ndarray:
    """Coordinates of somebody who goes along x while the leg swings a little."""
    q = 0.2 * swing()
    q[:, 3:6] = np.column_stack([np.linspace(0.0, -metres if backwards else metres, len(q)), *np.ones((2, len(q)))])
    return q


def test_a_wrong_heading_is_doubted_by_the_way(tmp_path: Path) -> None:
    """Faced the wrong way a leg follows its segments, with other angles; nobody is doubted who stays where he is."""
    pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    standing = write_theia(tmp_path / "static.c3d", segments(STANDING, PLACE))
    given = {"model": LEG, "calibration": standing, "axes": LABORATORY}
    for name, q, heading, off in (
        ("forwards", gone(3.0), "pelvis=-z", False),
        ("turned", gone(3.0), "pelvis=z", True),
        ("backwards", gone(3.0, backwards=True), "pelvis=-z", True),
        ("here", gone(0.4), "pelvis=z", False),
    ):
        result = gc.inverse_kinematics(write_theia(tmp_path / f"{name}.c3d", segments(q)), **given, heading=heading)
        said = [line for line in result.warnings if "from where the person goes" in line]
        assert [float(line.split()[3]) > 170.0 for line in said] == [True] * off, (name, result.warnings)
        assert name == "here" or (result.fit_outcome == "fits") is not off
        assert "angles count from the pose of the calibration, which is not tested" in result.sentences[-1]


def test_a_first_frame_in_mid_swing_is_doubted(tmp_path: Path) -> None:
    """Bodies that lie wrong in their segments: no pose of the leg has all of them."""
    pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    whole = write_theia(tmp_path / "whole.c3d", segments(swing()))
    result = gc.inverse_kinematics(whole, model=LEG, axes=LABORATORY)
    assert result.fit_outcome != "fits"
    assert result.summary["rms_deg"] > 5.0 and result.summary["max_deg"] > 15.0
    assert [line for line in result.warnings if " degrees from the model at " in line]


def test_the_frame_that_places_segments_is_named(tmp_path: Path) -> None:
    """The foot is not there until frame 31; the recording's own number, also where `time` cuts it."""
    time, shown = np.arange(60) / RATE, sensors(swing())
    shown["foot_r_imu"][:30] = np.nan
    walk = write_sensors(tmp_path / "walk.sto", time, shown)
    for cut in (None, (0.1, 0.5)):
        lines = gc.inverse_kinematics(walk, model=LEG, axes=LABORATORY, time=cut).warnings
        assert [x for x in lines if x.startswith("frame 31 (0.3 s), the first that shows all segments, places")]
        assert any("segments do not determine them: ankle" in line for line in lines)
    standing = write_sensors(tmp_path / "standing.sto", time[:2], sensors(STANDING))
    lines = gc.inverse_kinematics(walk, model=LEG, axes=LABORATORY, calibration=standing).warnings
    assert [line for line in lines if line.startswith("the first frame of standing.sto places")]


def test_origins_count_from_the_root_whatever_the_order_of_bodies(tmp_path: Path) -> None:
    """A file that lists the pelvis last is the same model."""
    pytest.importorskip("ezc3d", reason="the extra `mocap` is not installed")
    text = LEG.read_text(encoding="utf-8")
    parts = re.findall(r"\n[^\n]*<Body name=.*?</Body>", text, re.DOTALL)
    assert len(parts) == 4
    back = re.sub(r"(\n[^\n]*<Body name=.*</Body>)", "".join(parts[::-1]).replace("\\", r"\\"), text, flags=re.DOTALL)
    (tmp_path / "back.osim").write_text(back, encoding="utf-8")
    walk = write_theia(tmp_path / "walk.c3d", segments(swing()))
    standing = write_theia(tmp_path / "static.c3d", segments(STANDING, PLACE))
    for model in (LEG, tmp_path / "back.osim"):
        result = gc.inverse_kinematics(walk, model=model, calibration=standing, heading="pelvis=-z", axes=LABORATORY)
        assert any("the origin of pelvis is taken for that of pelvis" in line for line in result.warnings)
        assert np.abs(found(result) - swing()).max() < 1e-6


def test_noise_is_weighed_as_by_hand(tmp_path: Path) -> None:
    """Least squares by scipy along the leg by hand: of angles to 0.02 degrees, of chords to a millionth."""
    rng, q = np.random.default_rng(2), swing(3)
    noisy = sensors(q)
    for name, each in noisy.items():
        off = Rotation.from_rotvec(np.radians(2.0) * rng.normal(size=(3, 3)))
        noisy[name] = (Rotation.from_quat(each, scalar_first=True) * off).as_quat(scalar_first=True)
    time = np.arange(3) / RATE
    walk = write_sensors(tmp_path / "walk.sto", time, noisy)
    standing = write_sensors(tmp_path / "standing.sto", time, sensors(np.zeros((3, len(NAMES)))))
    ours = gc.inverse_kinematics(walk, model=LEG, calibration=standing, axes=LABORATORY, weight=("tibia_r_imu=5",))

    def off(angles: np.ndarray, frame: int, chord: bool) -> np.ndarray:
        rows = []
        made = sensors(np.insert(angles, 3, np.zeros(3))[None])
        for name, each in made.items():
            turn = Rotation.from_quat(each[0], scalar_first=True).inv() * Rotation.from_quat(
                noisy[name][frame], scalar_first=True
            )
            part = turn.as_matrix() - np.eye(3) if chord else turn.as_rotvec()
            rows.append(np.sqrt(5.0 if name == "tibia_r_imu" else 1.0) * part.ravel())
        return np.concatenate(rows)

    for frame in range(3):
        start = np.delete(q[frame], (3, 4, 5))
        for chord, within in ((True, 1e-6), (False, np.radians(0.02))):
            best = least_squares(off, start, args=(frame, chord), xtol=1e-14, ftol=1e-14, gtol=1e-14).x
            assert np.abs(found(ours, ANGLES)[frame] - best).max() < within
    angle = np.degrees(np.linalg.norm(off(found(ours, ANGLES)[0], 0, False).reshape(4, 3)[0]))
    assert ours.table("segments")["pelvis_imu [deg]"][0] == pytest.approx(angle, rel=1e-6)


def test_a_segment_that_is_lost_leaves_its_joint_open(tmp_path: Path) -> None:
    """Short gaps are filled, long ones are empty; other joints go on."""
    time = np.arange(60) / RATE
    shown = sensors(swing())
    shown["foot_r_imu"][20:25] = np.nan
    shown["foot_r_imu"][40:] = np.nan
    walk = write_sensors(tmp_path / "walk.sto", time, shown)
    standing = write_sensors(tmp_path / "standing.sto", time[:2], sensors(STANDING))
    result = gc.inverse_kinematics(walk, model=LEG, calibration=standing, axes=LABORATORY)
    ankle, knee = result.coordinates["ankle"], result.coordinates["knee"]
    within = 5.0 / 384.0 * 0.3 * (4.0 * np.pi * 6.0 / RATE) ** 4  # of a cubic spline over 6 frames of that sine
    assert np.abs(ankle[20:25] - swing()[20:25, 10]).max() < within and np.isnan(ankle[40:]).all()
    assert np.abs(knee - swing()[:, 9]).max() < 1e-6


def test_origins_and_orientations_have_weights_of_their_own(poses: tuple[Path, Path], tmp_path: Path) -> None:
    """A model of another size: orientations alone give the angles, origins that count pull them away."""
    _, standing = poses
    moved = segments(swing())
    place = moved["r_shank"]
    moved["r_shank"] = RigidTransform.from_components(place.translation * 1.1, place.rotation)
    off = write_theia(tmp_path / "off.c3d", moved)
    given = {"model": LEG, "calibration": standing, "heading": "pelvis=-z", "axes": LABORATORY}
    alone = gc.inverse_kinematics(off, **given, weight=("r_shank_origin=0",))
    both = gc.inverse_kinematics(off, **given)
    assert np.abs(found(alone) - swing()).max() < 1e-6 < 1e-3 < np.abs(found(both) - swing()).max()
    assert both.fit_outcome != "fits" and alone.fit_outcome == "fits"


def test_what_cannot_be_used_is_refused_in_one_line(poses: tuple[Path, Path], tmp_path: Path) -> None:
    walk, standing = poses
    time = np.arange(2) / RATE
    sto = write_sensors(tmp_path / "a.sto", time, sensors(STANDING))
    plain = write_sensors(tmp_path / "plain.sto", time, sensors(STANDING), "double")
    long = write_sensors(tmp_path / "long.sto", time, {"pelvis_imu": np.full((2, 4), 0.7)})
    other = write_sensors(tmp_path / "other.sto", time, {"arm_imu": sensors(STANDING)["pelvis_imu"]})
    named = write_sensors(
        tmp_path / "named.sto",
        time,
        {THEIA[b]: each for b, each in zip(BODIES, sensors(STANDING).values(), strict=True)},
    )
    unseen = write_sensors(tmp_path / "unseen.sto", time, {f"{b}_imu": np.full((2, 4), np.nan) for b in BODIES})
    nothing = tuple(f"{b}_imu=0" for b in BODIES)
    two_origins = (*(f"{name}=0" for name in THEIA.values()), "r_shank_origin=0", "r_foot_origin=0")
    trc = gc.virtual_markers(MESHES / "leg_swing.mot", model=LEG).write(tmp_path / "v") / "markers.trc"
    upright = ("heading", "pelvis=y")
    for file, options, line in (
        (walk, {"naming": "auto"}, "`naming`: has no effect: walk.c3d holds segments"),
        (walk, {"heading": "pelvis"}, "`heading`: 'pelvis' is no segment and its axis; write pelvis_imu=-z"),
        (walk, {upright[0]: upright[1]}, "axis y of pelvis is upright in the calibration; name another axis"),
        (walk, {"markers_map": "r_thigh=femur"}, "femur is no body of the model; there are pelvis, femur_r"),
        (walk, {"time": (9.0, 10.0)}, "no frame between 9 and 10 s"),
        (walk, {"calibration": sto}, "a.sto `calibration`: is no .c3d file, which walk.c3d is"),
        (walk, {"calibration": named}, "named.sto `calibration`: is no .c3d file, which walk.c3d is"),
        (sto, {"calibration": MESHES / "gait.csv"}, "gait.csv `calibration`: is no .sto file, which a.sto is"),
        (sto, {"calibration": other}, "was not recorded; there are arm_imu"),
        (trc, {"calibration": standing}, "`calibration`: has no effect: markers.trc holds markers, not segments"),
        (plain, {}, "DataType=double cannot be used; DataType=Quaternion is expected"),
        (long, {}, "line 7: the quaternion of pelvis_imu has the length 1.4"),
        (other, {}, "no segment has the name of a body: arm_imu; name them with `markers_map` l_thigh=femur_l"),
        (sto, {"weight": ("pelvis_imu=-1",)}, "a weight is negative"),
        (
            sto,
            {"weight": nothing},
            "a.sto `weight`: no orientation of a segment has a weight, and no origins; leave one",
        ),
        (walk, {"weight": two_origins}, "no orientation of a segment has a weight, and 2 origins; leave one"),
        (unseen, {"calibration": sto}, "unseen.sto: no frame shows any of these segments; is it the right file?"),
    ):
        with pytest.raises(InputError, match=line.replace("(", r"\(")):
            gc.inverse_kinematics(file, model=LEG, axes=LABORATORY, **options)


def test_a_folder_of_poses_is_read(poses: tuple[Path, Path], tmp_path: Path) -> None:
    walk, _ = poses
    refused = call("scale", walk, "--model", LEG, "--mass", "23", "--out", tmp_path / "no")
    assert refused.code == 2 and "ROTATION:LABELS: holds poses of segments" in refused.err, refused.err
    given = ("--model", LEG, "--axes", LABORATORY, "--heading", "pelvis=-z")
    ours = done(call("ik", tmp_path, *given, "--out", tmp_path / "o", folder=tmp_path / "o"))
    q = read_table(tmp_path / "o" / "ik.mot").column("knee")
    assert ours.code == 0 and np.abs(q - np.degrees(swing()[:, 9])).max() < 1e-4
    parts = {row["part"]: row["file"] for row in ours.record()["folder"]["parts"]}
    assert parts["calibration"] == "static.c3d" and (tmp_path / "o/segments.csv").exists()
    write_theia(tmp_path / "cal2.c3d", segments(STANDING))
    (one,) = folder_inputs("ik", tmp_path, typed=frozenset({"model"}))
    assert "cal2, static are static: say with `calibration`" in one.warnings[0]
    assert "calibration" not in dict(one.options)


def test_sensors_give_what_opensense_finds(opensim: Elsewhere, tmp_path: Path) -> None:
    """IMUPlacer and IMUInverseKinematicsTool of OpenSim on the same files, with 3 degrees of noise."""
    rng, q = np.random.default_rng(4), swing(20)
    noisy = sensors(q)
    for name, each in noisy.items():
        off = Rotation.from_rotvec(np.radians(3.0) * rng.normal(size=(20, 3)))
        noisy[name] = (Rotation.from_quat(each, scalar_first=True) * off).as_quat(scalar_first=True)
    time = np.arange(20) / RATE
    walk = write_sensors(tmp_path / "walk.sto", time, noisy)
    standing = write_sensors(tmp_path / "standing.sto", time[:2], sensors(STANDING, PLACE))
    given = (LEG, standing, walk, "pelvis_imu", "-z", (-np.pi / 2.0, 0.0, 0.0), tmp_path)
    names, theirs = opensim(opensim_oracle.orientation_kinematics, *given)
    ours = gc.inverse_kinematics(walk, model=LEG, calibration=standing, heading="pelvis_imu=-z", axes=LABORATORY)
    theirs = theirs[:, [names.index(name) for name in ANGLES]]
    assert np.abs(np.degrees(found(ours, ANGLES)) - theirs).max() < 0.05
    assert np.degrees(np.abs(found(ours, ANGLES) - np.delete(q, (3, 4, 5), axis=1))).max() > 1.0
