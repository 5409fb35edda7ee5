"""Shear that load cells in the thigh's strap measured, beside the model's: a spring between two rods, by other code."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from benchmarks.standing.shear import MESHES, PLANTED, read_sto, shear_of, write_study
from geocontact.analyses.sit_to_stand.compare.result import nearer_than_both
from geocontact.analyses.sit_to_stand.standing_trials import standing_trials
from geocontact.analyses.sit_to_stand.trial_recordings import site_shear
from geocontact.standing_up.chain import Subject
from geocontact.standing_up.prediction import ALL
from geocontact.standing_up.strap import strap_force
from geocontact.standing_up.trivial_trials import mean_trial


def test_the_model_s_shear_is_that_of_a_spring_between_two_rods() -> None:
    """Along the shipped coordinates, without the dashpot; the force's part along the thigh, by hand."""
    table = read_sto(MESHES / "standing_up_held_out" / "P1_coordinates.sto")
    q = table.iloc[:, 1:].to_numpy()
    values = {"strap normal": 4500.0, "strap tangential": 2000.0, "strap turning": 30.0, "strap place": 0.22}
    found = strap_force(Subject(70.0, 1.75), q, 0.0 * q, values)
    thigh = table["foot_turn"] + table["ankle"] + table["knee"]
    along = -np.sin(thigh) * found.force[:, 0] + np.cos(thigh) * found.force[:, 1]
    still = table.assign(time=1e9 * table["time"])  # no rate, no dashpot
    np.testing.assert_allclose(along, shear_of(still, 2000.0, 0.22), atol=1e-6)
    assert np.ptp(along) > 5.0


def test_shear_is_read_with_its_unit_and_confronted_with_friction(tmp_path: Path) -> None:
    """Beyond the normal force of the mat it is named; without the column nothing is read."""
    study = write_study(tmp_path)
    with pytest.warns(gc.InputWarning, match=r"P1 strap: the measured shear exceeds friction 1 times the normal force"):
        read = standing_trials(study, "study").trials[0]
    assert read.shear is not None
    recorded = pd.read_csv(tmp_path / "P1_strap.csv")
    assert np.isclose(read.shear[:, None], recorded["shear [N]"].to_numpy()[None]).any(axis=1).all()
    recorded["shear [kN]"] = 1e-3 * recorded.pop("shear [N]")
    recorded.to_csv(tmp_path / "P1_strap.csv", index=False)
    with pytest.warns(gc.InputWarning, match="exceeds friction"):
        again = standing_trials(study, "study").trials[0].shear
    assert again is not None
    np.testing.assert_allclose(again, read.shear, atol=1e-6)
    plain = standing_trials(MESHES / "standing_up_held_out" / "study.toml", "study").trials[0]
    assert plain.shear is None
    assert mean_trial([read, plain], read.time).shear is None
    np.testing.assert_allclose(mean_trial([read, read], read.time).shear, read.shear)


def test_noise_of_a_slow_strap_is_no_shear_beyond_friction(tmp_path: Path) -> None:
    """Load cells of 1 N of noise at a fifth of the rate, at the limit: no sample exceeds it by 3 N."""
    study = write_study(tmp_path)
    recorded = pd.read_csv(tmp_path / "P1_strap.csv").iloc[::5]
    recorded["shear [N]"] = recorded["normal [N]"].abs() + np.random.default_rng(5).normal(0.0, 1.0, len(recorded))
    recorded.to_csv(tmp_path / "P1_strap.csv", index=False)
    with warnings.catch_warnings(record=True) as seen:
        warnings.simplefilter("always")
        assert standing_trials(study, "study").trials[0].shear is not None
    assert not [each for each in seen if "exceeds friction" in str(each.message)]


def test_all_files_of_a_strap_have_shear_or_none(tmp_path: Path) -> None:
    time = np.linspace(0.0, 1.0, 11)
    one, other = tmp_path / "front.csv", tmp_path / "behind.csv"
    pd.DataFrame({"time [s]": time, "normal [N]": 5.0, "shear [N]": 2.0 * time}).to_csv(one, index=False)
    pd.DataFrame({"time [s]": time, "normal [N]": -3.0}).to_csv(other, index=False)
    with pytest.raises(gc.InputError, match=r"behind\.csv: no column shear, which front\.csv of the same strap has"):
        site_shear([one, other], time)
    assert site_shear([other], time) is None
    found = site_shear([one, one], time)
    assert found is not None
    np.testing.assert_allclose(found, 4.0 * time)


def test_a_channel_without_baseline_is_not_lost() -> None:
    rows = [
        (ALL, "strap", "no", 1.0),
        (ALL, "strap shear", "no", 2.0),
        ("mean of the calibration", "strap", "no", 3.0),
        ("nearest of the calibration", "strap", "no", 2.0),
        ("mean of the calibration", "strap shear", "no", np.nan),
    ]
    errors = pd.DataFrame(rows, columns=["predictor", "quantity", "given", "rmsd"]).assign(trial="P1")
    assert nearer_than_both(errors) == (1, 1)


@pytest.mark.filterwarnings("ignore:.*is unusual for how many nodes")
@pytest.mark.slow
def test_the_comparison_has_error_bias_and_r2_of_the_shear(tmp_path: Path) -> None:
    """By hand from the curves of the result itself."""
    study = write_study(tmp_path)
    with pytest.warns(gc.InputWarning, match="exceeds friction"):
        found = gc.sit_to_stand.compare(study, parameters=PLANTED, against=PLANTED.with_name("study.toml"), nodes=5)
    table = found.table()
    row = table[(table["quantity"] == "strap shear") & (table["predictor"] == ALL)].iloc[0]
    own = next(one.trial for one in found.predictions if one.name == ALL)
    off = own.model.shear - own.recorded.shear
    spread = own.recorded.shear - own.recorded.shear.mean()
    expected = [np.sqrt(np.mean(off**2)), np.mean(off), 1.0 - off @ off / (spread @ spread)]
    assert row[["rmsd", "bias", "r2 [-]"]].tolist() == pytest.approx(expected)
    assert row["r2 [-]"] > 0.3
