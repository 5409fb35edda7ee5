"""Moment on the cuff, torque of the joint and a fixation that yields, in what the analyses write and say."""

from __future__ import annotations

import warnings
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.misalignment.identify.fitted import Fitted
from geocontact.analyses.misalignment.identify.sentences import fixation_words, reserve_doubts
from geocontact.axis_misalignment.least_squares import Prior
from geocontact.axis_misalignment.uncertainty import Separability
from tests.analyses.misalignment.test_compare import law
from tests.analyses.misalignment.trials import KNOWN, PAPER, locked, quietly, recorded
from tests.recording import opened

L, Z = 0.169, 0.127
CUFF = ["gamma [deg]", "cuff_moment [N m]"]
JOINT = ["torque [N m]", "joint_torque [N m]", "constraint_torque [N m]", "force_across [N]"]
SOFT = {"c": 1e-3}
COARSE: dict[str, Any] = {"bin": gc.deg(5), "bootstrap": 0}


def gamma_of(beta: pd.Series, x: float, y: float) -> np.ndarray:
    """Angle of the link less that of the forearm [rad]."""
    s, c = np.sin(np.radians(beta)), np.cos(np.radians(beta))
    return np.arctan2(x * c + y * s, L + y * c - x * s)


@pytest.fixture(scope="module")
def driven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Three trials with a fixation that yields, and a column of the actuator's torque."""
    return recorded(tmp_path_factory.mktemp("driven"), numbers=SOFT, torque=2.0, bits=0)


def test_a_trial_holds_the_moment_of_its_own_force(made: Path) -> None:
    table = gc.misalignment.simulate(seconds=5.0, rate=50.0, trials=1, turning=2.0).table()
    assert list(table)[3:] == CUFF
    gamma = gamma_of(table["beta [deg]"], PAPER["x"], PAPER["y"])
    moment = 2.0 * gamma - table["force [N]"] * Z / np.cos(gamma) ** 2  # noise of the force and all
    np.testing.assert_allclose(table["gamma [deg]"], np.degrees(gamma), atol=1e-9)
    np.testing.assert_allclose(table["cuff_moment [N m]"], moment, atol=1e-12)
    assert list(pd.read_csv(locked(made)[0]))[4:] == CUFF


def test_a_column_of_torque_is_passed_on_to_the_joint(tmp_path: Path) -> None:
    """In newton millimetres and with the other sign; `torque` in its place, which pushes a soft fixation."""
    file = tmp_path / "drive.csv"
    file.write_text("time [s],beta [deg],motor [N mm]\n0,20,-500\n1,60,-2000\n2,90,-3000\n3,110,1000\n")
    along: dict[str, Any] = {"map": "torque=-motor", "turning": 2.0}
    rigid = gc.misalignment.simulate((file,), **along)
    table = rigid.table("simulated_drive")
    assert list(table)[3:] == [*CUFF, *JOINT]
    beta, gamma = np.radians(table["beta [deg]"]), np.radians(table["gamma [deg]"])
    force, moment, torque = table["force [N]"], table["cuff_moment [N m]"], np.array([0.5, 2.0, 3.0, -1.0])
    np.testing.assert_allclose(table["torque [N m]"], torque)
    reach = np.hypot(L * np.sin(beta) - PAPER["x"], PAPER["y"] + L * np.cos(beta))
    across = (torque - moment - force * L * np.sin(gamma)) / (L * np.cos(gamma))
    np.testing.assert_allclose(table["force_across [N]"], across)
    np.testing.assert_allclose(table["joint_torque [N m]"], across * reach + moment)
    held = torque - table["joint_torque [N m]"] * L * np.cos(gamma) / reach
    np.testing.assert_allclose(table["constraint_torque [N m]"], held, atol=1e-12)
    assert f"torque of the joint {table['joint_torque [N m]'].min():.2f}" in str(rigid)
    soft, pushed = (gc.misalignment.simulate((file,), **along, numbers=SOFT, torque=t).table() for t in (None, 2.5))
    assert (soft["force [N]"] - force).abs().max() > 1.0 and (soft["gamma [deg]"] - np.degrees(gamma)).abs().max() > 1.0
    assert (pushed["torque [N m]"] == 2.5).all() and (pushed["force [N]"] - soft["force [N]"]).abs().max() > 0.5
    with pytest.raises(gc.InputError, match=r"does not come to rest .*; give a smaller c, or less `torque`"):
        gc.misalignment.simulate((file,), **along, numbers={"c": 1.0})


@pytest.mark.slow
def test_a_fit_with_a_known_fixation_tells_the_moment_under_load(driven: Path) -> None:
    result = quietly(gc.misalignment.identify, *locked(driven), known=KNOWN["known"] | SOFT, cutoff=5.0, **COARSE)
    bins, numbers = result.table("bins"), result.numbers
    gamma = np.radians(bins["gamma [deg]"])
    np.testing.assert_allclose(bins["cuff_moment [N m]"], -bins["fitted [N]"] * Z / np.cos(gamma) ** 2, atol=1e-12)
    assert np.abs(gamma - gamma_of(bins["beta [deg]"], numbers["x"], numbers["y"])).max() > np.radians(1.0)
    assert any("locked_1, locked_2, locked_3: an actuator's torque pushes" in line for line in result.warnings)
    assert not any("hardly separate" in line for line in result.warnings), "c is not asked for"


@pytest.mark.slow
def test_a_fixation_that_is_hardly_told_is_warned_of_unless_more_is_known(made: Path) -> None:
    result = quietly(gc.misalignment.identify, *locked(made), known=KNOWN["known"], free=("c",), **COARSE)
    found = result.fit
    share = result.summary["identifiability"]["fixation_from_cuff"]["own_beside_all_free"]
    assert 0.0 < share < 0.1 and f"(only {share:.2%} of the effect of c on the force is its own)" in hardly_told(found)
    assert "(not at all)" in hardly_told(replace(found, separable=Separability(0.0, 0.0)))
    assert not hardly_told(replace(found, separable=Separability(0.5, 0.2)))
    for name in ("k", "c", "l"):
        problem = replace(found.estimate.problem, priors={name: Prior(1.0, 0.1)})
        assert bool(hardly_told(replace(found, estimate=replace(found.estimate, problem=problem)))) == (name == "l")
    assert (
        "Cuff (k) and fixation of the upper arm (c) yield in series. Of the effect of a yielding fixation"
        in fixation_words(found)
    )


def hardly_told(found: Fitted) -> str:
    """The warning of c, or nothing."""
    record = opened(Record("elbow fit", {}))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        reserve_doubts(found, None)
    return next((line for line in record.warnings if "hardly separate the compliance c" in line), "")


def test_a_law_with_a_fixation_is_compared_with_it(tmp_path: Path) -> None:
    files = locked(recorded(tmp_path, numbers=SOFT, noise=0.01, bits=0))
    soft = quietly(gc.misalignment.compare, *files, fit=law(tmp_path, c_mm_per_N=1.0)).table()
    np.testing.assert_allclose(soft["rmse"], 0.01, rtol=0.5)
    assert (quietly(gc.misalignment.compare, *files, fit=law(tmp_path)).table()["rmse"] > 0.3).all()
