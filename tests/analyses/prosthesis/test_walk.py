"""Both legs in motion by the analysis: what is refused, and a walk of known motion and forces from files to files."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.motion.marker_tasks import MarkerErrors
from geocontact.analyses.prosthesis.walk.options import ProsthesisWalkOptions
from geocontact.analyses.prosthesis.walk.result import goodness_of, names_of_side, pelvis_residuals
from geocontact.analyses.prosthesis.walk.show import in_body_weight, spoken, walk_curves
from geocontact.analyses.prosthesis.walk.steps import read
from geocontact.below_knee_prosthesis.both_sides.walk import WholeMotion
from geocontact.below_knee_prosthesis.evaluation import PlateStance
from geocontact.below_knee_prosthesis.leg import MIDDLE
from geocontact.identify.signals.agreement import Agreement
from tests.analyses.prosthesis.walk_trial import known_walk
from tests.cli.calls import MESHES
from tests.recording import opened

STOOD, TRIAL = MESHES / "amputee_P1", MESHES / "gait_P1_medium_1"
GIVEN: dict[str, Any] = {
    "static": STOOD / "standing.trc",
    "mass": 77.3,
    "plates": TRIAL / "plates.mot",
    "plate": "own_force",
    "other_plate": "other_force",
}


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"plate": "other_force"}, "other_force is named for both feet"),
        ({"plate": "third"}, "no plate 'third'"),
        ({"static": TRIAL / "standing.trc"}, "no marker"),
        ({}, "no marker LTH1, LTH2, LTH3"),
        ({"time": (0.1, 0.6)}, "do not cover a whole stance on own_force"),
        ({"residual_markers": "RKNE,REND"}, "no marker REND"),
    ],
)
def test_refused(changed: dict[str, Any], words: str) -> None:
    """The walking trial of the stance has the prosthetic side's markers only."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        with pytest.raises(gc.InputError, match=words):
            gc.prosthesis.walk(TRIAL / "walking.trc", **(GIVEN | changed))


def test_names_of_a_left_prosthesis_change_sides() -> None:
    names = ("pelvis_tilt", "hip_flexion_r", "ankle_flexion_l", "keel_1_r")
    assert names_of_side(names, "left") == ("pelvis_tilt", "hip_flexion_l", "ankle_flexion_r", "keel_1_l")
    assert names_of_side(names, "right") == names


def test_coordinates_are_spoken_and_forces_have_their_unit_on_the_page() -> None:
    assert spoken("hip_flexion_r") == "hip flexion, right" and spoken("pelvis_tilt") == "pelvis tilt"
    time = np.arange(3.0)
    plate = PlateStance(time, np.zeros((3, 3)), np.zeros((3, 3)))
    names = ("hip_flexion_r", "hip_flexion_l", "hip_rotation_l", "ankle_flexion_l", "ankle_inversion_l")
    sheet = walk_curves(time, np.zeros((3, 3)), plate, 700.0, dict.fromkeys(names, time))
    labels = {panel.title: [curve.name for curve in panel.curves] for panel in sheet.panels}
    assert labels["Moment: hip flexion"] == ["right", "left"]
    assert labels["Moment: ankle"] == ["flexion, left", "inversion, left"]
    errors = pd.DataFrame({"quantity": ["vertical", "cop_x"], "unit": ["-", "m"], "rmse": [0.1, 0.01]})
    assert list(in_body_weight(errors)["unit"]) == ["BW", "m"] and list(errors["unit"]) == ["-", "m"]


def test_residuals_on_the_pelvis_of_a_left_prosthesis_are_those_of_the_laboratory() -> None:
    """Mirrored at z = 0, list, rotation and what is along z change sign; joints, socket and keel are no residuals."""
    names = ("pelvis_tilt", "pelvis_list", "pelvis_rotation", "pelvis_tx", "pelvis_tz", "hip_flexion_r", "socket_tx_r")
    none = np.zeros((2, len(names)))
    motion = WholeMotion(np.arange(2.0), names, none, none, none, none, 0)
    forces = none + np.arange(1.0, 8.0)
    found = {name: column[0] for name, column in pelvis_residuals(motion, forces, "left").items()}
    signed = {"pelvis_tilt": 1.0, "pelvis_list": -2.0, "pelvis_rotation": -3.0, "pelvis_tx": 4.0, "pelvis_tz": -5.0}
    assert found == signed
    assert {name: column[0] for name, column in pelvis_residuals(motion, forces, "right").items()} == {
        name: abs(value) for name, value in signed.items()
    }


def test_an_intact_foot_on_spheres_is_tested_as_well() -> None:
    """As on spheres that press where the plate does not: R² of the intact foot's force below 0 contradicts the data."""
    good, bad = (Agreement(0.1, 0.1, 0.0, r2, 0.0, 0.9, 101) for r2 in (0.9, -0.4))
    own = {("prosthesis", name): good for name in ("resultant", "vertical", "cop_x", "cop_z")}
    markers = MarkerErrors(0.002, 0.006, "RASI", 0.1)
    assert goodness_of(own, markers).outcome == "fits"
    assert goodness_of(own | {("intact", "vertical"): bad}, markers).outcome == "fits"
    for name, words in (("resultant", "resultant force"), ("cop_x", "centre of pressure")):
        (doubt,) = goodness_of(own | {("intact", name): bad}, markers).doubts
        assert doubt.contradicts and doubt.what.startswith(f"{words} of the intact foot: R² is -0.40")


@pytest.mark.parametrize(("rmsd", "doubted"), [(0.054, False), (0.1, False), (0.119, True), (0.135, True)])
def test_a_foot_in_another_setting_is_doubted(rmsd: float, doubted: bool) -> None:
    """Figures of the shipped trial, of its medium setting: in medium, on the limit, in low and in high."""
    good, own = Agreement(0.1, 0.1, 0.0, 0.9, 0.0, 0.9, 101), Agreement(rmsd, rmsd, 0.0, 0.79, 0.0, 0.9, 101)
    errors = {("prosthesis", "resultant"): own, ("prosthesis", "cop_x"): good}
    fit = goodness_of(errors, MarkerErrors(0.002, 0.006, "RASI", 0.1))
    assert fit.outcome == ("doubtful" if doubted else "fits")
    assert not doubted or "is it this foot, in this setting" in fit.words


@pytest.mark.slow
def test_the_foot_of_a_law_is_raised_and_turned(tmp_path: Path) -> None:
    """As `prosthesis simulate` does with the same file: the middle of the keel 4 mm up, its pitch -0.012 rad."""
    law = tmp_path / "law.toml"
    law.write_text("[foot]\nheight = 4e-3\npitch = -0.012\n")
    given = GIVEN | {"static": STOOD / "standing.trc", "plates": STOOD / "plates.mot"}
    trial = STOOD / "walking.trc"
    opened(Record("prosthesis walk", {}))
    stood, raised = (read(ProsthesisWalkOptions(trial, **given, law=file)).amputee.prosthetic for file in (None, law))
    assert (raised.offset.height, raised.offset.pitch) == (4e-3, -0.012)
    turned = stood.turn.inv() * raised.turn
    np.testing.assert_allclose(turned.as_rotvec(), [0.0, 0.0, -0.012], atol=1e-12)
    middle = stood.keel + stood.turn.apply(MIDDLE + np.array([0.0, 4e-3, 0.0]))
    np.testing.assert_allclose(raised.keel + raised.turn.apply(MIDDLE), middle, atol=1e-12)


@pytest.mark.slow
@pytest.mark.long
def test_a_known_walk_by_angles_and_by_torques(tmp_path: Path) -> None:
    """Exact markers and no filter: the force is that of the truth, and its torques hold through single support."""
    known, options = known_walk(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.prosthesis.walk(tmp_path / "walking.trc", by="torques", **options)
    walk, weight = found.moved.walk, known.truth.mass * 9.80665
    truth = np.column_stack([np.interp(walk.time, known.walk.time, column) for column in known.walk.force.T])
    assert np.sqrt(np.mean((walk.force - truth) ** 2)) < 0.01 * weight
    errors = found.table("errors").set_index(["foot", "quantity"])
    assert errors.loc[("prosthesis", "resultant"), "rmse"] < 0.01
    beside = found.moved.beside
    assert beside is not None and beside.held > 0.3
    moments = found.table("moments").set_index("coordinate")
    knee = found.moments["knee_flexion_r"]
    assert moments.loc["knee_flexion_r", "peak moment [N m]"] == pytest.approx(np.abs(knee).max(), rel=1e-12)
    found.write(tmp_path / "out")
    for name, unit in (("pelvis_tz", "N"), ("pelvis_list", "N m")):
        column = found.table("walk")[f"{name} residual [{unit}]"]
        np.testing.assert_array_equal(column, found.moved.forces[:, walk.names.index(name)])
    assert errors.loc[("prosthesis", "cop_x"), "r2 [-]"] > 0.9
    for name in (
        "walk.csv",
        "moments.csv",
        "work.csv",
        "angles.csv",
        "errors.csv",
        "played_back.csv",
        "coordinates.sto",
        "report.html",
    ):
        assert (tmp_path / "out" / name).is_file(), name
