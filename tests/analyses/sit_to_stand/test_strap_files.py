"""The force of a strap from mats on the thigh: several add, and a mat on no body is refused."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.run_record import Record
from geocontact.analyses.sit_to_stand.trial_channels import strap_force
from geocontact.io.recordings.standing_study import read_standing_study
from tests.cli.calls import MESHES

WORN = MESHES / "standing_up_exoskeleton"


def study_with(folder: Path, strap: str) -> Path:
    """The shipped study whose first trial has other files of the strap."""
    for each in WORN.iterdir():
        text = each.read_text()
        (folder / each.name).write_text(text.replace('"T1_strap.csv"', strap) if each.suffix == ".toml" else text)
    return folder / "study.toml"


def test_a_mat_that_is_not_registered_is_refused_in_one_line(tmp_path: Path) -> None:
    (tmp_path / "frames.csv").write_text((MESHES / "mat_thigh_16x8" / "frames.csv").read_text())
    with pytest.raises(gc.InputError, match="the mat is not registered to a body") as refused:
        gc.sit_to_stand.calibrate(study_with(tmp_path, '"frames.csv"'))
    assert "\n" not in str(refused.value) and "geocontact mat" in str(refused.value)


def test_forces_of_mats_in_front_and_behind_add(tmp_path: Path) -> None:
    time = np.linspace(0.0, 2.0, 21)
    for name, force in (("front", -3.0 * time), ("behind", 5.0 * time)):
        wrench = {"time [s]": time, "fx [N]": force, "fy [N]": 9.0 + 0.0 * time, "normal [N]": np.abs(force)}
        pd.DataFrame(wrench).to_csv(tmp_path / f"{name}.csv", index=False)
    study = read_standing_study(study_with(tmp_path, '["front.csv", "behind.csv"]'))
    files, at = study.trials[0].strap, np.linspace(0.5, 1.5, 5)
    assert [each.name for each in files] == ["front.csv", "behind.csv"]
    record = Record("sit-to-stand calibrate", {})
    total = np.sum([strap_force(file, record, "strap", at) for file in files], axis=0)
    np.testing.assert_allclose(total, 2.0 * at, atol=1e-12)
