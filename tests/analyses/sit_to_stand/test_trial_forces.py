"""Forces on the person out of a trial's files: mats on the thigh add, one on no body is refused, a chair counts."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.analyses.sit_to_stand.trial_recordings import strap_force
from geocontact.io.recordings.standing_study import read_standing_study
from tests.cli.calls import MESHES
from tests.recording import opened

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
    assert "\n" not in str(refused.value)
    assert "geocontact mat frames.csv with a scan of the thigh as" in str(refused.value)


def test_forces_of_mats_in_front_and_behind_add(tmp_path: Path) -> None:
    time = np.linspace(0.0, 2.0, 21)
    for name, force in (("front", -3.0 * time), ("behind", 5.0 * time)):
        wrench = {"time [s]": time, "fx [N]": force, "fy [N]": 9.0 + 0.0 * time, "normal [N]": np.abs(force)}
        pd.DataFrame(wrench).to_csv(tmp_path / f"{name}.csv", index=False)
    study = read_standing_study(study_with(tmp_path, '["front.csv", "behind.csv"]'))
    files, at = study.trials[0].strap, np.linspace(0.5, 1.5, 5)
    assert [each.name for each in files] == ["front.csv", "behind.csv"]
    opened(Record("sit-to-stand calibrate", {}))
    total = np.sum([strap_force(file, "strap", "thigh", at) for file in files], axis=0)
    np.testing.assert_allclose(total, 2.0 * at, atol=1e-12)


def test_a_trial_may_have_the_mats_of_some_sites_only(tmp_path: Path) -> None:
    """As in the study: both matrices at the pelvis in one configuration, at thigh and shank in the other."""
    study = study_with(tmp_path, '"T1_strap.csv"')
    text = study.read_text().replace('strap = "T2_strap.csv"', 'strap_pelvis = "T2_strap.csv"')
    study.write_text(text)
    trials = standing_trials(study, "study")
    assert [site.name for site in trials.sites] == ["thigh", "pelvis"]
    first, second, _ = trials.trials
    assert np.isfinite(first.strap).all() and np.isnan(first.elsewhere["pelvis"]).all()
    assert np.isnan(second.strap).all() and np.ptp(second.elsewhere["pelvis"]) > 5.0
    with pytest.raises(gc.InputError, match="no pelvis strap normal"):
        gc.sit_to_stand.design(study, parameters=WORN / "truth.csv")


def test_a_trial_may_begin_on_the_chair(tmp_path: Path) -> None:
    """The shipped study with its first trial from sitting on: 300 N at first, none at the end, nor in the others."""
    for each in (MESHES / "standing_up").iterdir():
        text = each.read_text().replace('chair = "chair_force"', 'chair = "chair_force"\nsitting = true', 1)
        (tmp_path / each.name).write_text(text)
    trials = standing_trials(tmp_path / "study.toml", "study")
    first, second, _ = trials.trials
    assert trials.seated and first.chair is not None and second.chair is not None
    np.testing.assert_allclose(first.chair[0], [0.0, 300.0, -0.3 * 300.0], atol=0.05)
    assert np.abs(first.chair[-1]).max() < 1e-6 and not second.chair.any()
    assert first.time[-1] - second.time[-1] > 0.3 + 1.5 - 1.3 - 0.02
    text = (tmp_path / "study.toml").read_text()
    (tmp_path / "study.toml").write_text(text.replace('chair = "chair_force"\nsitting', "sitting", 1))
    with pytest.raises(gc.InputError, match="sitting needs the force of a chair"):
        gc.sit_to_stand.calibrate(tmp_path / "study.toml")
