"""Predictions beside recordings: the nearest trial, and the shipped one from files to files."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.standing_up.trials import StandingTrial
from geocontact.standing_up.trivial_trials import nearest_trial
from tests.cli.calls import MESHES

WORN, HELD_OUT = (MESHES / f"standing_up_{kind}" / "study.toml" for kind in ("exoskeleton", "held_out"))
TRUTH = WORN.parent / "truth.csv"


def test_nearest_trial_is_so_by_its_first_and_last_angles() -> None:
    """Wherever the foot stands, and whatever happens between."""

    def trial(name: str, foot: float, first: float, middle: float) -> StandingTrial:
        q = np.zeros((3, 4))
        q[:, 0], q[:, 3] = foot, (first, middle, 0.0)
        return StandingTrial(np.arange(3.0), q, 0.0 * q, np.zeros((3, 2)), np.zeros(3), name)

    others = [trial("far", 0.0, 1.0, 0.5), trial("near", 5.0, 0.8, 9.0)]
    assert nearest_trial(others, trial("own", 0.0, 0.7, 0.5)).name == "near"


@pytest.mark.slow
def test_shipped_trial_beside_its_recording(tmp_path: Path) -> None:
    """What is given is told; the hip is nearer than by either trivial predictor."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.sit_to_stand.compare(HELD_OUT, parameters=TRUTH, against=WORN, nodes=15.0)
    errors = found.table("comparison").set_index(["predictor", "quantity"])
    assert errors["rmsd"].ge(errors["mae"] - 1e-12).all()
    assert errors.loc[("all given", "knee torque"), "given"] == "yes"
    assert errors.loc[("without torques", "knee torque"), "given"] == "no"
    best, mean, near = (
        errors.loc[name] for name in ("all given", "mean of the calibration", "nearest of the calibration")
    )
    assert best.loc["hip", "rmsd"] < 0.5 * min(mean.loc["hip", "rmsd"], near.loc["hip", "rmsd"])
    assert best.loc["hip", "r2 [-]"] > 0.99
    names = {each.name for each in found.write(tmp_path / "compared").iterdir()}
    assert {"comparison.csv", "certificate.csv", "comparison.png", "report.html", "run.json"} <= names
