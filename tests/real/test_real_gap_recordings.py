"""Gap cases of a real knee and of real steps: they are made and diagnosed, and the answers hold together.

Nobody knows what their models lack, so no verdict is asked for.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from benchmarks.gap import real_gaps
from geocontact.gap.diagnose import diagnose
from geocontact.io.cases.gap_case import read_gap_case
from geocontact.systems.catalogue import system_of

pytestmark = pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")
SUBJECTS = ("knee", "treadmill")


@pytest.fixture(scope="module")
def work(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("recordings")


@pytest.fixture(scope="module")
def said(data_dir: Path, work: Path) -> dict[str, dict[str, Any]]:
    return {name: each["as stated"] for name, each in real_gaps.diagnosed(data_dir, work, stated_only=True).items()}


@pytest.mark.slow
@pytest.mark.parametrize("subject", SUBJECTS)
def test_the_answer_holds_together(subject: str, said: dict[str, dict[str, Any]]) -> None:
    one = said[subject]
    assert sum(one["probabilities"].values()) == pytest.approx(1.0, abs=1e-9)
    assert min(one["probabilities"].values()) >= 0.0
    assert (one["verdict"] in ("explained", "partly_explained")) == bool(one["effects"])
    assert set(one["effects"]) <= set(one["ambiguity"]) or not one["effects"]
    for gap in one["gap"].values():
        low, high = gap["ci95"]
        assert low <= gap["reduction"] <= high <= 1.0
        assert np.isfinite([gap["rmse_before"], gap["rmse_after"], gap["noise_floor"]]).all()
        if one["verdict"] in ("unknown", "no_gap"):
            assert gap["rmse_after"] == gap["rmse_before"] and gap["reduction"] == 0.0
    assert one["verdict"] == "no_gap" or sum(w["share"] for w in one["where"]) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.slow
def test_steps_are_those_of_the_plates(said: dict[str, dict[str, Any]], work: Path) -> None:
    """Three steps over ground and four on the belt; half a body weight on the loaded foot throughout its middle."""
    assert len(said["overground"]["made"]["samples"]) == 3 and len(said["treadmill"]["made"]["samples"]) == 4
    assert 1.0 < said["treadmill"]["made"]["belt_m_per_s"] < 1.3
    assert said["overground"]["made"]["belt_m_per_s"] == 0.0
    cases = {name: real_gaps.place(work, name, "as stated") for name in ("overground", "treadmill")}
    cases["overground"] = work / "refused" / cases["overground"].name
    for place in cases.values():
        case = read_gap_case(place)
        for trial in (*case.calibration, *case.evaluation):
            force, cop = trial.column("force_y"), trial.column("cop_x")
            steady = force > 300.0
            assert 0.4 < np.mean(force > 20.0) <= 1.0 and 700.0 < force.max() < 1000.0
            assert cop[steady].min() > -0.05 and cop[steady].max() < 0.33, "under the foot"
            assert np.abs(trial.column("y")[np.abs(trial.column("pitch")) < 0.02]).max() < 0.012, (
                "flat is on the ground"
            )


@pytest.mark.slow
def test_one_step_held_out_is_refused(said: dict[str, dict[str, Any]]) -> None:
    assert "1 trial held out" in said["overground"]["refused"] and "verdict" not in said["overground"]


@pytest.mark.slow
def test_the_knee_is_cut_as_told(said: dict[str, dict[str, Any]], work: Path) -> None:
    """Areas are those that the data are known for at 4 mm; forces are in newtons and begin where the poses do."""
    case = read_gap_case(real_gaps.place(work, "knee", "as stated"))
    trials = sorted((*case.calibration, *case.evaluation), key=lambda trial: trial.time[0])
    time = np.concatenate([trial.time for trial in trials])
    assert (np.diff(time) > 0.0).all() and np.diff(time).max() < 0.01
    areas = np.concatenate([trial.column("area_medial") + trial.column("area_lateral") for trial in trials])
    assert 1.39e-3 < areas.min() < 1.42e-3 and 2.15e-3 < areas.max() < 2.23e-3
    force = np.concatenate([trial.column("force_medial") + trial.column("force_lateral") for trial in trials])
    assert 1300.0 < force.max() < 2200.0 and force.min() > 0.0
    assert said["knee"]["made"]["samples"] == {trial.name: len(trial) for trial in trials}


@pytest.mark.slow
def test_the_answer_does_not_depend_on_names(said: dict[str, dict[str, Any]], work: Path) -> None:
    """The same trials under other names, diagnosed again: the same to the last digit."""
    case = read_gap_case(real_gaps.place(work, "knee", "as stated"))
    renamed = tuple(replace(trial, name=f"other_{k}") for k, trial in enumerate(case.calibration))
    again = diagnose(replace(case, name="other", calibration=renamed), system_of(case)).diagnosis.as_dict()
    for key in ("verdict", "effects", "probabilities", "where", "gap", "parameters"):
        assert again[key] == said["knee"][key], key
