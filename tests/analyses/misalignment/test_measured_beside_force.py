"""A measured moment of the cuff sets the scale that no force can; the arm's measured angle sets the shape."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from tests.analyses.misalignment.measured_arm import TRUE, record
from tests.analyses.misalignment.trials import quietly

pytestmark = pytest.mark.slow
PER = {"k": 1.0, "x": 1e3, "y": 1e3, "l": 1e3, "z": 1e3}
RATIOS = {"k_times_l": TRUE["k"] * TRUE["l"], **{f"{n}_over_l": TRUE[n] / TRUE["l"] for n in "xyz"}}


def fit(files: tuple[Path, ...], **options: Any) -> Any:
    return quietly(gc.misalignment.identify, *files, **{"bootstrap": 0} | options)


def errors(result: Any, measured: str) -> pd.Series:
    """Standard errors with one set of sensors, by number."""
    table = result.table("identifiability")
    return table[table["measured"] == measured].set_index("number")["standard error"]


@pytest.fixture(scope="module")
def both(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """Moment and angle measured, nothing known; the cuff resists turning, the angle's zero is off."""
    return fit(record(tmp_path_factory.mktemp("both"), turning=2.0, level=0.05))


@pytest.fixture(scope="module")
def angle(tmp_path_factory: pytest.TempPathFactory) -> Any:
    """The angle alone."""
    return fit(record(tmp_path_factory.mktemp("angle"), moment=False))


def test_the_moment_sets_the_scale(both: Any) -> None:
    assert not both.summary["scale_free"] and both.fit_outcome == "fits"
    for name, true in TRUE.items():
        one = both.summary["intervals"][name]
        low, high = one["profile_likelihood"]
        assert low < true * PER[name] < high and high - low < 0.05 * true * PER[name], name
    assert not any("one factor" in line for line in both.warnings)


def test_what_a_sensor_does_not_know_of_itself_is_found_beside(both: Any) -> None:
    moment, arm = both.summary["beside_force"]["sensors"]
    turning = moment["turning_N_m_per_rad"]
    assert turning["value"] == pytest.approx(2.0, abs=0.02) and 0.0 < turning["se"] < 0.01
    zeros = np.degrees([0.05, 0.075, 0.1])
    np.testing.assert_allclose(arm["zeros_deg"], zeros, atol=0.12)
    white = 0.02 * np.sqrt(0.02 / 0.05)  # noise is that of means over 0.05 s
    assert moment["noise_sd_N_m"] == pytest.approx(white, rel=0.15)
    assert max(moment["over_noise"], arm["over_noise"]) < 1.3


def test_force_alone_beside_what_else_was_measured(both: Any) -> None:
    force, moment = errors(both, "force"), errors(both, "force + moment of the cuff")
    every = errors(both, "force + moment of the cuff + angle of the arm")
    assert force[list(TRUE)].isna().all() and moment[list(TRUE)].notna().all()
    assert (every[list(TRUE)] < moment[list(TRUE)]).all()
    ratios = ["x/l", "y/l", "z/l", "k l"]
    assert (moment[ratios] < 0.5 * force[ratios]).all() and (every[ratios] < moment[ratios]).all()
    assert any(line.startswith("force: k l ± ") and "l, z up to one factor only" in line for line in both.sentences)
    page = both.pages({})["report.html"]
    assert "What each set of sensors identifies" in [getattr(each, "title", "") for each in page.sections]
    assert len(both.curves()["beside_force"].panels) == 2


def test_an_angle_has_no_scale_and_says_the_ratios(angle: Any) -> None:
    assert angle.summary["scale_free"] and any("a column moment" in line for line in angle.warnings)
    for key, true in RATIOS.items():
        low, high = angle.summary["intervals"][key]["profile_likelihood"]
        assert low < true < high and high - low < 0.05 * true, key
    assert errors(angle, "force + angle of the arm")[list(TRUE)].isna().all()


def test_a_zeroed_angle_and_a_known_stiffness_say_more(both: Any, tmp_path: Path) -> None:
    files = record(tmp_path, turning=2.0)
    stated = fit(files, turning=2.0, alpha_zeroed=True)
    last = "force + moment of the cuff + angle of the arm"
    assert (errors(stated, last)[list("kxylz")] < errors(both, last)[list("kxylz")]).all()
    assert [each["zeros_deg"] for each in stated.summary["beside_force"]["sensors"] if "zeros_deg" in each] == [[]]
    assert stated.table("numbers").set_index("number").loc[["turning", "alpha_zeroed"], "value"].tolist() == [2.0, 1.0]
    wrong = fit(record(tmp_path / "off", turning=2.0, level=0.05), alpha_zeroed=True)
    assert wrong.fit_outcome == "contradicts" and "measured angle of the arm is off by" in str(wrong)


def test_a_moment_of_the_other_sign_contradicts(tmp_path: Path) -> None:
    turned = fit(record(tmp_path, sign=-1.0, alpha=False))
    assert turned.fit_outcome == "contradicts"
    assert "the moment of the cuff fits better with its sign turned" in str(turned)


def test_draws_of_the_bootstrap_are_of_all_sensors(tmp_path: Path) -> None:
    drawn = fit(record(tmp_path), bootstrap=100)
    for name, true in TRUE.items():
        one = drawn.summary["intervals"][name]
        (low, high), (least, most) = one["profile_likelihood"], one["wild_bootstrap"]
        assert least < true * PER[name] < most, name
        assert 0.5 < (most - least) / (high - low) < 2.0, name


def test_options_of_sensors_that_are_not_there_are_refused(tmp_path: Path) -> None:
    files = record(tmp_path, moment=False, alpha=False)
    with pytest.raises(gc.InputError, match="`turning` needs a column moment"):
        fit(files, turning=2.0)
    with pytest.raises(gc.InputError, match="`alpha_zeroed` needs a column alpha"):
        fit(files, alpha_zeroed=True)
