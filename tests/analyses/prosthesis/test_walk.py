"""Both legs in motion by the analysis: what is refused, and a walk of known motion and forces from files to files."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.prosthesis.walk.result import names_of_side
from tests.analyses.prosthesis.walk_trial import known_walk
from tests.cli.calls import MESHES

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
    for name in ("walk.csv", "moments.csv", "errors.csv", "played_back.csv", "coordinates.sto", "report.html"):
        assert (tmp_path / "out" / name).is_file(), name
