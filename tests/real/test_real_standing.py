"""Real recordings in phase A: steps of a walk, by markers and by a whole body's inverse kinematics, and a squat."""

from __future__ import annotations

from argparse import Namespace
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from benchmarks.standing.real import steps
from geocontact.io.text.tables import read_table

WALK = {"plates": "subject01_walk1_grf.mot", "model": "subject01_simbody.osim"}
FEET = {"right": "ground_force", "left": "1_ground_force"}
BELT = 1.11
"""m/s, by the flat foot's own speed; the recording does not have it."""


@pytest.mark.slow
def test_feet_of_a_recorded_walk(data_dir: Path) -> None:
    found = steps(Namespace(data=data_dir, nodes=60.0))
    for kind in ("calibrated", "held out"):
        assert found[kind]["ending"] == "solved"
        for step in found[kind]["steps"].values():
            assert step["certified"] and step["CoP [mm]"] < 10.0 and max(step["foot [mm]"]) < 10.0, step


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::geocontact.InputWarning")
@pytest.mark.parametrize("leg", ["right", "left"])
def test_a_stance_from_inverse_kinematics_without_hand_work(data_dir: Path, tmp_path: Path, leg: str) -> None:
    """OpenSim's Gait2354 on a treadmill: its ik.mot, model and plates to a certified phase A."""
    home = data_dir / "opensim_walk"
    files = {name: home / file for name, file in WALK.items()}
    made = gc.sit_to_stand.coordinates(home / "subject01_walk1_ik.mot", **files, leg=leg, belt=BELT)
    assert {place.name: place.carries for place in made.given.places} == {FEET[s]: f"{s} foot" for s in FEET}
    assert max(place.away for place in made.given.places) < 0.03
    assert [one.task for one in made.spans] == ["stance"]
    off = made.table("deviations")
    assert off["rms"].max() < 6.0  # degrees out of the plane
    found = gc.sit_to_stand.calibrate(made.write(tmp_path / "made") / "study.toml", nodes=60, resamples=0)
    assert found.found.solved and all(trial.certified for trial in found.trials)
    assert found.fit_outcome != "contradicts"
    errors = found.errors.set_index("quantity")["rmsd"]
    assert errors["centre"] < 10.0 and errors["force_y"] < 10.0 and errors["foot_turn"] < 3.0
    toe = found.parameters["A", "toe"] - found.parameters["A", "heel"]
    assert 0.1 < toe < 0.25  # between the spheres' centres, of a foot of 0.26 m


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::geocontact.InputWarning")
def test_squats_of_a_whole_body_and_phase_a_of_one(data_dir: Path, tmp_path: Path) -> None:
    """OpenCap's markerless squats, which have no plates: five, symmetric to degrees; what is under the feet is not
    identified by coordinates alone, and the calibration says so.
    """
    home = data_dir / "opencap"
    files = {"model": home / "LaiArnoldModified2017_contacts.osim"}
    whole = gc.sit_to_stand.coordinates(home / "squats1_videoAndMocap.mot", **files)
    assert any("2.04139 m is unusual for the height of a person" in line for line in whole.warnings)
    assert [one.task for one in whole.spans] == ["squat"] * 5
    off = whole.table("deviations").set_index(["what", "of"])["rms"]
    assert off["right less left", "thigh"] < 3.0 and off["right less left", "shank"] < 5.0
    table = read_table(home / "squats1_videoAndMocap.mot")
    bent = np.degrees(whole.coordinates["knee"])
    both = 0.5 * (table.column("knee_angle_r") + table.column("knee_angle_l"))
    assert np.corrcoef(bent, both)[0, 1] > 0.999 and np.abs(bent - both).max() < 15.0  # by the thighs' slant
    one = gc.sit_to_stand.coordinates(home / "squats1_videoAndMocap.mot", **files, time=(1.6, 3.2))
    found = gc.sit_to_stand.calibrate(one.write(tmp_path / "one") / "study.toml", resamples=0)
    assert found.found.solved and all(trial.certified for trial in found.trials)
    status = found.table("parameters").set_index("parameter")["verdict"]
    assert status["radius"] == "prior-dominated" and "known" not in set(status)
    assert "ground reaction" not in found.sentences[0]
