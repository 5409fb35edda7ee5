"""Arms of a person who walks, in the frame of a shoulder exoskeleton attached virtually: no truth, but bounds."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geocontact.data.multibody.marker_trajectories import MarkerTrajectories
from geocontact.io.mocap.markers import read_markers
from geocontact.shoulder_exoskeleton.from_markers.arm_motions import ArmMotions, arm_motions

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
