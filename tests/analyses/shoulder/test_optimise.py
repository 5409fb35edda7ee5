"""Support profiles as a whole: synthetic persons, a study from files, and what cannot be asked for."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Literal

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
from geocontact.analyses.shoulder.devices import read_profiles
from geocontact.analyses.shoulder.optimise.options import ShoulderOptimiseOptions
from geocontact.analyses.shoulder.optimise.profiles import WORST, read
from geocontact.analyses.shoulder.optimise.result import ShoulderOptimiseResult
from geocontact.analyses.shoulder.optimise.show import answer
from geocontact.data.errors import InputError
from geocontact.io.text.results import write_table
from geocontact.shoulder_exoskeleton.support.arm_trial import support_case
from geocontact.shoulder_exoskeleton.support.closed_loop_profile import ClosedLoop
from geocontact.shoulder_exoskeleton.support.group_profiles import of_others
from geocontact.shoulder_exoskeleton.support.held_out import HeldOutSupport, judged
from geocontact.shoulder_exoskeleton.support.outcome import Factors
from geocontact.shoulder_exoskeleton.support.phase_machine import SCREW
from geocontact.shoulder_exoskeleton.support.profile_limits import Limits, SupportCase
from geocontact.shoulder_exoskeleton.synthetic import PARTICIPANTS, TASKS, condition, synthetic_trial
from meshes.overhead_files import trial_files
from tests.analyses.shoulder.test_simulate import simulated

DRAWS = 20
pytestmark = pytest.mark.filterwarnings("ignore::geocontact.data.errors.InputWarning")  # of synthetic persons


@pytest.fixture(scope="module")
def synthetic() -> ShoulderOptimiseResult:
    """All synthetic persons: half a minute."""
    return gc.shoulder.optimise(draws=DRAWS)


@pytest.fixture(scope="module")
def small(tmp_path_factory: pytest.TempPathFactory) -> ShoulderOptimiseResult:
    """Two persons with one task, and a third one of whom there is no trial."""
    return gc.shoulder.optimise(study(tmp_path_factory.mktemp("small"), 2, 1, UNSEEN), reserve=0.2, draws=DRAWS)


@pytest.mark.slow
@pytest.mark.long
def test_the_best_profile_is_beside_the_paper_s(synthetic: ShoulderOptimiseResult) -> None:
    """Most support while screwing with the dominant hand; the paper's factors push arms up."""
    factors = synthetic.table("factors").set_index(["profile", "task", "hand"])
    best = factors.loc["all persons"]
    assert best.loc[("T1", "dominant"), "screw-in"] > 0.9 and best.loc[("T2", "dominant"), "screw-in"] > 0.8
    assert (best.loc[("T1", "dominant")] > best.loc[("T1", "other")]).all()
    assert factors.loc[("table 3 of the paper", "T1", "other")].tolist() == [0.6, 0.6, 0.3]
    outcomes = synthetic.table("outcomes").groupby("profile")
    assert outcomes["pushed up [-]"].max()["all persons"] == 0.0
    # 0.45 where it was 0.70: the device's weight hangs on the arm, which the cylinder's torque alone left out
    simulated = synthetic.table("simulated").groupby("profile")
    assert simulated["pushed up [-]"].max()["table 3 of the paper"] > 0.3
    assert simulated["excess [N m]"].max()["one factor"] < 0.01


@pytest.mark.slow
@pytest.mark.long
def test_persons_held_out_are_judged(synthetic: ShoulderOptimiseResult) -> None:
    """Scaled by the weight of their arms: nobody is pushed up, and the least is sure of the lightest's gain."""
    held = synthetic.table("held_out").set_index("person")
    assert list(held.index) == ["P1", "P2", "P3"]
    assert held["pushed up [-]"].max() == 0.0 and held["pushed up, 95 % of draws [-]"].max() < 0.02
    sure = (held["gain, lower [-]"] > 0.0) & (held["pushed up, 95 % of draws [-]"] == 0.0)
    assert held["gain beyond the model's error"].tolist() == sure.tolist()
    assert held["scale [-]"].tolist() == pytest.approx([1.0, 0.802, 0.601], abs=1e-3)
    assert np.all(held["taken away, lower [-]"] < held["taken away, upper [-]"])
    assert any("the persons are synthetic" in line for line in synthetic.warnings)


@pytest.mark.slow
def test_people_it_was_not_made_with_at_a_fifth_of_reserve() -> None:
    """At most 2 % of the time, by the simulation of each; with the same factors for all the lightest is pushed up."""
    scaled, same = without("P1", "P2", "P3", scale="arm"), without("P3", scale="none")["P3"]
    assert max(each.pushed_up[0] for each in scaled.values()) <= 0.02
    assert max(each.excess[0] for each in scaled.values()) < 0.01
    assert same.pushed_up[0] > 0.04 and same.excess[0] > 0.1


def without(*persons: str, scale: Literal["arm", "none"]) -> dict[str, HeldOutSupport]:
    """Each of them with what the others make for them, as the job does at a fifth of reserve."""
    options = ShoulderOptimiseOptions(reserve=0.2, scale=scale, draws=DRAWS)
    given = read(options)
    loop = ClosedLoop(given.device, given.support, Limits(reserve=0.2), options.aim, WORST, seed=options.seed)
    make, made = of_others(loop, by_arm=scale == "arm"), dict[str, Factors]()
    for person in persons:
        own = [each for each in given.trials if each.person == person]
        made[person] = make([each for each in given.trials if each.person != person], own)
    return judged(given.trials, given.support, made, made, draws=DRAWS, seed=options.seed, reaches=loop.transfer)


def test_plan_and_simulation_agree(small: ShoulderOptimiseResult) -> None:
    """The plan at the human elevation was 44 % where the simulation had 30."""
    rows = small.table("simulated")
    exact = rows[rows["sensors"] == "exact"].groupby("profile")["taken away [-]"].mean()
    planned = small.table("outcomes").groupby("profile")["taken away [-]"].mean()
    assert exact["all persons"] == pytest.approx(planned["all persons"], abs=1e-6)
    told = small.record.results["optimise"]
    assert told["taken away"] == pytest.approx(exact["all persons"], abs=1e-6)
    assert told["planned by the aim"] == pytest.approx(told["taken away by the aim"], abs=0.01)
    assert set(rows[rows["sensors"] != "exact"]["profile"]) == {"all persons", "of the others"}
    assert exact["one factor"] == pytest.approx(told["taken away by one factor"], abs=1e-6)
    assert exact["one factor"] < exact["all persons"] - 0.05
    share = 100.0 * told["with sensors"]
    assert any(f"simulated with noisy, late sensors: {share:.1f}% removed" in line for line in small.sentences)
    assert told["with sensors"] == pytest.approx(told["taken away"], abs=0.01)


def test_a_person_without_a_trial_gets_factors_by_arm_weight(small: ShoulderOptimiseResult) -> None:
    """P9 weighs half as much as P1 at the same length of the arm, so half of P1's factors."""
    scales = small.table("scales").set_index("person")["scale [-]"]
    assert list(scales.index) == ["P1", "P2", "P9"] and scales["P1"] == 1.0
    factors = small.table("factors").set_index(["profile", "task", "hand"])
    for hand in ("dominant", "other"):
        first, ninth = (factors.loc[(f"by arm weight, {person}", "T1", hand)] for person in ("P1", "P9"))
        assert ninth.tolist() == pytest.approx((scales["P9"] * first).tolist())
    assert scales["P9"] == pytest.approx(0.5, rel=1e-3)
    assert not any(name.endswith("P9") for name in small.simulated)


def test_a_low_pass_reaches_the_torque() -> None:
    options = [ShoulderOptimiseOptions(cutoff=cutoff) for cutoff in (6.0, 2.0)]
    usual, slow = (read(each).trials[0].needed.total for each in options)
    assert np.abs(usual - slow).max() > 0.5


def test_files_are_written(small: ShoulderOptimiseResult, tmp_path: Path) -> None:
    small.write(tmp_path)
    names = {file.name for file in tmp_path.iterdir()}
    tables = {"factors.csv", "scales.csv", "outcomes.csv", "held_out.csv", "front.csv", "simulated.csv"}
    assert names >= {*tables, "profile.png", "profile.svg", "report.html"}
    assert "Leave-one-person-out validation: this person held out" in (tmp_path / "report.html").read_text(
        encoding="utf-8"
    )


PERSON = '[persons.{name}]\nmass = {{ value = {mass}, unit = "kg" }}\nsex = "{sex}"\ndominant = "{dominant}"\n'
TASK = '[tasks.{name}]\ntool = {{ value = {tool}, unit = "kg" }}\npush = {{ value = {push}, unit = "N" }}\n'
TRIAL = '[[trials]]\nperson = "{p}"\ntask = "{t}"\nmarkers = "{p}{t}.trc"\ntool = "{p}{t}.csv"\nupright = [0.0, 0.25]\n'


def test_the_profiles_that_are_written_are_read_back(small: ShoulderOptimiseResult, tmp_path: Path) -> None:
    """And lead a simulation, each hand with its own factors."""
    write_table(small.table("factors"), tmp_path, "factors")
    back = read_profiles(tmp_path / "factors.csv")
    assert list(back) == [each.name for each in small.profiles]
    for each in small.profiles:
        assert back[each.name] == pytest.approx(each.factors, abs=1e-5)
    led = simulated(profile=tmp_path / "factors.csv", profile_name="P1 alone", task="T1")
    assert led.record.results["profile"] == {"name": "P1 alone", "task": "T1"}
    for arm, hand in zip(led.arms, ("dominant", "other"), strict=True):
        (wanted,) = (v for k, v in back["P1 alone"].items() if (k.task, k.hand, k.phase) == ("T1", hand, "screw-in"))
        assert arm.factor is not None and arm.factor[arm.phase == SCREW].max() == pytest.approx(wanted)


UNSEEN = PERSON.format(name="P9", mass=41.0, sex="male", dominant="right")
UNSEEN += 'upper_arm = { value = 296, unit = "mm" }\n'


def study(folder: Path, persons: int = 2, tasks: int = 2, more: str = "") -> Path:
    """The synthetic trials without the device as files; the push is the task's for everybody."""
    text = [TASK.format(name=task.name, tool=task.tool, push=task.push) for task in TASKS[:tasks]] + [more]
    for person in PARTICIPANTS[:persons]:
        text.append(PERSON.format(name=person.name, mass=person.mass, sex=person.sex, dominant=person.dominant))
        for task in TASKS[:tasks]:
            files = trial_files(synthetic_trial(person, task, condition("S0")))
            (folder / f"{person.name}{task.name}.trc").write_text(files["markers.trc"], encoding="ascii")
            (folder / f"{person.name}{task.name}.csv").write_text(files["tool.csv"], encoding="ascii")
            text.append(TRIAL.format(p=person.name, t=task.name))
    file = folder / "study.toml"
    file.write_text("\n".join(text), encoding="utf-8")
    return file


@pytest.mark.slow
def test_a_study_from_files_is_that_of_the_arrays(small: ShoulderOptimiseResult, tmp_path: Path) -> None:
    """P1 pushes as the task says: markers to 0.01 mm through files give what the synthetic arrays need of a profile."""
    found, arrays = (
        [support_case(each, workers.support) for each in workers.trials]
        for workers in (read(ShoulderOptimiseOptions(study(tmp_path))), read(ShoulderOptimiseOptions()))
    )
    assert {case.person for case in found} == {"P1", "P2"} and len(found) == 8
    for case in found:
        if case.person == "P1":
            (same,) = (c for c in arrays if (c.person, c.task, c.hand) == (case.person, case.task, case.hand))
            inner = slice(20, -20)
            np.testing.assert_allclose(case.needed[inner], same.needed[inner], atol=0.05)
            np.testing.assert_allclose(case.full, same.full, atol=0.01)
    assert set(small.table("held_out")["person"]) == {"P1", "P2"}
    for case in small.cases:  # which the job makes a profile of
        (same,) = (c for c in found if (c.person, c.task, c.hand) == (case.person, case.task, case.hand))
        np.testing.assert_allclose(case.needed, same.needed, atol=1e-9)


@pytest.mark.slow
def test_limits_reach_the_program(small: ShoulderOptimiseResult, tmp_path: Path) -> None:
    file = study(tmp_path, 1, 1)
    limited = gc.shoulder.optimise(file, force_limit=30.0, reserve=0.3, draws=DRAWS)
    exact = limited.table("simulated").query("profile == 'all persons' and sensors == 'exact'")
    assert 28.0 < exact["force [N]"].max() < 30.1, "in the simulation, not in the plan only"
    # the rate of what follows the factors, to 0.01 N m in a sample of 10 ms
    slow = gc.shoulder.optimise(file, rate_limit=40.0, reserve=0.3, draws=DRAWS).table("outcomes")
    assert 35.0 < slow.query("profile == 'all persons'")["rate [N m/s]"].max() < 41.1
    both = gc.shoulder.optimise(file, reserve=0.3, dominant_share=0.5, draws=DRAWS)
    assert both.cases[1].needed.max() > 1.3 * small.cases[1].needed.max(), "the other hand pushes as well"


@pytest.mark.slow
@pytest.mark.parametrize(("aim", "share"), [("worst", None), pytest.param("cvar", 0.5, marks=pytest.mark.long)])
def test_best_and_one_factor_are_told_by_the_same_measure(aim: str, share: float | None, tmp_path: Path) -> None:
    """And both by the mean over persons. A worst person's share stood beside a mean: 28.9 % and 32.1 %."""
    found = gc.shoulder.optimise(study(tmp_path, 2, 1), aim=aim, worst_share=share, reserve=0.2, draws=DRAWS)
    rows = found.table("simulated").query("sensors == 'exact'")
    by_aim, by_mean = {}, {}
    for profile in ("all persons", "one factor"):
        own = rows[rows["profile"] == profile]
        persons = own.groupby("person")["taken away [-]"].mean()
        by_mean[profile] = persons.mean()
        by_aim[profile] = persons.min() if aim == "worst" else own["taken away [-]"].nsmallest(len(own) // 2).mean()
    first, second = found.sentences[:2]
    assert first.startswith(f"{by_aim['all persons']:.1%} of the shoulders' torque is removed ")
    assert first.endswith(f"one factor for all tasks, hands and phases takes {by_aim['one factor']:.1%}")
    assert second == (
        f"the mean over persons is {by_mean['all persons']:.1%}, and {by_mean['one factor']:.1%} with one factor"
    )


@pytest.mark.slow
@pytest.mark.parametrize("scales", [(0.95, 1.05), pytest.param((1.10, 1.15), marks=pytest.mark.long)])
def test_the_best_profile_is_best_in_simulate(scales: tuple[float, ...], tmp_path: Path) -> None:
    """Files in, files out: the moment from the written forces and the recorded markers, in plain numpy.

    Of the profile and of 0.95, 1.05, 1.10 and 1.15 of it: the others break the reserve of 10 % or take less away.
    """
    found = gc.shoulder.optimise(study(tmp_path, 1, 1), reserve=0.1, draws=DRAWS)
    found.write(tmp_path / "made")
    needed = {case.name.split()[1]: case.needed for case in found.cases}
    person = tmp_path / "p1.toml"
    person.write_text('upper_arm = { value = 300, unit = "mm" }\n', encoding="utf-8")
    taken, over = {}, {}
    for scale in (1.0, *scales):
        table = pd.read_csv(tmp_path / "made" / "factors.csv").query("profile == 'all persons'")
        for phase in ("lift", "screw-in", "lower"):
            table[phase] = np.minimum(scale * table[phase], 1.0)
        table.to_csv(tmp_path / "scaled.csv", index=False)
        out = tmp_path / f"at {scale}"
        gc.shoulder.simulate(
            tmp_path / "P1T1.trc",
            tool=tmp_path / "P1T1.csv",
            upright=(0.0, 0.25),
            device="lucy_new_cylinder",
            profile=tmp_path / "scaled.csv",
            person=person,
        ).write(out)
        shares, excess = [], []
        for side, need in needed.items():
            support = raised(out / "interface_forces.mot", tmp_path / "P1T1.trc", side)
            shares.append(1.0 - np.abs(need - support).mean() / np.abs(need).mean())
            excess.append((support - 0.9 * np.maximum(need, 0.0))[support > 0.05].max())
        taken[scale], over[scale] = np.mean(shares), max(excess)
    rounding = 0.03  # N m of the markers' filter, which this moment does without
    assert over[1.0] < 0.01 + rounding
    assert taken[1.0] == pytest.approx(found.record.results["optimise"]["taken away"], abs=2e-3)
    for scale in scales:
        assert taken[scale] < taken[1.0] or over[scale] > 0.05 + rounding, (scale, taken, over)


def raised(forces: Path, markers: Path, side: str) -> np.ndarray:
    """r × F about the shoulder's marker, along the axis across the trunk's down and the arm [N m]."""
    text = forces.read_text(encoding="utf-8").split("endheader\n")[1].splitlines()
    names, values = text[0].split("\t"), np.array([line.split("\t") for line in text[1:]], float)
    force, place = (
        values[:, [names.index(f"cuff_{side}_force_{kind}{axis}") for axis in "xyz"]] for kind in ("v", "p")
    )
    lines = markers.read_text(encoding="utf-8").splitlines()
    labels = [name for name in lines[3].split("\t")[2:] if name]
    rows = np.array([line.split("\t")[: 2 + 3 * len(labels)] for line in lines[5:] if line.strip()], float)[:, 2:]
    seen = {name: 1e-3 * rows[:, 3 * k : 3 * k + 3] for k, name in enumerate(labels)}
    across = seen["Lucy_Mleft"] - seen["Lucy_MC"]
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    back = seen["T10"] - seen["Lucy_MC"]
    below = back - (back * across).sum(axis=1, keepdims=True) * across
    below /= np.linalg.norm(below, axis=1, keepdims=True)
    plumb = np.array([0.0, -1.0, 0.0]) - (np.array([0.0, -1.0, 0.0]) @ across[0]) * across[0]
    plumb /= np.linalg.norm(plumb)
    lean = np.arctan2(np.cross(below[0], plumb) @ across[0], below[0] @ plumb)  # of T10 while standing upright
    down = np.cos(lean) * below + np.sin(lean) * np.cross(across, below)
    reach = place - seen[f"humerus_{side[0]}up"]
    axis = np.cross(down, reach)
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    return np.asarray((axis * np.cross(reach, force)).sum(axis=1))


def spoilt(folder: Path, old: str, new: str) -> Path:
    file = study(folder, 1)
    text = file.read_text(encoding="utf-8")
    assert old in text
    file.write_text(text.replace(old, new, 1), encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ('sex = "male"', 'sex = "m"', "[persons.P1] sex: 'm' is none; write female or male"),
        ('dominant = "right"', 'dominant = "both"', "[persons.P1] dominant: 'both' is none; write right or left"),
        ('mass = { value = 82.0, unit = "kg" }', "", "[persons.P1]: no mass; add it"),
        ("value = 82.0", "value = 820.0", "820 kg cannot be the mass of a person: that is 10 to 300 kg"),
        ('unit = "N"', 'unit = "kg"', "'kg' is not a unit of it"),
        ('person = "P1"', 'person = "P9"', "no [persons.P9]; there are P1"),
        ('task = "T1"', 'task = "T9"', "no [tasks.T9]; there are T1, T2"),
        ("upright = [0.0, 0.25]", "upright = 3", "upright: 3 is not a span"),
        ("[tasks.T1]", "[tasks.T1]\ndominant_share = 2", "[tasks.T1] dominant_share: is not at most 1"),
        (
            "[tasks.T1]",
            "[tasks.T1]\nweight = 2",
            "[tasks.T1] weight: is not known here; write tool, push, push_direction, dominant_share",
        ),
        ("[persons.P1]", "[people.P1]", "people: is not known here; write tasks, persons, trials"),
        ('markers = "P1T1.trc"', 'markers = "lost.trc"', "lost.trc"),
    ],
)
def test_a_study_that_cannot_be_read_is_refused(tmp_path: Path, old: str, new: str, what: str) -> None:
    with pytest.raises(InputError) as error:
        gc.shoulder.optimise(spoilt(tmp_path, old, new), draws=DRAWS)
    assert what in str(error.value) and "\n" not in str(error.value)


def test_one_person_is_not_held_out(tmp_path: Path) -> None:
    found = gc.shoulder.optimise(study(tmp_path, 1, 1), reserve=0.3, draws=DRAWS)
    assert found.table("held_out").empty and len(found.profiles) == 4, "all persons, one factor, the paper's, by arm"
    assert any("only one person" in line for line in found.warnings)
    found.write(tmp_path / "out")
    assert not (tmp_path / "out" / "held_out.csv").exists()


@pytest.mark.slow
def test_gaps_are_filled_up_to_a_limit(tmp_path: Path) -> None:
    """A wrist out of sight for 50 ms changes little, one for 0.4 s is refused."""
    file = study(tmp_path, 1, 1)
    trial = synthetic_trial(PARTICIPANTS[0], TASKS[0], condition("S0"))
    places = trial.markers.positions.copy()
    wrist = trial.markers.names.index("RWRI")
    exact = first_case(file)
    for frames, refused in ((5, False), (40, True)):
        places[300 : 300 + frames, wrist] = np.nan
        lost = replace(trial, markers=replace(trial.markers, positions=places))
        (tmp_path / "P1T1.trc").write_text(trial_files(lost)["markers.trc"], encoding="ascii")
        if refused:
            with pytest.raises(InputError, match=r"up to 0\.2 s is bridged; fill the gap, or give a larger"):
                gc.shoulder.optimise(file, reserve=0.3, draws=DRAWS)
        else:
            np.testing.assert_allclose(first_case(file).needed, exact.needed, atol=1.0)


def first_case(file: Path) -> SupportCase:
    """What a profile is made of, as the job takes it from a study."""
    workers = read(ShoulderOptimiseOptions(file))
    return support_case(workers.trials[0], workers.support)


@pytest.mark.parametrize(
    ("options", "what"),
    [
        ({"worst_share": 0.2}, "has no effect with `aim` mean; give `aim` cvar"),
        ({"aim": "cvar", "worst_share": 0.0}, "is not more than 0"),
        ({"reserve": 1.0}, "100 % leaves no support"),
        ({"certainty": 1.5}, "150 % is not 0 to 100 %; is 1.5 % meant?"),
        ({"dominant_share": 1.5}, "150 % is not 0 to 100 %"),
        ({"draws": 3}, "3 draws are too few for an interval; give 20 or more"),
        ({"cutoff": 0.0}, "0 leaves the noise in the accelerations"),
        ({"device": "nothing"}, "neither a file nor a built-in device"),
    ],
)
def test_what_cannot_be_asked_for_is_refused(options: dict[str, object], what: str) -> None:
    with pytest.raises(InputError) as error:
        gc.shoulder.optimise(**options)
    assert what in str(error.value)


def test_the_headline_has_what_is_left_for_persons_held_out() -> None:
    """One of two persons is pushed up, the other's gain is beyond the model's error."""
    held = pd.DataFrame(
        {
            "taken away [-]": [0.356, 0.325],
            "gain over one factor [-]": [0.13, 0.191],
            "pushed up [-]": [0.01, 0.0],
            "gain beyond the model's error": [False, True],
        }
    )
    first, second = answer({"taken away": 0.361, "taken away by one factor": 0.192}, held)
    assert first.startswith("36.1% of the shoulders' torque is taken away") and first.endswith("phases takes 19.2%.")
    assert "32.5 to 35.6 %, 13.0 to 19.1 points over one factor; 1 of 2 are pushed up" in second
    assert second.endswith("beyond the model's error for 1 of 2.")
    assert answer({"taken away": 0.361, "taken away by one factor": 0.192}, held.iloc[:0]) == [first]


def test_a_push_has_a_direction_and_may_be_measured_over_time(tmp_path: Path) -> None:
    """The torque is linear in the push: opposite directions, and a measured force that is twice the task's."""
    file = study(tmp_path, 1, 1)
    usual, text = read(ShoulderOptimiseOptions(file)).trials, file.read_text(encoding="utf-8")
    lines = text.splitlines()
    place = next(k for k, line in enumerate(lines) if line.startswith("push"))
    file.write_text(
        "\n".join([*lines[: place + 1], "push_direction = [0, -2, 0]", *lines[place + 1 :]]), encoding="utf-8"
    )
    for one, other in zip(usual, read(ShoulderOptimiseOptions(file)).trials, strict=True):
        assert one.hand == "other" or np.abs(one.needed.push).max() > 1.0
        np.testing.assert_allclose(other.needed.push, -one.needed.push, atol=1e-12)
        np.testing.assert_array_equal(other.needed.weight, one.needed.weight)
    tool = pd.read_csv(next(tmp_path.glob("P1T1.csv")), comment="#")
    running, typed = tool["current [A]"].to_numpy() > 2.5, TASKS[0].push
    columns = {"time [s]": tool["time [s]"], "fx [N]": 0.0 * running, "fy [N]": 2.0 * typed * running}
    columns["fz [N]"] = 3.0 * np.sin(tool["time [s]"])
    measured = pd.DataFrame(columns)
    measured.to_csv(tmp_path / "push.csv", index=False)
    file.write_text(text.replace("[[trials]]", '[[trials]]\npush = "push.csv"'), encoding="utf-8")
    both = read(ShoulderOptimiseOptions(file)).trials
    measured.assign(**{"fy [N]": 0.0}).to_csv(tmp_path / "push.csv", index=False)
    along_z = read(ShoulderOptimiseOptions(file)).trials
    for one, other, rest in zip(usual, both, along_z, strict=True):
        np.testing.assert_allclose(other.needed.push, 2.0 * one.needed.push + rest.needed.push, atol=1e-9)
    measured.drop(columns="fz [N]").to_csv(tmp_path / "push.csv", index=False)
    with pytest.raises(InputError, match="no column fz"):
        read(ShoulderOptimiseOptions(file))
    file.write_text(
        "\n".join([*lines[: place + 1], "push_direction = [0, 0, 0]", *lines[place + 1 :]]), encoding="utf-8"
    )
    with pytest.raises(InputError, match="is not a direction"):
        read(ShoulderOptimiseOptions(file))
