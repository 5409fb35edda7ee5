"""Checks of a recorded trial on real recordings: silent, but for two markers that jump in the file itself."""

from __future__ import annotations

from pathlib import Path

import pytest
from scipy.spatial.transform import Rotation

from geocontact.analyses.motion.checked_trial import turned_plates
from geocontact.io.mocap.force_plates import read_force_plates
from geocontact.io.mocap.markers import read_markers
from geocontact.trial_checks.recorded import FootPlate, TrialInputs
from geocontact.trial_checks.table import contradictions

Z_UP = Rotation.from_matrix([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
TRIALS = {
    "bmclab": ("bmclab_gait_c3d/Gait.c3d", "bmclab_gait_c3d/Gait.c3d", None),
    "JW": ("gc4_jw_knee/c3d/jw_ngait_og3.c3d", "gc4_jw_knee/c3d/jw_ngait_og3.c3d", 66.7),
    "DM": ("gc6_dm_knee/gait/DM_ngait_og1_new.trc", "gc6_dm_knee/gait/DM_ngait_og1_grf.sto", 70.0),
    "subject01, on a treadmill": (
        "opensim_walk/subject01_walk1.trc",
        "opensim_walk/subject01_walk1_grf.mot",
        72.6,
    ),
    "walk": ("opensim_walk/markers_walk.trc", "opensim_walk/grf_walk.mot", None),
}
"""Markers, plates, and the mass where the source states it [kg]."""


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", TRIALS)
def test_a_real_trial_passes(name: str, data_dir: Path) -> None:
    markers, plates, mass = TRIALS[name]
    seen, turn = read_markers(data_dir / markers), Z_UP if markers.endswith(".c3d") else None
    under = turned_plates(read_force_plates(data_dir / plates), turn, data_dir / plates)
    trial = TrialInputs(
        seen if turn is None else seen.turned(turn),
        plates=tuple(FootPlate(plate, plates) for plate in under),
        mass=mass,
    )
    found = [f"{check.name}: {one.what}" for check, one in contradictions(trial)]
    assert [line for line in found if not line.startswith("jump: L_Midfoot")] == []
    assert bool(found) == (name == "DM")  # 40 to 50 mm within one frame, at 1.32 s, where heel and toe go on smoothly


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("name", TRIALS)
def test_a_wrong_mass_is_seen(name: str, data_dir: Path) -> None:
    """Where the mass is not stated it is that of 0.8 times the weight in a step."""
    markers, plates, mass = TRIALS[name]
    turn = Z_UP if markers.endswith(".c3d") else None
    under = turned_plates(read_force_plates(data_dir / plates), turn, data_dir / plates)
    on = tuple(FootPlate(plate, plates) for plate in under)
    right = mass or 70.0 * (1.15 if name == "walk" else 1.0)
    for factor in (0.7, 2.2046):
        found = {check.name for check, _ in contradictions(TrialInputs(plates=on, mass=factor * right))}
        assert "mass" in found
