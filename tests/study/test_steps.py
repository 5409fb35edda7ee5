"""Studies of several steps: each takes from others what belongs to it, and only what changed is evaluated again."""

from __future__ import annotations

import json
import re
import shutil
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from geocontact.data.errors import InputError
from geocontact.study.description import read_study_file
from geocontact.study.plan import Evaluation, StudyPlan
from geocontact.study.steps import runs_of
from geocontact.study.trial_run import TrialTask
from tests.cli.calls import Call, call
from tests.study.chained import NUMBERS, OWN, chain, sine

STEPS = {"offset": 2, "sum": 4, "sine": 4, "all": 1, "tests_study_chained_add": 2}
"""Evaluations of each step."""


def cohort(file: Path, out: Path, scheduler: str, *more: str) -> Call:
    return call("cohort", file, "--run-simulator", "--scheduler", scheduler, "--out", out, *more, folder=out)


def states(out: Path) -> pd.DataFrame:
    return pd.read_csv(out / "trials.csv", keep_default_na=False).set_index(["step", "name"])


def new(done: Call) -> list[int]:
    """How many evaluations are new, by step."""
    return [int(each) for each in re.findall(r"(\d+) of them new", done.out)]


def test_steps_take_from_each_other_by_trial_by_subject_and_over_all(tmp_path: Path, scheduler: str) -> None:
    """Every number is that of the same sums done here."""
    file, out = chain(tmp_path, NUMBERS), tmp_path / "out"
    done = cohort(file, out, scheduler)
    assert done.code == 0, done.err
    found = states(out)
    assert {step: len(rows) for step, rows in found.groupby("step")} == STEPS and set(found["state"]) == {"done"}
    sums = {"A 1": 11.0, "A 2": 21.0, "B 1": 32.0, "B 2": 42.0}
    table = pd.read_parquet(out / "tables" / "sum" / "total.parquet").set_index("name")["total [N]"]
    assert table.to_dict() == sums
    (total,) = pd.read_parquet(out / "tables" / "all" / "total.parquet")["total [N]"]
    assert total == sum(sums.values())
    own = pd.read_parquet(out / "tables" / "tests_study_chained_add" / "total.parquet").set_index("subject")
    for subject in "AB":
        wanted = sum(sine(value) for name, value in sums.items() if name.startswith(subject))
        assert own["total [N]"][subject] == pytest.approx(wanted, rel=1e-9)
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "Steps of the study" in page and sorted(new(done)) == sorted(STEPS.values())
    again = cohort(file, out, scheduler)
    assert set(new(again)) == {0} and again.code == 0


def test_only_the_chain_of_what_changed_is_evaluated_again(tmp_path: Path, scheduler: str) -> None:
    """A file at rest of B: its offset, two sums, two sines and its total, and the sum over all; nothing of A."""
    file, out = chain(tmp_path, NUMBERS), tmp_path / "out"
    before = cohort(file, out, scheduler)
    assert before.code == 0, before.err
    first = states(out)["folder"]
    (tmp_path / "B_still.txt").write_text("5", encoding="utf-8")
    changed = cohort(file, out, scheduler)
    assert changed.code == 0, changed.err
    same = states(out)["folder"] == first
    assert {name for _, name in same[~same].index} == {"B", "B 1", "B 2", "all"} and int((~same).sum()) == 7
    assert sum(new(changed)) == 7


def test_equal_files_lead_to_the_same_results_however_they_came_about(tmp_path: Path, scheduler: str) -> None:
    """Another factor rounds to the same totals: the step is new, and none that takes from it."""
    file, out = chain(tmp_path, NUMBERS), tmp_path / "out"
    cohort(file, out, scheduler)
    first = states(out)["folder"]
    file.write_text(OWN.replace('{ files = "{file}" }', '{ files = "{file}", times = 1.1 }'), encoding="utf-8")
    again = cohort(file, out, scheduler)
    assert again.code == 0 and sum(new(again)) == 2
    same = states(out)["folder"] == first
    assert [step for step, _ in same[~same].index] == ["offset", "offset"]
    cleaned = cohort(file, out, scheduler, "--clean-up")
    assert "removed what no description asks for: 2 results" in cleaned.out
    still = cohort(file, out, scheduler)
    assert sum(new(still)) == 0, "results whose source was removed are still those of equal files"


def test_a_study_and_results_that_were_moved_apart_are_all_there(tmp_path: Path, scheduler: str) -> None:
    """Earlier results have other paths from the study then: they count by content."""
    old, moved, out = tmp_path / "old", tmp_path / "moved", tmp_path / "elsewhere" / "results_of_it"
    old.mkdir()
    out.parent.mkdir()
    cohort(chain(old, NUMBERS), old / "out", scheduler)
    shutil.move(old / "out", out)
    shutil.move(old, moved)
    assert set(new(cohort(moved / "study.toml", out, scheduler))) == {0}


def test_a_dry_run_says_what_a_run_would_evaluate_and_writes_nothing(tmp_path: Path, scheduler: str) -> None:
    file, out = chain(tmp_path, NUMBERS), tmp_path / "out"
    planned = cohort(file, out, scheduler, "--dry-run")
    assert planned.code == 0 and not out.exists()
    assert "offset (tests.study.chained:add): 0 of 2 evaluations there; 2 to evaluate" in planned.out
    assert ", after sum: 0 of 4 evaluations there; 4 to evaluate" in planned.out
    cohort(file, out, scheduler)
    kept = {each: each.read_bytes() for each in out.rglob("*") if each.is_file()}
    (tmp_path / "A_1.txt").write_text("11", encoding="utf-8")
    planned = cohort(file, out, scheduler, "--dry-run")
    assert {each: each.read_bytes() for each in out.rglob("*") if each.is_file()} == kept
    assert "after offset: 3 of 4 evaluations there; 1 to evaluate, about " in planned.out
    assert "all of it: about " in planned.out and "no description asks for" not in planned.out
    cohort(file, out, scheduler)
    assert "no description asks for 4 results" in cohort(file, out, scheduler, "--dry-run").out


def test_only_from_and_forget_choose_what_is_evaluated(tmp_path: Path, scheduler: str) -> None:
    file, out = chain(tmp_path, NUMBERS), tmp_path / "out"
    part = cohort(file, out, scheduler, "--only", "subject=A")
    assert part.code == 0, part.err
    found = states(out)["state"]
    assert set(found[[name.startswith("A") for _, name in found.index]]) == {"done"}
    assert set(found[[not name.startswith("A") for _, name in found.index]]) == {"not asked for"}
    whole = cohort(file, out, scheduler)
    assert sum(new(whole)) == sum(STEPS.values()) - 6
    times = {each: (out / each / "run.json").stat().st_mtime_ns for each in states(out)["folder"]}

    def written_again(*more: str) -> list[str]:
        assert cohort(file, out, scheduler, *more).code == 0
        rows = states(out)["folder"]
        found = [
            step for (step, _), each in rows.items() if (out / each / "run.json").stat().st_mtime_ns != times[each]
        ]
        times.update({each: (out / each / "run.json").stat().st_mtime_ns for each in rows})
        return found

    assert written_again("--forget", "sum") == ["sum"] * 4, "its files came out the same"
    assert written_again("--from", "sine") == ["sine"] * 4 + ["tests_study_chained_add"] * 2
    refused = cohort(file, out, scheduler, "--from", "sun")
    assert refused.code == 2 and "--from: no step is 'sun'; there are offset, sum, sine, all" in refused.err
    refused = cohort(file, out, scheduler, "--only", "person=A")
    assert refused.code == 2 and "--only: no trial has 'person'; names are subject, trial" in refused.err
    for chosen, said in (
        (["subject=Z"], "--only: no trial has subject 'Z'; values are A, B"),
        (["subject=A", "subject=B"], "--only: subject is given twice; give one value of each name"),
    ):
        refused = cohort(file, out, scheduler, *(word for each in chosen for word in ("--only", each)))
        assert refused.code == 2 and said in refused.err
    (tmp_path / "A_2.txt").unlink()
    refused = cohort(file, out, scheduler, "--only", "subject=A", "--only", "trial=2")
    assert refused.code == 2 and "--only: no trial has subject=A and trial=2; leave one of them out" in refused.err


def test_what_is_not_asked_for_stays_in_a_step_that_is_evaluated_anew(tmp_path: Path, scheduler: str) -> None:
    """Of B nothing is evaluated, and its numbers stay in the tables; sums that two trials share are evaluated."""
    file, out = chain(tmp_path, NUMBERS), tmp_path / "out"
    text = OWN.replace('file = "{sum:total.txt}"', 'file = "{sum:total.txt}", gain = "{gain}"')
    file.write_text(f"{text}[vary]\ngain = [1, 3]\n", encoding="utf-8")
    assert cohort(file, out, scheduler).code == 0
    table = (out / "tables" / "sum" / "total.parquet").read_bytes()
    for chosen, count in (
        (("--from", "sum", "--only", "subject=A"), [0, 2, 4, 1, 1]),
        (("--forget", "sum", "--only", "subject=A"), [0, 2, 0, 0, 0]),
        (("--forget", "sum", "--only", "gain=3"), [0, 4, 0, 0, 0]),
        (("--forget", "sum", "--only", "gain=1"), [0, 4, 0, 0, 0]),
    ):
        again = cohort(file, out, scheduler, *chosen)
        assert again.code == 0 and new(again) == count, (chosen, new(again))
        assert (
            set(states(out)["state"]) == {"done"} and (out / "tables" / "sum" / "total.parquet").read_bytes() == table
        )
    (tmp_path / "A_1.txt").write_text("11", encoding="utf-8")
    left = cohort(file, out, scheduler, "--forget", "sum", "--only", "subject=B")
    assert left.code == 0 and states(out)["state"]["sum"].value_counts().to_dict() == {"done": 6, "not asked for": 2}


def test_what_takes_from_a_failed_evaluation_is_not_evaluated(tmp_path: Path, scheduler: str) -> None:
    file, out = chain(tmp_path, {**NUMBERS, "B_1": "wrong"}), tmp_path / "out"
    done = cohort(file, out, scheduler)
    assert done.code == 2 and len([line for line in done.complaints if "is wrong" in line]) == 1
    found = states(out)
    assert found["state"]["sum", "B 1"] == "input error" and found["state"]["sine", "B 1"] == "without input"
    assert found["words"]["sine", "B 1"] == "needs sum of B 1"
    assert found["state"]["tests_study_chained_add", "B"] == found["state"]["all", "all"] == "without input"
    assert set(found["state"].drop("B 1", level="name").drop(["B", "all"], level="name")) == {"done"}
    (tmp_path / "B_1.txt").write_text("30", encoding="utf-8")
    (tmp_path / "A_2.txt").write_text("21", encoding="utf-8")
    mended = cohort(file, out, scheduler, "--redo-failed")
    assert mended.code == 0, mended.err
    found = states(out)["state"]
    assert found["tests_study_chained_add", "B"] == "done" and found["sum", "A 2"] == "not asked for"


def test_an_earlier_result_that_is_lost_meanwhile_is_no_mistake_of_the_input(
    tmp_path: Path, scheduler: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Lost before its path is looked for, or when a worker has it: code 1, and the next run makes it anew."""
    gives, settles = StudyPlan.__next__, StudyPlan._task

    def lose(plan: StudyPlan, folder: str) -> None:
        if not lost:
            lost.append(folder)
            (plan.study.home / folder / "total.txt").unlink()

    def given(plan: StudyPlan) -> TrialTask:
        task = gives(plan)
        if task.step == "sine":
            lose(plan, task.taken[0])
        return task

    def settled(plan: StudyPlan, one: Evaluation) -> Any:
        if one.run.step == "sine":
            lose(plan, plan._folder(one.run.takes["sum"][0]))
        return settles(plan, one)

    for name, changed in (("__next__", given), ("_task", settled)):
        file, out, lost = chain(tmp_path, NUMBERS), tmp_path / name, list[str]()
        with monkeypatch.context() as patch:
            patch.setattr(StudyPlan, name, changed)
            done = cohort(file, out, scheduler)
        words = states(out)["words"]
        odd = [words[each] for each in words.index if "were changed meanwhile; run it again" in words[each]]
        assert done.code == 1 and odd and all(each.startswith("results of sum of ") for each in odd), done.err
        assert "sine" in {step for step, name in words.index if words[step, name] in odd}
        again = cohort(file, out, scheduler)
        assert again.code == 0 and set(states(out)["state"]) == {"done"}, again.err


def test_a_link_that_nobody_gave_is_left_out_and_named_before_anything_runs(tmp_path: Path, scheduler: str) -> None:
    """With all that takes from it, also from steps that are to be evaluated; nothing of it once the file is there."""
    file, out = chain(tmp_path, NUMBERS), tmp_path / "out"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("[steps.sine]\n", '[steps.sine]\nneeds = ["{subject}_given.dat"]\n'), encoding="utf-8")
    (tmp_path / "A_given.dat").write_text("", encoding="utf-8")
    planned = cohort(file, out, scheduler, "--dry-run")
    assert planned.code == 0 and "sine of B 1: needs B_given.dat, which is not there" in planned.err
    assert "tests_study_chained_add of B: needs sine of B 1" in planned.err
    assert ", after sum: 0 of 4 evaluations there; 2 to evaluate; 2 left out of this run" in planned.out
    done = cohort(file, out, scheduler)
    assert done.code == 0 and "sine of B 1 … 2 is left out: needs B_given.dat, which is not there" in done.err
    found = states(out)["state"]
    assert found["sine", "A 1"] == found["all", "all"] == found["tests_study_chained_add", "A"] == "done"
    assert found["sine", "B 1"] == found["tests_study_chained_add", "B"] == "without input"
    (tmp_path / "B_given.dat").write_text("", encoding="utf-8")
    done = cohort(file, out, scheduler)
    assert set(states(out)["state"]) == {"done"} and "left out" not in done.err
    assert new(done) == [0, 0, 2, 0, 1]


def test_what_is_over_several_runs_on_those_that_are_there(tmp_path: Path, scheduler: str) -> None:
    """Without the trial whose file nobody gave, in sums over trials of a step and in those over all; all is named."""
    file, out = chain(tmp_path, NUMBERS), tmp_path / "out"
    text = file.read_text(encoding="utf-8")
    need = '[steps.sum]\nneeds = ["given_{subject}_{trial}.dat"]\n'
    file.write_text(text.replace("[steps.sum]\n", need), encoding="utf-8")
    for name in ("A_1", "A_2", "B_2"):
        (tmp_path / f"given_{name}.dat").write_text("", encoding="utf-8")
    planned = cohort(file, out, scheduler, "--dry-run")
    assert planned.code == 0 and "all of all: without sum of B 1" in planned.err
    done = cohort(file, out, scheduler)
    assert done.code == 0, done.err
    assert "all of all is evaluated without sum of B 1" in done.err
    assert "tests_study_chained_add of B is evaluated without sine of B 1" in done.err
    found = states(out)
    assert found["state"]["all", "all"] == found["state"]["tests_study_chained_add", "B"] == "done"
    assert found["state"]["sum", "B 1"] == found["state"]["sine", "B 1"] == "without input"
    total = (out / found["folder"]["all", "all"] / "total.txt").read_text(encoding="utf-8")
    assert float(total) == (10 + 1) + (20 + 1) + (40 + 2)
    (tmp_path / "given_B_1.dat").write_text("", encoding="utf-8")
    done = cohort(file, out, scheduler)
    assert "without" not in done.err and new(done) == [0, 1, 1, 1, 1]


def test_what_is_missing_is_named_where_nothing_can_be_evaluated(tmp_path: Path, scheduler: str) -> None:
    file, out = chain(tmp_path, NUMBERS), tmp_path / "out"
    text = file.read_text(encoding="utf-8")
    file.write_text(text.replace("[steps.offset]\n", '[steps.offset]\nneeds = ["{subject}_gvien.dat"]\n'))
    done = cohort(file, out, scheduler)
    assert done.code == 2 and "none of the" in done.err
    assert "offset of A is left out: needs A_gvien.dat, which is not there" in done.err


def test_what_failed_is_redone_after_a_run_that_left_it(tmp_path: Path, scheduler: str) -> None:
    file, out = chain(tmp_path, {**NUMBERS, "A_1": "wrong", "B_1": "wrong"}), tmp_path / "out"
    assert cohort(file, out, scheduler).code == 2
    assert cohort(file, out, scheduler, "--only", "subject=A", "--only", "trial=2").code == 0
    found = states(out)
    assert found["state"]["sum", "A 1"] == found["state"]["sum", "B 1"] == "input error"
    assert "B_1.txt: is wrong" in found["words"]["sum", "B 1"]
    for name in ("A_1", "B_1"):
        (tmp_path / f"{name}.txt").write_text("30", encoding="utf-8")
    redone = cohort(file, out, scheduler, "--redo-failed")
    assert redone.code == 0 and set(states(out)["state"]) == {"done"}, redone.err
    (out / "trials.csv").write_text("odd\n1\n", encoding="utf-8")
    assert cohort(file, out, scheduler).code == 0, "no table of a run before it is no hindrance"


def test_files_of_steps_are_found_in_values_and_swept_options(tmp_path: Path, scheduler: str) -> None:
    """The total of a subject's offset is summed, however its name comes into the options."""
    numbers = {"A_still": "1", "A_1": "10"}
    begins = 'analysis = "tests.study.chained:add"\nfiles = "{subject}_{trial}.txt"\nwhere = { trial = ["1"] }\n'
    step = '[steps.offset]\nanalysis = "tests.study.chained:add"\nper = ["subject"]\nwhere = { trial = ["still"] }\n'
    step += 'options = { files = ["{file}"] }\n'
    file = chain(tmp_path, numbers)
    for k, more in enumerate(
        (
            '[sweep]\nfiles = ["{offset:total.txt}"]\n',
            '[options]\nfiles = ["{what}"]\n[vary]\nwhat = ["{offset:total.txt}"]\n',
            '[options]\nfiles = ["{{which}:total.txt}"]\n[vary]\nwhich = ["offset"]\n',
        )
    ):
        file.write_text(f"{begins}{more}{step}", encoding="utf-8")
        done = cohort(file, tmp_path / f"out{k}", scheduler)
        assert done.code == 0, done.err
        (total,) = pd.read_parquet(next(tmp_path.glob(f"out{k}/tables/tests_*/total.parquet")))["total [N]"]
        assert total == 1.0
        file.write_text(f"{begins}{more}{step}".replace("{offset:", "{ofset:").replace('"offset"', '"ofset"'), "utf-8")
        with pytest.raises(InputError, match="there is no step 'ofset' before it; steps are offset"):
            runs_of(read_study_file(file))


def test_lines_name_the_step(tmp_path: Path, scheduler: str) -> None:
    file, out = chain(tmp_path, {"A_still": "1", "A_1": "10", "B_still": "1", "B_1": "10 warns"}), tmp_path / "out"
    text = OWN.replace('file = "{sum:total.txt}"', 'file = "{file}"').replace("{sum:total.txt}", "{offset:total.txt}")
    file.write_text(text, encoding="utf-8")
    done = cohort(file, out, scheduler)
    assert done.code == 0, done.err
    for step in ("2 of 2 trials of offset", "2 of 2 trials of sine", "2 of 2 trials of tests.study.chained:add"):
        assert f"{step} have results" in done.out
    assert "sine of B 1: rms 10 mm, 20 mm at most" in done.warnings


def test_pages_and_figures_can_be_left_out(tmp_path: Path, scheduler: str) -> None:
    numbers = {"A_still": "1", "A_1": "10", "A_2": "20"}
    file, out = chain(tmp_path, numbers), tmp_path / "out"

    def endings() -> set[str]:
        return {each.suffix for folder in states(out).loc["sum"]["folder"] for each in (out / folder).iterdir()}

    def linked() -> list[str]:
        return re.findall(r'href="(results/[^"]+)"', (out / "report.html").read_text(encoding="utf-8"))

    assert cohort(file, out, scheduler).code == 0 and ".html" in endings()
    assert len(linked()) == 7 and all((out / each).is_file() for each in linked())
    chain(tmp_path, numbers, "pages = false\nfigures = false\n")
    bare = cohort(file, out, scheduler)
    assert bare.code == 0 and sum(new(bare)) == 7 and ".html" not in endings()
    assert {".csv", ".parquet", ".txt", ".json"} == endings()
    assert len(linked()) == 2 and all((out / each).is_file() for each in linked()), "two write theirs by themselves"


@pytest.mark.parametrize(
    ("old", "text", "said"),
    [
        (
            "{offset:",
            "{ofset:",
            "[steps.sum.options] files: there is no step 'ofset' before it; steps are offset, sine",
        ),
        ('{ files = "{file}" }', '{ files = "{sine:sine.csv}" }', "go in a circle; take from earlier steps only"),
        ('per = ["subject"]\n\n', 'per = ["person"]\n\n', "per: no trial has 'person'; names are subject, trial"),
        ('trial = ["still"]', 'trial = ["rest"]', "[steps.offset] where: no trial has these values"),
        ('trial = ["still"]', 'trail = ["rest"]', "[steps.offset] where: no trial has 'trail'"),
        (
            '{ file = "{sum:total.txt}" }',
            '{ file = "{file}" }\nper = []',
            '[steps.sine.options] file: {file} stands for 4 values; write it in a list, ["{file}"], or choose trials',
        ),
        (
            "[steps.sum]\n",
            '[steps.sum]\nneeds = ["{sujet}.dat"]\n',
            "[steps.sum] needs: no trial has {sujet}; names are",
        ),
        (
            "[steps.sum]\n",
            '[steps.sum]\nneeds = ["{offset:total.txt}"]\n',
            "[steps.sum] needs: {offset:total.txt} is ma",
        ),
        ('per = ["subject"]\n\n', 'per = ["subject"]\nneeds = ["{sujet}.dat"]\n\n', "study.toml needs: no trial has"),
        ("[steps.all]", "[steps.tests_study_chained_add]", "has the name of the study's own analysis"),
        ("[steps.all]", '[steps."../all"]', "'../all' cannot be that of a file"),
        ('trial = ["still"]', 'subject = ["A"], trial = ["still"]', "offset is not evaluated for B 1; see its `where`"),
    ],
)
def test_a_description_of_steps_that_cannot_be_is_one_line(tmp_path: Path, old: str, text: str, said: str) -> None:
    file = chain(tmp_path, NUMBERS)
    assert old in OWN
    file.write_text(OWN.replace(old, text), encoding="utf-8")
    with pytest.raises(InputError) as refused:
        runs_of(read_study_file(file))
    assert said in str(refused.value) and str(refused.value).startswith(str(file))


def test_files_of_several_evaluations_need_a_list_and_stay_in_their_folder(tmp_path: Path, scheduler: str) -> None:
    for name, said in (
        ('files = "{sine:sine.csv}"', "files: {sine:…} stands for 2 files in A; write it in a list"),
        ('files = ["{sine:../trials.csv}"]', "files: '../trials.csv' leads out of the results of the step"),
        ('files = ["{sine:cosine.csv}"]', "there is no such file"),
    ):
        file = chain(tmp_path, NUMBERS)
        file.write_text(OWN.replace('files = ["{sine:sine.csv}"]', name), encoding="utf-8")
        done = cohort(file, tmp_path / "out", scheduler)
        assert done.code == 2 and said in done.err, done.err


def test_a_step_that_two_trials_share_is_evaluated_once(tmp_path: Path, scheduler: str) -> None:
    """The sum does not depend on the gain, the sine does."""
    file, out = chain(tmp_path, NUMBERS), tmp_path / "out"
    text = OWN.replace('file = "{sum:total.txt}"', 'file = "{sum:total.txt}", gain = "{gain}"')
    file.write_text(f"{text}[vary]\ngain = [1, 3]\n", encoding="utf-8")
    done = cohort(file, out, scheduler)
    assert done.code == 0, done.err
    rows = states(out)["folder"]
    assert len(rows["sum"]) == 8 and rows["sum"].nunique() == 4 and rows["sine"].nunique() == 8
    own = pd.read_parquet(out / "tables" / "tests_study_chained_add" / "total.parquet").set_index("subject")
    assert own["total [N]"]["A"] == pytest.approx(4.0 * (sine(11.0) + sine(21.0)), rel=1e-9)
    told = json.loads((out / rows["sine"].iloc[0] / "trial.json").read_text(encoding="utf-8"))
    assert told["from"] == [f"out/{rows['sum'].iloc[0]}"]
