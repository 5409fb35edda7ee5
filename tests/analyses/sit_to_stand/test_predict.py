"""A prediction by the analysis: what is refused at once, the trivial predictor, and the shipped trial."""

from __future__ import annotations

import warnings
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from unittest import mock

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.frame.record import Record
from geocontact.analyses.sit_to_stand.compare import result as comparison
from geocontact.analyses.sit_to_stand.compare.options import StandingCompareOptions
from geocontact.analyses.sit_to_stand.predict import predictions
from geocontact.analyses.sit_to_stand.predict.options import StandingPredictOptions
from geocontact.analyses.sit_to_stand.predict.predictions import HeldOutTrials, Keep, read
from geocontact.analyses.sit_to_stand.predict.result import StandingPredictResult, run
from geocontact.dynamics.collocation.blocks import sparse_program
from geocontact.dynamics.collocation.motion import scheme
from geocontact.dynamics.collocation.transcription import Transcription, scales_from
from geocontact.standing_up.exoskeleton import strapped
from geocontact.standing_up.phases import TRACKS_C, phase_c
from geocontact.standing_up.prediction import ALL, PredictedTrial
from geocontact.standing_up.trials import StandingTrial
from geocontact.standing_up.trivial_trials import mean_trial
from tests.analyses.sit_to_stand.ctrl_c import Interrupting
from tests.cli.calls import MESHES
from tests.recording import opened

WORN, ALONE, HELD_OUT = (MESHES / f"standing_up{kind}" / "study.toml" for kind in ("_exoskeleton", "", "_held_out"))
TRUTH = WORN.parent / "truth.csv"


@pytest.mark.parametrize(
    ("study", "against", "words"),
    [(ALONE, WORN, "is not of a person with an exoskeleton"), (HELD_OUT, ALONE, "is not of a person with an")],
)
def test_trials_without_an_exoskeleton_are_refused(study: Path, against: Path, words: str) -> None:
    with pytest.raises(gc.InputError, match=words):
        gc.sit_to_stand.predict(study, parameters=TRUTH, against=against)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("parameter,unit", "name,unit", "has no columns"),
        ("strap normal,N/m,4500", "strap normal,N/mm,4.5", "'N/mm'"),
        ("strap normal,N/m,4500", "strap normal,N/m,soft", "is not a number"),
        ("strap normal,", "strap_normal,", "no strap normal"),
        ("strap normal,N/m,4500", "strap normal,N/m,-4500", "outside 100 to 100000"),
        ("heel,m,-0.045", "heel,m,-45", "outside -0.09 to 0.02"),
        ("heel,m,-0.045", "heel,m,-0.045\nheel,m,-0.04", "is there twice"),
    ],
)
def test_parameters_that_cannot_be_are_refused(tmp_path: Path, old: str, new: str, words: str) -> None:
    text = TRUTH.read_text()
    assert old in text
    file = tmp_path / "parameters.csv"
    file.write_text(text.replace(old, new))
    with pytest.raises(gc.InputError, match=words):
        gc.sit_to_stand.predict(HELD_OUT, parameters=file, against=WORN)


def test_mean_of_trials_is_over_parts_of_the_movement() -> None:
    """Straight lines of one course and different durations: their mean is that course."""

    def line(seconds: float, end: float) -> StandingTrial:
        time = np.linspace(0.0, seconds, 21)
        part = time / seconds
        return StandingTrial(
            time, part[:, None] * end, np.zeros((21, 1)), np.zeros((21, 2)), part, "T", None, end * part
        )

    mean = mean_trial([line(1.0, 1.0), line(3.0, 3.0)], np.linspace(5.0, 7.0, 11))
    np.testing.assert_allclose(mean.q[:, 0], 2.0 * np.linspace(0.0, 1.0, 11), atol=1e-12)
    assert mean.strap is not None and mean.torque is None
    np.testing.assert_allclose(mean.strap, 2.0 * np.linspace(0.0, 1.0, 11), atol=1e-12)


def test_ctrl_c_keeps_what_there_is_and_a_trial_is_written_when_it_is_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Pressed in the second of three trials: the first is in the folder by then, the third is never begun."""
    text = HELD_OUT.read_text()
    head, trial = text.split("[[trials]]")
    study = tmp_path / "study.toml"
    for file in HELD_OUT.parent.glob("P1_*"):
        (tmp_path / file.name).symlink_to(file)
    study.write_text("[[trials]]".join([head, *(trial.replace('"P1"', f'"P{k}"') for k in (1, 2, 3))]))
    monkeypatch.setattr(predictions, "GIVEN", {ALL: TRACKS_C})
    out = tmp_path / "pred"
    seen: list[set[str]] = []

    class Watching(Interrupting):
        @contextmanager
        def stages(self, label: str):  # type: ignore[no-untyped-def]
            with super().stages(label) as told:

                def watched(stage: str) -> None:
                    if stage.startswith("trial 2 of 3") and not seen:
                        seen.append({file.name for file in out.glob("*")})
                    told(stage)

                yield watched

    o = StandingPredictOptions(study, parameters=TRUTH, against=WORN, nodes=12.0)
    record = opened(
        Record("sit-to-stand predict", {}, listener=Watching("trial 2 of 3, P2 all given, iteration 3"), out=out)
    )
    result = run(read(o), o)
    assert {"errors.csv", "certificate.csv", "trial_P1.csv", "solution_P1.sto"} <= seen[0]
    assert "run.json" not in seen[0] and "trial_P2.csv" not in seen[0]
    assert [one.trial.recorded.name for one in result.predictions] == ["P1", "P2"]
    assert not result.accepted and not result.predictions[1].solved
    assert "interrupted: 1 of 3 trials have every predictor; the last search was P2 all given" in record.warnings
    assert any(line.startswith("P2 all given did not converge: interrupted") for line in record.warnings)
    assert set(result.table("errors")["trial"]) == {"P1", "P2"}


@pytest.fixture(scope="module")
def shipped() -> StandingPredictResult:
    """The shipped trial by every predictor, on 15 intervals a second; with the usual 45 `make long` predicts it."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", gc.InputWarning)
        return gc.sit_to_stand.predict(HELD_OUT, parameters=TRUTH, against=WORN, nodes=15.0)


@pytest.mark.slow
def test_shipped_trial_is_predicted(shipped: StandingPredictResult, tmp_path: Path) -> None:
    """The strap follows from torques and ground reaction, not without the torques; the motion is certified."""
    assert shipped.accepted, shipped.warnings
    errors = shipped.table("errors")
    strap = errors[errors["quantity"] == "strap"].set_index("predictor")["rmsd"]
    (unplaced,) = [line for line in shipped.sentences if "place along the ground" in line]
    assert unplaced.startswith("without ground reaction:") and unplaced.endswith("1.5 mm")
    assert strap["all given"] < 10.0 < strap["without torques"]
    assert set(strap.index) == {"all given", "without ground reaction", "without torques", "mean of the calibration"}
    names = {each.name for each in shipped.write(tmp_path / "pred").iterdir()}
    assert {"errors.csv", "certificate.csv", "trial_P1.csv", "solution_P1.sto", "strap.png", "report.html"} <= names


def test_without_a_centre_of_pressure_nothing_determines_the_place_along_the_ground() -> None:
    """All places moved by 1 mm: cost and constraints stay as they are, but for what is given a centre."""
    given = read(StandingPredictOptions(HELD_OUT, parameters=TRUTH, against=WORN))
    model = strapped(given.trials.subject, given.known.sites)
    changes = {}
    for one in given.predictors:
        (trial,), trials = given.trials.trials, given.trials
        phase = phase_c(model, trials.subject, trial, trials.noise, one.p, tracks=one.tracks, weights=trials.weights)
        on = Transcription(phase.control, scheme("radau", 3), (np.linspace(0.0, 1.0, 7),), scales_from(phase.control))
        program, z = sparse_program(on.blocks(), on.size), on.guess()
        p, (motion,) = on.unpacked(z)
        states = motion.states.copy()
        states[..., 0] += 1e-3
        moved = on.again(p, (replace(motion, states=states, end=motion.end + 1e-3 * np.eye(1, len(motion.end))[0]),))
        first, second = (np.concatenate([np.ravel(each) for each in program.value(at, [])]) for at in (z, moved))
        changes[one.name] = np.abs(second - first) / np.maximum(np.abs(first), 1.0)
    assert changes["without ground reaction"].max() < 1e-9
    assert min(changes[name].max() for name in (ALL, "without torques")) > 1e-3


@pytest.mark.slow
def test_shipped_trial_beside_its_recording(shipped: StandingPredictResult, tmp_path: Path) -> None:
    """What is given is told; the hip is nearer than by either trivial predictor. Predictions are those of above."""

    def predicted(given: HeldOutTrials, o: StandingCompareOptions, keep: Keep) -> tuple[PredictedTrial, ...]:
        assert given.trials.trials[0].name == "P1" and o.nodes == shipped.options.nodes
        keep(shipped.predictions)
        return shipped.predictions

    with warnings.catch_warnings(), mock.patch.object(comparison, "predicted", predicted):
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
