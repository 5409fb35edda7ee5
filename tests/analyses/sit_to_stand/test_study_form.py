"""Tables and figures in the form of the study: numbers by hand, channels once, factors where they are asked for."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.sit_to_stand.predict import predictions
from geocontact.analyses.sit_to_stand.predict.predictions import perturbed
from geocontact.analyses.sit_to_stand.rmsd_by_trial import largest_sd, rmsd_by_trial
from geocontact.analyses.sit_to_stand.study_figures import GROUND, KINEMATICS, STRAPS, contact_laws, study_figure
from geocontact.standing_up.phase import JudgedMotion
from geocontact.standing_up.phases import TRACKS_C
from geocontact.standing_up.prediction import ALL
from geocontact.standing_up.trial_result import TrialResult
from geocontact.standing_up.trials import StandingNoise, StandingTrial
from tests.cli.calls import MESHES

WORN, HELD_OUT = (MESHES / f"standing_up{kind}" / "study.toml" for kind in ("_exoskeleton", "_held_out"))
TRUTH = WORN.parent / "truth.csv"
NOISE = StandingNoise()
OFF = np.radians([1.0, 2.0, 3.0, 4.0, 5.0, 9.0])
"""By which the model's six hinges are off."""


def trial(name: str, seconds: float, end: float, off: float = 0.0) -> StandingTrial:
    """Nine straight lines from 0 to `end`, the hinges `off` times OFF away; force and strap likewise."""
    time = np.linspace(0.0, seconds, 41)
    part = time / seconds
    q = part[:, None] * np.full(9, end)
    q[:, 3:] += off * OFF
    force = np.column_stack([10.0 * part, 700.0 + 0.0 * part]) + 3.0 * off
    return StandingTrial(time, q, np.gradient(q, time, axis=0), force, 0.1 * part, name, None, 20.0 * part * end)


def result(recorded: StandingTrial, model: StandingTrial) -> TrialResult:
    none = np.zeros(0)
    judged = JudgedMotion(None, none, none, none)
    return TrialResult(recorded=recorded, model=model, points=model, acceleration=none[:, None], judged=judged)


def test_joints_are_pooled_as_the_study_does() -> None:
    """Offsets of 1, 2, 3, 4, 5 and 9 degrees: mean 4, standard deviation √8; one channel has none."""
    recorded = [trial("T1", 1.0, 0.5), trial("T2", 2.0, 0.8)]
    table = rmsd_by_trial("phase", {"A": [result(recorded[0], trial("T1", 1.0, 0.5, off=1.0))]}, recorded, NOISE)
    rows = table.set_index("variable")
    assert rows.loc["angles", "mean"] == pytest.approx(4.0)
    assert rows.loc["angles", "sd over channels"] == pytest.approx(np.sqrt(8.0))
    assert rows.loc["angles", "channels"] == 6 and rows.loc["angles", "unit"] == "deg"
    assert rows.loc["angular velocities", "mean"] == pytest.approx(0.0, abs=1e-9)
    assert rows.loc["ground reaction along x", "mean"] == pytest.approx(3.0)
    assert np.isnan(rows.loc["ground reaction along x", "sd over channels"])
    assert "moments of the person" not in rows.index, "no torques were recorded"


def test_spread_over_trials_is_at_the_same_part_of_the_movement() -> None:
    """Lines to 0.5 and to 0.8 rad, of 1 s and of 2 s, differ most at their ends: 0.3/√2 rad."""
    recorded = [trial("T1", 1.0, 0.5), trial("T2", 2.0, 0.8)]
    assert largest_sd(["hip"], recorded, NOISE) == pytest.approx(np.degrees(0.3 / np.sqrt(2.0)))
    assert largest_sd(["strap"], recorded, NOISE) == pytest.approx(20.0 * 0.3 / np.sqrt(2.0))
    assert np.isnan(largest_sd(["hip"], recorded[:1], NOISE))


def test_figures_have_what_was_recorded_once() -> None:
    """Two predictions of one trial: two curves by the model and one as recorded in each of twelve panels."""
    seen = trial("P1", 1.0, 0.5)
    shown = {
        "P1 all given": result(seen, trial("P1", 1.0, 0.5, 1.0)),
        "P1 × 1.4": result(seen, trial("P1", 1.0, 0.5, 2.0)),
    }
    sheet = study_figure(KINEMATICS, shown, NOISE)
    assert [panel.title for panel in sheet.panels] == list(KINEMATICS) and len(KINEMATICS) == 12
    for panel in sheet.panels:
        assert [curve.name for curve in panel.curves] == ["P1 recorded", "P1 all given", "P1 × 1.4"]
    ankle = sheet.panels[0].curves
    np.testing.assert_allclose(ankle[1].values - ankle[0].values, 1.0)
    np.testing.assert_allclose(ankle[2].values - ankle[0].values, 2.0)
    assert [panel.title for panel in study_figure(GROUND, shown, NOISE).panels] == list(GROUND)
    assert [panel.title for panel in study_figure(STRAPS, shown, NOISE).panels] == ["strap"], "where a strap is"


def test_contact_laws_by_hand() -> None:
    """Simbody's formula at 5 mm and at the transition velocity; the printed law reaches the same friction there."""
    numbers = {"stiffness": 3e6, "radius": 0.035, "dissipation": 1.5, "friction": 1.2}
    force, _, friction = contact_laws(numbers).panels
    k = int(np.argmin(np.abs(force.over.values - 5.0)))
    by_hand = (
        4.0 / 3.0 * 2.0**-1.5 * 3e6 * 0.035**0.5 * (0.005**2 + 1e-5) ** 0.75 * (0.5 + 0.5 * np.tanh(300.0 * 0.005))
    )
    by_hand *= 0.5 + 0.5 * np.tanh(50.0 * 2.0 / 4.5)
    assert force.curves[0].values[k] == pytest.approx(by_hand)
    at = int(np.argmin(np.abs(friction.over.values - 0.2)))
    for curve in friction.curves:
        assert curve.values[at] == pytest.approx(1.2 * 0.9 + 0.4 * 0.2)


def test_factors_of_parameters() -> None:
    values = {"heel": -0.03, "strap normal": 3e3, "strap tangential": 2e3, "strap turning": 20.0, "strap place": 0.2}
    sites = [("strap normal", "strap tangential", "strap turning", "strap place")]
    scaled = perturbed(values, {"straps": 1.4, "heel": 2.0}, sites)
    expected = {
        "heel": -0.06,
        "strap normal": 4.2e3,
        "strap tangential": 2.8e3,
        "strap turning": 28.0,
        "strap place": 0.2,
    }
    assert scaled == pytest.approx(expected)
    with pytest.raises(gc.InputError, match="there is no parameter 'knee'"):
        perturbed(values, {"knee": 1.4}, sites)
    with pytest.raises(gc.InputError, match="0 is no factor of straps"):
        gc.sit_to_stand.predict(HELD_OUT, parameters=TRUTH, against=WORN, perturb={"straps": 0.0})


@pytest.mark.slow
def test_a_perturbed_prediction_stands_beside_the_others(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """C2 beside C1: one more predictor, its parameters among the numbers, its rows in both tables."""
    monkeypatch.setattr(predictions, "GIVEN", {ALL: TRACKS_C})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        found = gc.sit_to_stand.predict(
            HELD_OUT, parameters=TRUTH, against=WORN, nodes=12.0, perturb={"strap normal": 3.0}
        )
        compared = gc.sit_to_stand.compare(
            HELD_OUT, parameters=TRUTH, against=WORN, nodes=12.0, perturb={"strap normal": 3.0}
        )
    name = "strap normal × 3"
    assert [one.name for one in found.predictions] == [ALL, name]
    table = found.table("rmsd_by_trial")
    assert set(table["predictor"]) == {ALL, name}
    errors = found.table("errors").set_index(["predictor", "quantity"])["rmsd"]
    strap = table.set_index(["predictor", "variable"]).loc[(name, "strap at the thigh"), "mean"]
    assert strap == pytest.approx(errors[(name, "strap")])
    assert errors[(name, "exo_hip")] != pytest.approx(errors[(ALL, "exo_hip")], rel=1e-3), "it does something"
    numbers = found.table("numbers").set_index("number")["value"]
    assert numbers[f"{name} strap normal"] == pytest.approx(3.0 * numbers["strap normal"])
    names = {each.name for each in found.write(tmp_path / "pred").iterdir()}
    assert {"rmsd_by_trial.csv", "kinematics.png", "straps.png"} <= names
    assert name in set(compared.table("comparison")["predictor"])
