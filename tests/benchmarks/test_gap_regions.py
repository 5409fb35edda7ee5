"""The benchmark of regions: what is withheld acts where it says, its figures by hand, and what is written."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

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


@pytest.mark.slow
def test_a_stop_bends_the_stiffness_of_everything_and_less_that_of_the_clean_regime(elsewhere: Elsewhere) -> None:
    from benchmarks.gap.regions import of_joint

    found = elsewhere(of_joint, ("stop",), 0)
    assert found["bias"]["clean"] < 0.5 * found["bias"]["everything"]
    assert found["clean"]["right"] > found["clean"]["missed"] + found["clean"]["too_many"]
    assert tuple(found["bias"]) == FITS
