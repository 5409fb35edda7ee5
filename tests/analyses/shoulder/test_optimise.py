"""Support profiles as a whole: synthetic persons, a study from files, and what cannot be asked for."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import geocontact as gc
from geocontact.analyses.run_record import Record
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.read import read, support_of
from geocontact.analyses.shoulder.optimise.result import ShoulderOptimiseResult
from geocontact.analyses.shoulder.support_profiles import read_profiles
from geocontact.analyses.shoulder.trial_files import trial_files
from geocontact.data.errors import InputError
from geocontact.io.text.results import write_table
from geocontact.shoulder_exoskeleton.lucy import lucy, lucy_new_cylinder
from geocontact.shoulder_exoskeleton.support.phases import SCREW
from geocontact.shoulder_exoskeleton.synthetic.design import PARTICIPANTS, TASKS, condition
from geocontact.shoulder_exoskeleton.synthetic.trial import synthetic_trial
from tests.analyses.shoulder.test_simulate import simulated

DRAWS = 20
pytestmark = pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")  # of synthetic persons


@pytest.fixture(scope="module")
def synthetic() -> ShoulderOptimiseResult:
    return gc.shoulder.optimise(draws=DRAWS)


def test_peak_torques_are_those_of_the_paper() -> None:
    angles = np.linspace(0.0, np.pi, 2001)
    for device, peak in ((lucy(), 7.8), (lucy_new_cylinder(), 12.8)):
        assert support_of(device).torque(angles).max() == pytest.approx(peak, abs=0.02)


def test_the_best_profile_is_beside_the_paper_s(synthetic: ShoulderOptimiseResult) -> None:
    """Most support while screwing with the dominant hand; the paper's factors push arms up."""
    factors = synthetic.table("factors").set_index(["profile", "task", "hand"])
    best = factors.loc["all persons"]
    assert best.loc[("T1", "dominant"), "screw-in"] > 0.9 and best.loc[("T2", "dominant"), "screw-in"] > 0.8
    assert (best.loc[("T1", "dominant")] > best.loc[("T1", "other")]).all()
    assert factors.loc[("table 3 of the paper", "T1", "other")].tolist() == [0.6, 0.6, 0.3]
    outcomes = synthetic.table("outcomes").groupby("profile")
    assert outcomes["pushed up [-]"].max()["all persons"] == 0.0
    assert outcomes["pushed up [-]"].max()["table 3 of the paper"] > 0.5
    assert outcomes["excess [N m]"].max()["one factor"] < 1e-6


def test_persons_held_out_are_judged(synthetic: ShoulderOptimiseResult) -> None:
    held = synthetic.table("held_out").set_index("person")
    assert list(held.index) == ["P1", "P2", "P3"]
    assert held["gain beyond the model's error"].tolist() == [True, False, False], "two arms are pushed up"
    assert np.all(held["taken away, lower [-]"] < held["taken away, upper [-]"])
    assert any("P3: the profile that the others make pushes an arm up 6" in line for line in synthetic.warnings)
    assert any("the persons are synthetic" in line for line in synthetic.warnings)


def test_the_profile_is_simulated(synthetic: ShoulderOptimiseResult) -> None:
    """Less reaches the arms than the cylinder gives, and without a reserve two of them are pushed up after all."""
    rows = synthetic.table("simulated").groupby("profile")
    planned = synthetic.table("outcomes").groupby("profile")["taken away [-]"].mean()["all persons"]
    assert set(rows.groups) == {"all persons", "of the others"}
    assert 0.6 * planned < rows["taken away [-]"].mean()["all persons"] < 0.9 * planned
    assert any("all persons, simulated, pushes an arm up" in line for line in synthetic.warnings)
    assert any("simulated with the device's own motion and sensors: 3" in line for line in synthetic.sentences)


def test_a_low_pass_reaches_the_torque() -> None:
    options = [ShoulderOptimiseOptions(cutoff=cutoff) for cutoff in (6.0, 2.0)]
    usual, slow = (read(each, Record("shoulder optimise", {})).trials[0].needed.total for each in options)
    assert np.abs(usual - slow).max() > 0.5


def test_files_are_written(synthetic: ShoulderOptimiseResult, tmp_path: Path) -> None:
    synthetic.write(tmp_path)
    names = {file.name for file in tmp_path.iterdir()}
    tables = {"factors.csv", "outcomes.csv", "held_out.csv", "front.csv", "simulated.csv"}
    assert names >= {*tables, "profile.png", "profile.svg", "report.html"}
    assert "Made for the others, judged on this person" in (tmp_path / "report.html").read_text(encoding="utf-8")


PERSON = '[persons.{name}]\nmass = {{ value = {mass}, unit = "kg" }}\nsex = "{sex}"\ndominant = "{dominant}"\n'
TASK = '[tasks.{name}]\ntool = {{ value = {tool}, unit = "kg" }}\npush = {{ value = {push}, unit = "N" }}\n'
TRIAL = '[[trials]]\nperson = "{p}"\ntask = "{t}"\nmarkers = "{p}{t}.trc"\ntool = "{p}{t}.csv"\nupright = [0.0, 0.25]\n'


def test_the_profiles_that_are_written_are_read_back(synthetic: ShoulderOptimiseResult, tmp_path: Path) -> None:
    """And lead a simulation, each hand with its own factors."""
    write_table(synthetic.table("factors"), tmp_path, "factors")
    back = read_profiles(tmp_path / "factors.csv")
    assert list(back) == [each.name for each in synthetic.profiles]
    for each in synthetic.profiles:
        assert back[each.name] == pytest.approx(each.factors, abs=1e-5)
    led = simulated(profile=tmp_path / "factors.csv", profile_name="P1 alone", task="T1")
    assert led.record.results["profile"] == {"name": "P1 alone", "task": "T1"}
    for arm, hand in zip(led.arms, ("dominant", "other"), strict=True):
        (wanted,) = (v for k, v in back["P1 alone"].items() if (k.task, k.hand, k.phase) == ("T1", hand, "screw-in"))
        assert arm.factor is not None and arm.factor[arm.phase == SCREW].max() == pytest.approx(wanted)


def study(folder: Path, persons: int = 2) -> Path:
    """The synthetic trials without the device as files; the push is the task's for everybody."""
    text = [TASK.format(name=task.name, tool=task.tool, push=task.push) for task in TASKS]
    for person in PARTICIPANTS[:persons]:
        text.append(PERSON.format(name=person.name, mass=person.mass, sex=person.sex, dominant=person.dominant))
        for task in TASKS:
            files = trial_files(synthetic_trial(person, task, condition("S0")))
            (folder / f"{person.name}{task.name}.trc").write_text(files["markers.trc"], encoding="ascii")
            (folder / f"{person.name}{task.name}.csv").write_text(files["tool.csv"], encoding="ascii")
            text.append(TRIAL.format(p=person.name, t=task.name))
    file = folder / "study.toml"
    file.write_text("\n".join(text), encoding="utf-8")
    return file


@pytest.mark.slow
def test_a_study_from_files_is_that_of_the_arrays(synthetic: ShoulderOptimiseResult, tmp_path: Path) -> None:
    """P1 pushes as the task says: markers to 0.01 mm through files give the profile of the synthetic arrays."""
    found = gc.shoulder.optimise(study(tmp_path), draws=DRAWS)
    assert {case.person for case in found.cases} == {"P1", "P2"} and len(found.cases) == 8
    for case in found.cases:
        if case.person == "P1":
            (same,) = (c for c in synthetic.cases if (c.person, c.task, c.hand) == (case.person, case.task, case.hand))
            inner = slice(20, -20)
            np.testing.assert_allclose(case.needed[inner], same.needed[inner], atol=0.05)
            np.testing.assert_allclose(case.full, same.full, atol=0.01)
    assert set(found.table("held_out")["person"]) == {"P1", "P2"}


@pytest.mark.slow
def test_limits_and_aims_reach_the_program() -> None:
    limited = gc.shoulder.optimise(force_limit=30.0, rate_limit=40.0, reserve=0.1, draws=DRAWS)
    outcomes = limited.table("outcomes")
    own = outcomes[outcomes["profile"] == "all persons"]
    assert own["force [N]"].max() == pytest.approx(30.0, abs=1e-3) and own["rate [N m/s]"].max() < 40.0 + 1e-6
    worst = gc.shoulder.optimise(aim="cvar", worst_share=0.2, draws=DRAWS)
    assert worst.table("factors")["lower"].iloc[1] == pytest.approx(0.0, abs=1e-6)
    both = gc.shoulder.optimise(dominant_share=0.5, draws=DRAWS)
    assert both.cases[1].needed.max() > 1.3 * limited.cases[1].needed.max(), "the other hand pushes as well"


def spoilt(folder: Path, old: str, new: str) -> Path:
    file = study(folder, 1)
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ('sex = "male"', 'sex = "m"', "sex 'm' is not in the table of segments; write female or male"),
        ('dominant = "right"', 'dominant = "both"', "dominant 'both' is no side; write right or left"),
        ('mass = { value = 82.0, unit = "kg" }', "", "[persons.P1]: no mass; add it"),
        ("value = 82.0", "value = 820.0", "820 kg is no mass of a person"),
        ('unit = "N"', 'unit = "kg"', "'kg' is not a unit of it"),
        ('person = "P1"', 'person = "P9"', "no [persons.P9]; there are P1"),
        ('task = "T1"', 'task = "T9"', "no [tasks.T9]; there are T1, T2"),
        ("upright = [0.0, 0.25]", "upright = 3", "upright 3 is no span"),
        ("[tasks.T1]", "[tasks.T1]\ndominant_share = 2", "dominant_share 2 is no share"),
        ("[tasks.T1]", "[tasks.T1]\nweight = 2", "'weight' is not known here; write tool, push, dominant_share"),
        ("[persons.P1]", "[people.P1]", "`people`: is not known here; write tasks, persons, trials"),
        ('markers = "P1T1.trc"', 'markers = "lost.trc"', "lost.trc"),
    ],
)
def test_a_study_that_cannot_be_read_is_refused(tmp_path: Path, old: str, new: str, what: str) -> None:
    with pytest.raises(InputError) as error:
        gc.shoulder.optimise(spoilt(tmp_path, old, new), draws=DRAWS)
    assert what in str(error.value) and "\n" not in str(error.value)


def test_one_person_is_not_held_out(tmp_path: Path) -> None:
    found = gc.shoulder.optimise(study(tmp_path, 1), draws=DRAWS)
    assert found.table("held_out").empty
    assert any("one person only" in line for line in found.warnings)
    found.write(tmp_path / "out")
    assert not (tmp_path / "out" / "held_out.csv").exists()


@pytest.mark.slow
def test_gaps_are_filled_up_to_a_limit(tmp_path: Path) -> None:
    """A wrist out of sight for 50 ms changes little, one for 0.4 s is refused."""
    file = study(tmp_path, 1)
    trial = synthetic_trial(PARTICIPANTS[0], TASKS[0], condition("S0"))
    places = trial.markers.positions.copy()
    wrist = trial.markers.names.index("RWRI")
    exact = gc.shoulder.optimise(file, draws=DRAWS).cases[0]
    for frames, refused in ((5, False), (40, True)):
        places[300 : 300 + frames, wrist] = np.nan
        lost = replace(trial, markers=replace(trial.markers, positions=places))
        (tmp_path / "P1T1.trc").write_text(trial_files(lost)["markers.trc"], encoding="ascii")
        if refused:
            with pytest.raises(InputError, match=r"up to 0\.2 s is bridged; fill the gap, or give a larger"):
                gc.shoulder.optimise(file, draws=DRAWS)
        else:
            np.testing.assert_allclose(gc.shoulder.optimise(file, draws=DRAWS).cases[0].needed, exact.needed, atol=1.0)


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({"worst_share": 0.2}, "has no effect with `aim` mean; give `aim` cvar"),
        ({"aim": "cvar", "worst_share": 0.0}, "is not more than 0"),
        ({"reserve": 1.0}, "100 % leaves no support"),
        ({"dominant_share": 1.5}, "150 % is not 0 to 100 %"),
        ({"draws": 3}, "3 draws are too few for an interval; give 20 or more"),
        ({"cutoff": 0.0}, "0 leaves noise in accelerations"),
        ({"device": "nothing"}, "neither a file nor a built-in device"),
    ],
)
def test_what_cannot_be_asked_for_is_refused(options: dict[str, object], what: str) -> None:
    with pytest.raises(InputError) as error:
        gc.shoulder.optimise(**options)
    assert what in str(error.value)
