"""The benchmark of regions: what is withheld acts where it says, its figures by hand, and what is written."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from benchmarks.gap.clean_regime import some_rows
from benchmarks.gap.regions import (
    EFFECTS,
    FITS,
    KINDS,
    NOISE,
    STIFFNESS,
    biases,
    case,
    compared,
    f1,
    figures,
    true_cells,
)
from geocontact.identify.noise.covariance import Whitener
from tests.elsewhere import Elsewhere

RESULTS = Path(__file__).resolve().parents[2] / "benchmarks" / "results" / "gap_regions.json"


def test_what_is_withheld_is_what_the_trials_have_beside_a_spring() -> None:
    """A line through the origin fitted to the rest has a slope near k; the rest of that is noise."""
    for kind in KINDS:
        one, withheld = case(kind, 0)
        for trial in (*one.calibration, *one.evaluation):
            angle, torque = trial.column("angle"), trial.column("torque") - withheld[trial.name]
            slope = float(angle @ torque / (angle @ angle))
            assert slope == pytest.approx(STIFFNESS, rel=0.08)
            assert np.std(torque - slope * angle) == pytest.approx(NOISE, rel=0.15)
            assert bool(np.any(withheld[trial.name])) == bool(kind)
    phase, angle, rate = np.array([0.4, 0.6]), np.array([0.1, 0.3]), np.array([-1.0, 1.0])
    assert EFFECTS["stop"](phase, angle, rate) == pytest.approx([0.0, 6.0])
    assert EFFECTS["load"](phase, angle, rate) == pytest.approx([0.0, 1.0])
    assert EFFECTS["friction"](phase, angle, rate) == pytest.approx([0.0, 0.6])


def test_cells_are_true_where_most_of_their_samples_are_and_scores_are_those_by_hand() -> None:
    which = (np.array([[0], [0], [0], [1], [1], [-1]]), np.array([[2], [2], [1]]))
    acts = [np.array([1, 1, 0, 0, 0, 1], bool), np.array([1, 1, 1], bool)]
    true = true_cells(which, acts, 4)
    assert list(true) == [True, False, True, False]
    found = np.array([True, True, False, True])
    scores = compared(found, true, np.array([True, True, True, False]))
    assert scores == {"right": 1, "too_many": 1, "missed": 1}
    assert f1([{"clean": scores}], "clean") == pytest.approx(2.0 * 0.5 * 0.5 / (0.5 + 0.5))
    assert np.isnan(f1([{"clean": {"right": 0, "too_many": 0, "missed": 0}}], "clean"))


def test_what_is_written_is_what_its_cases_make() -> None:
    told = json.loads(RESULTS.read_text(encoding="utf-8"))["figures"]
    again = json.loads(json.dumps({**figures(told["cases"]), "laboratories": biases(told["laboratory_cases"])}))
    assert again == {name: told[name] for name in again}
    assert set(again) == {"none", "one", "two", "laboratories"}


def test_some_rows_are_whitened_by_their_own_covariance() -> None:
    rng = np.random.default_rng(4)
    half = rng.standard_normal((6, 6))
    covariance = half @ half.T + np.eye(6)
    factor = np.linalg.inv(np.linalg.cholesky(covariance))
    whole = Whitener((np.arange(6), np.arange(6, 9)), (factor, np.eye(3)), 0.0)
    kept = np.array([True, False, True, True, False, True, True, True, False])[:, None]
    some, values = some_rows(whole, kept), rng.standard_normal((9, 1, 1))
    own = np.flatnonzero(kept[:6, 0])
    expected = np.linalg.inv(np.linalg.cholesky(covariance[np.ix_(own, own)])) @ values[own, 0]
    assert some(values) == pytest.approx(np.concatenate([expected, values[6:8, 0]]))
    nothing = some_rows(whole, np.zeros((9, 1), bool))
    assert nothing(values).shape == (0, 1)


@pytest.mark.slow
def test_a_load_is_found_where_it_acts_and_nothing_where_nothing_does(elsewhere: Elsewhere) -> None:
    from benchmarks.gap.regions import of_joint

    found = elsewhere(of_joint, ("load",), 0)
    assert found["everything"]["right"] >= 7
    assert found["everything"]["missed"] <= 1
    assert found["everything"]["too_many"] == 0
    assert tuple(found["bias"]) == FITS
    nothing = elsewhere(of_joint, (), 0)
    assert nothing["everything"] == nothing["clean"] == {"right": 0, "too_many": 0, "missed": 0}


@pytest.mark.slow
def test_a_load_has_structure_in_no_other_part_of_the_trial() -> None:
    """The stiffness is the true one, nothing is fitted: all that is missed is the load, and residuals say so."""
    from benchmarks.gap.clean_regime import on_all_trials
    from geocontact.gap.case.preparation import problem_of
    from geocontact.gap.localise.structure import Structure
    from geocontact.systems.elastic_joint import JOINT

    one, withheld = case(("load",), 0)
    problem = problem_of(one, JOINT.build(one.parameters, one.constants, one.tables))
    left = Structure.of(problem, on_all_trials(problem, {"k": STIFFNESS}))
    trials = [*problem.calibration.trials, *problem.evaluation.trials]
    true = true_cells(left.grid.which, [np.abs(withheld[each.name]) > NOISE for each in trials], 32)
    scores = compared(left.q_values[0] <= 0.05, true, left.grid.tested[0])
    assert scores["too_many"] == 0
    assert scores["right"] >= 4
