"""Arms of real people in the frame of a shoulder exoskeleton that is attached virtually: no truth, but bounds.

One person walks; another one raises an arm, whose recorded angles move the virtual markers of an OpenSim model.
"""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.data.errors import InputError, InputWarning
from geocontact.data.multibody.markers import MarkerTrajectories
from geocontact.data.multibody.model import Multibody
from geocontact.io.mocap.markers import read_markers
from geocontact.io.opensim.coordinates import motion_of
from geocontact.io.opensim.osim_multibody import read_multibody
from geocontact.io.text.tables import read_table
from geocontact.shoulder_exoskeleton.arms_from_markers import ArmMotions, arm_motions

NAMES = {f"{side}.{theirs}": f"{side}{own}" for side in "RL" for theirs, own in (("Shoulder", "SHO"), ("Elbow", "ELB"))}
PELVIS = {"R.ASIS": "RASI", "L.ASIS": "LASI", "R.PSIS": "RPSI", "L.PSIS": "LPSI"}


@pytest.fixture(scope="module")
def walk(data_dir: Path) -> MarkerTrajectories:
    return read_markers(data_dir / "opensim_walk" / "markers_walk.trc").renamed(NAMES | PELVIS)


@pytest.fixture(scope="module")
def motions(walk: MarkerTrajectories) -> ArmMotions:
    return arm_motions(walk)


def test_arms_hang_beside_the_trunk_and_swing(motions: ArmMotions) -> None:
    """Elevation of 13 to 24 degrees, arms in front of a bar behind the acromia, in opposite phase."""
    right, left = motions.of("right"), motions.of("left")
    for arm, outward in ((right, -1.0), (left, 1.0)):
        elevation = np.degrees(arm.elevation)
        assert elevation.min() > 10.0 and elevation.max() < 27.0 and np.ptp(elevation) > 4.0
        assert np.all(outward * arm.interface[:, 0] > outward * arm.shoulder[:, 0])
        length = np.linalg.norm(arm.interface - arm.shoulder, axis=1)
        assert length.min() > 0.15 and np.ptp(length) < 0.012, "skin moves, bones do not grow"
    assert np.corrcoef(right.interface[:, 1], left.interface[:, 1])[0, 1] < -0.8
    assert "attached virtually to RSHO, LSHO, RASI, LASI, RPSI, LPSI" in motions.notes[0]


def test_trunk_is_upright(motions: ArmMotions) -> None:
    gravity = motions.of("right").gravity_at_frames()
    assert np.degrees(np.arccos(-gravity[:, 2] / 9.80665)).max() < 6.0


def test_elevation_is_that_of_the_laboratory_but_for_the_trunk(walk: MarkerTrajectories, motions: ArmMotions) -> None:
    """The angle to the plumb line differs by the inclination of the trunk at most."""
    for arm, side in ((motions.of("right"), "R"), (motions.of("left"), "L")):
        shoulder, elbow = np.moveaxis(walk.of((f"{side}SHO", f"{side}ELB")), 1, 0)
        along = (elbow - shoulder) / np.linalg.norm(elbow - shoulder, axis=1, keepdims=True)
        gravity = arm.gravity_at_frames() / 9.80665
        inclined = np.arccos(-gravity[:, 2])
        assert np.all(np.abs(arm.elevation - np.arccos(-along[:, 1])) <= inclined + 1e-9)


def test_a_marker_on_the_biceps_says_where_the_cuff_is(walk: MarkerTrajectories, motions: ArmMotions) -> None:
    """Beside the arm's axis; along it at 73 and 66 % of the way to the elbow, where 60 % are guessed."""
    found = arm_motions(walk.renamed({"R.Biceps": "humerus_rdn", "L.Biceps": "humerus_ldn"}))
    for one, guessed, share in zip(found.arms, motions.arms, (0.73, 0.66), strict=True):
        np.testing.assert_allclose(one.elevation, guessed.elevation, atol=1e-12)
        lengths = [np.linalg.norm(arm.interface - arm.shoulder, axis=1) for arm in (one, guessed)]
        assert 0.6 * lengths[0] / lengths[1] == pytest.approx(np.full(len(one.time), share), abs=0.03)
    assert "the cuff is taken where humerus_rdn lies along the line from RSHO to RELB" in found.notes[1]


def test_a_device_that_nobody_wore_is_simulated_and_doubted(data_dir: Path) -> None:
    """The swinging arms of a walk in a virtual device: no truth, but bounds; exchanged sides are refused."""
    markers = data_dir / "opensim_walk" / "markers_walk.trc"
    whose = {"RSHO": "LSHO", "LSHO": "RSHO", "RELB": "LELB", "LELB": "RELB"}
    right, exchanged = (
        ",".join(f"{theirs}={turned.get(own, own)}" for theirs, own in (NAMES | PELVIS).items())
        for turned in ({}, whose)
    )
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        found = gc.shoulder.simulate(markers, markers_map=right, level=0.0)
        with pytest.raises(InputError, match="left and right are exchanged"):
            gc.shoulder.simulate(markers, markers_map=exchanged, level=0.0)
    for side in ("right", "left"):
        table = found.table(side)
        assert np.isfinite(table.select_dtypes(float).to_numpy()).all() and table["supporting [N]"].abs().max() < 60.0
    told = "\n".join(found.warnings)
    assert "attached virtually" in told and "numbers are invented" in told


TRUNK = {"c7": "C7", "t8": "T8", "ij": "CLAV", "px": "STRN", "gu": "RSHO", "centelbow": "RELB"}
RAISED = ("FLX01", "FLX02", "ABD01", "ABD02", "ABD03")
CLAVICLE, SCAPULA = (-0.0378874, 0.018924, 0.135987), (-0.0118287, 0.000106018, -0.0145474)
"""The acromioclavicular joint in the frames of both bones, a constraint of the model [m]."""


@pytest.fixture(scope="module")
def thoracoscapular(data_dir: Path) -> Multibody:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)  # the constraint that couples clavicle and scapula
        return read_multibody(data_dir / "rmr_shoulder" / "TSM_subject_CMC_noWeight.osim")


def recorded(data_dir: Path, model: Multibody, name: str) -> tuple[np.ndarray, np.ndarray]:
    table = read_table(data_dir / "rmr_shoulder" / f"{name}.mot")
    return table.time, motion_of(table, model)


@pytest.mark.parametrize("name", [*RAISED, "SHRUG01"])
def test_clavicle_and_scapula_meet_as_opensim_had_them(data_dir: Path, thoracoscapular: Multibody, name: str) -> None:
    """OpenSim's inverse kinematics kept both ends together; along its angles they are within 2 µm."""
    _, values = recorded(data_dir, thoracoscapular, name)
    poses = thoracoscapular.poses(values)
    apart = poses["clavicle"].apply(CLAVICLE) - poses["scapula"].apply(SCAPULA)
    assert np.linalg.norm(apart, axis=1).max() < 2e-6


def arm_of(data_dir: Path, model: Multibody, name: str) -> ArmMotions:
    time, values = recorded(data_dir, model, name)
    markers = MarkerTrajectories(time, model.marker_places(values), tuple(m.name for m in model.markers))
    return arm_motions(markers.renamed(TRUNK))


@pytest.mark.parametrize("name", RAISED)
def test_a_recorded_arm_is_raised_overhead(data_dir: Path, thoracoscapular: Multibody, name: str) -> None:
    """From 10 to 151 degrees and back, in front of the bar; the trunk stays within 5 degrees of upright."""
    found = arm_of(data_dir, thoracoscapular, name)
    (arm,) = found.arms
    assert arm.side == "right" and "attached virtually to CLAV, C7, STRN, T8" in found.notes[0]
    elevation = np.degrees(arm.elevation)
    assert elevation.min() == pytest.approx(11.0, abs=1.5) and elevation.max() == pytest.approx(151.5, abs=1.5)
    assert elevation[0] < 20.0 and elevation[-1] < 25.0
    assert np.degrees(np.arccos(-arm.gravity_at_frames()[:, 2] / 9.80665)).max() < 5.0
    np.testing.assert_allclose(np.linalg.norm(arm.interface - arm.shoulder, axis=1), 0.148, atol=1e-3)
    up = arm.interface[elevation.argmax()] - arm.shoulder[elevation.argmax()]
    assert up[1] < 0.0 and up[0] < 0.0 and up[2] > 0.12, "up, to the front and to the right"


def test_the_same_movement_again_is_alike(data_dir: Path, thoracoscapular: Multibody) -> None:
    """Peaks of three abductions and two flexions lie within 2 degrees; a shrug raises the arm by less than 8."""
    peaks = [np.degrees(arm_of(data_dir, thoracoscapular, name).arms[0].elevation.max()) for name in RAISED]
    assert np.ptp(peaks) < 2.0
    assert np.degrees(np.ptp(arm_of(data_dir, thoracoscapular, "SHRUG01").arms[0].elevation)) < 8.0


def test_virtual_markers_of_a_recorded_arm_move_the_device(data_dir: Path, tmp_path: Path) -> None:
    """By the commands `markers` and `simulate`: at 124 degrees the arm leaves a cuff that was attached by guess.

    The whole recording, up to 151 degrees and down again, is refused (it was a result at 248 N, the sphere 220 mm from
    the cuff's middle); every sentence about its beginning says so.
    """
    folder = data_dir / "rmr_shoulder"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        made = gc.virtual_markers(folder / "FLX01.mot", model=folder / "TSM_subject_CMC_noWeight.osim")
        names = ",".join(f"{theirs}={own}" for theirs, own in TRUNK.items())
        options = {"markers_map": names, "level": 0.5}
        markers = made.write(tmp_path / "m") / "markers.trc"
        with pytest.raises(InputError, match=r"far out of the cuff for 74% of the time, between 2\.06 and 7\.93 s"):
            gc.shoulder.simulate(markers, **options)
        found = gc.shoulder.simulate(markers, time=(0.0, 2.5), **options)
    (arm,) = found.arms
    s, told = arm.simulation, "\n".join(found.warnings)
    assert np.degrees(s.motion.elevation.max()) == pytest.approx(128.0, abs=1.5)
    assert found.sentences[0].endswith("; the sphere is out of the cuff for 43% of the time")
    inside = ~s.out_of_cuff
    assert inside.sum() > 100 and np.abs(s.supporting[inside]).max() < 60.0
    assert np.degrees(np.abs(s.elevation - s.motion.elevation)[inside]).max() < 45.0
    for words in ("only the right arm was recorded", "attached virtually to CLAV, C7, STRN, T8", "out of the cuff"):
        assert words in told, words
