"""`geocontact gap benchmark`: fresh or given cases, labels that nobody sees, figures that add up."""

from __future__ import annotations

import csv
import json
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.gap.benchmark import run as gap_benchmark_run
from geocontact.analyses.gap.benchmark.case import ANSWERERS, Task, Worked, alike, failed, renamed, worked
from geocontact.analyses.gap.benchmark.run import mixed
from geocontact.analyses.json_file import plain
from geocontact.gap_benchmark.drawing import KINDS, SHARES, Lot, drawn, lots, shares
from geocontact.io.cases.gap_case import read_gap_case
from tests.cli.calls import ROOT, Call, call, done, process

FILES = {"benchmark.json", "benchmark.md", "cases.csv", "reliability.png", "reliability.svg", "run.json"}
SEED = 20


@pytest.fixture(scope="session")
def ran(tmp_path_factory: pytest.TempPathFactory) -> Call:
    """Two elbow cases, absorbed and outside the table; one is diagnosed twice.

    In processes of their own, where shapes are not checked: that takes ten times as long.
    """
    out = tmp_path_factory.mktemp("benchmark") / "out"
    options = ("--system", "elbow", "--cases", 3, "--kinds", "absorbed,outside", "--again", 1, "--jobs", 2, "--keep")
    child = process("gap", "benchmark", "--out", out, "--seed", SEED, *options)
    return done(Call(child.returncode, child.stdout, child.stderr, out))


@pytest.fixture(scope="session")
def content(ran: Call) -> dict:
    """benchmark.json; NaN is no JSON."""

    def refused(word: str) -> float:
        raise AssertionError(f"{word} is not JSON")

    return json.loads((ran.folder / "benchmark.json").read_text("utf-8"), parse_constant=refused)


def rows(ran: Call) -> list[dict[str, str]]:
    with (ran.folder / "cases.csv").open(encoding="utf-8", newline="") as text:
        return list(csv.DictReader(text))


@pytest.mark.slow
def test_files_and_table(ran: Call) -> None:
    assert {p.name for p in ran.folder.iterdir()} == FILES | {f"cases-{SEED}"}
    printed = (ran.folder / "benchmark.md").read_text("utf-8")
    assert printed in ran.out and f"Seed {SEED}" in printed
    for words in ("false alarms | ≤ 5 %", "first-ranked right", "points ahead of", "seconds of one core"):
        assert words in printed


def test_figures_are_those_of_the_rows(ran: Call, content: dict) -> None:
    """Counted again from cases.csv, without the scoring code."""
    assert content["seed"] == SEED and content["cases"] == {"elbow": {"absorbed": 1, "outside": 2}}
    ours = content["figures"]["elbow"]["diagnosis"]
    hidden = [row for row in rows(ran) if row["kind"] == "absorbed"]
    recognised = [row["verdict"] == "no_gap" and row["truth"] in row["absorbed"].split() for row in hidden]
    assert (ours["absorbed_recognised"]["hits"], ours["absorbed_recognised"]["count"]) == (sum(recognised), 1)
    assert ours["false_alarms"]["count"] == 0
    strange = [row for row in rows(ran) if row["kind"] == "outside" and float(row["imitation_left [-]"]) >= 0.1]
    assert ours["unknown_called"]["hits"] == sum(row["verdict"] == "unknown" for row in strange)
    assert ours["brier"] == pytest.approx(np.mean([float(row["brier [-]"]) for row in rows(ran)]), abs=1e-9)
    assert content["cpu_seconds"]["elbow"]["most"] == pytest.approx(
        max(float(r["cpu [s]"]) for r in rows(ran)), abs=1e-3
    )
    assert content["same_in_another_dress"]["elbow"]["count"] == 1
    oracle = content["figures"]["elbow"]["oracle"]
    assert oracle["brier"] == 0.0 and oracle["absorbed_recognised"]["hits"] == 1


def test_case_folders_do_not_tell_the_answer(ran: Call) -> None:
    """Labels lie beside the folders and nothing in these, names included, tells the kind."""
    home = ran.folder / f"cases-{SEED}"
    labels = json.loads((home / "labels.json").read_text("utf-8"))
    folders = {p.name for p in home.iterdir() if p.is_dir()}
    assert set(labels) == folders == {row["case"] for row in rows(ran)}
    for name in folders:
        files = [p for p in (home / name).rglob("*") if p.is_file()]
        assert {p.name for p in files} == {"case.toml", *(f"t{i:02d}.csv" for i in range(1, len(files)))}
        text = " ".join([name, *(p.name for p in files), (home / name / "case.toml").read_text("utf-8")])
        assert not [word for word in ("absorbed", "outside", "label", "effect", "nats", "seed") if word in text]


def test_a_kept_case_is_the_planted_one(ran: Call) -> None:
    for lot in lots(("elbow",), 2, ("absorbed", "outside"), SEED):
        planted = drawn(lot).case
        kept = read_gap_case(ran.folder / f"cases-{SEED}" / planted.name)
        for one, other in zip(planted.calibration, kept.calibration, strict=True):
            np.testing.assert_allclose(one.signals.values, other.signals.values, rtol=1e-8)


def test_a_case_that_breaks_down_is_told_and_scored_as_wrong(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("geocontact.analyses.gap.benchmark.case.from_folder", lambda home: 1 / 0)
    found = worked(Task(Lot("elbow", "none", SEED, 0), tmp_path))
    assert found.answers["diagnosis"]["verdict"] == "failed" and np.isnan(found.cpu)
    assert len(found.trouble) == 1 and "ZeroDivisionError" in found.trouble[0] and found.name in found.trouble[0]
    assert not list(tmp_path.iterdir())


def test_another_dress_is_another_dress() -> None:
    case = drawn(Lot("elbow", "none", SEED, 0)).case
    other = renamed(case)
    assert not {t.name for t in case.calibration} & {t.name for t in other.calibration}
    assert other.calibration[0].signals is case.calibration[-1].signals
    said = {
        "verdict": "explained",
        "effects": ["slip"],
        "ambiguity": [],
        "absorbed": [],
        "probabilities": {"slip": 0.9},
    }
    said |= {"gap": {"force": {"reduction": 0.5}}}
    assert alike(said, said | {"probabilities": {"slip": 0.9005, "none": 0.0005}})
    assert not alike(said, said | {"probabilities": {"slip": 0.89}})
    assert not alike(said, said | {"gap": {"force": {"reduction": 0.51}}})
    assert not alike(said, said | {"effects": ["damping"]})


@pytest.mark.parametrize("cases", [1, 3, 7, 200, 201])
def test_shares_add_up(cases: int) -> None:
    assert sum(shares(cases).values()) == cases
    assert shares(200) == SHARES and SHARES["none"] >= 100
    assert sum(shares(cases, ("none", "fault")).values()) == cases


def test_lots_are_the_seeds_own() -> None:
    """A kind gets the same cases whatever else is asked for; another seed gives others."""
    few = list(lots(("foot",), 2, ("fault",), 5))
    many = list(lots(("elbow", "foot"), 200, KINDS, 5))
    assert set(few) <= set(many)
    assert len({drawn(Lot("elbow", "none", seed, 0)).case.name for seed in (5, 6)}) == 2


@pytest.mark.parametrize(
    ("options", "complaint"),
    [
        (("--kinds", "none,single_effect"), "unknown kind ['single_effect']; kinds are none, single"),
        (("--cases", 0), "0 is less than one case"),
        (("--jobs", 0), "0 is less than one process"),
        (("--again", "-1"), "-1 is less than none"),
        (("--seed", "-1"), "-1 is negative"),
        (
            ("--journal", "cases.jsonl"),
            "--seed: is missing with --journal; it would go on with other cases",
        ),
        (("--system", "hip"), "hip"),
    ],
)
def test_options_that_mean_nothing_are_refused(tmp_path: Path, options: tuple, complaint: str) -> None:
    result = call("gap", "benchmark", "--out", tmp_path / "out", *options)
    assert result.code == 2 and complaint in result.err and len(result.complaints) == 1
    assert not list(tmp_path.iterdir())


def test_help_imports_nothing_heavy() -> None:
    program = "import sys; from geocontact.cli.main import run; run(['gap', 'benchmark', '--help']);"
    program += "sys.stderr.write(' '.join({name.partition('.')[0] for name in sys.modules}))"
    child = subprocess.run([sys.executable, "-c", program], cwd=ROOT, capture_output=True, encoding="utf-8")
    assert "--kinds" in child.stdout
    assert not {"numba", "matplotlib", "pandas", "scipy"} & set(child.stderr.split())


def test_every_beginning_of_the_work_is_a_small_benchmark() -> None:
    order = mixed(list(lots(("elbow", "foot"), 100, KINDS, 3)))
    assert set(order) == set(lots(("elbow", "foot"), 100, KINDS, 3))
    half = order[: len(order) // 2]
    for kind in KINDS:
        whole = sum(lot.kind == kind for lot in order)
        assert abs(sum(lot.kind == kind for lot in half) - whole / 2) <= 1.0
    assert abs(sum(lot.system == "elbow" for lot in half) - len(half) / 2) <= 2.0


def test_what_was_done_is_scored_when_somebody_interrupts(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def until_interrupted(work: object, tasks: list[Task], jobs: int | None) -> Iterator[tuple[Task, Worked]]:
        label = plain(drawn(tasks[0].lot).label.as_dict())
        yield tasks[0], Worked(tasks[0].lot, "elbow_1", label, {who: failed(label) for who in ANSWERERS}, 1.0, 1.0)
        raise KeyboardInterrupt

    monkeypatch.setattr(gap_benchmark_run, "each", until_interrupted)
    out = tmp_path / "out"
    told = done(call("gap", "benchmark", "--out", out, "--system", "elbow", "--cases", 4, "--kinds", "none"))
    assert "interrupted after 1 of 4 cases" in told.err
    assert json.loads((out / "benchmark.json").read_text("utf-8"))["cases"] == {"elbow": {"none": 1}}


def test_an_interruption_before_the_first_case_leaves_nothing(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def at_once(work: object, tasks: list[Task], jobs: int | None) -> Iterator[tuple[Task, Worked]]:
        raise KeyboardInterrupt
        yield

    monkeypatch.setattr(gap_benchmark_run, "each", at_once)
    assert call("gap", "benchmark", "--out", tmp_path / "out", "--cases", 2, "--kinds", "none").code != 0
    assert not list(tmp_path.iterdir())


def test_a_case_whose_process_is_lost_counts_as_wrong(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def killed(work: object, tasks: list[Task], jobs: int | None) -> Iterator[tuple[Task, BaseException]]:
        yield from ((task, RuntimeError("killed")) for task in tasks)

    monkeypatch.setattr(gap_benchmark_run, "each", killed)
    out = tmp_path / "out"
    told = done(call("gap", "benchmark", "--out", out, "--system", "elbow", "--cases", 2, "--kinds", "none"))
    assert "was lost: RuntimeError: killed" in told.err
    found = json.loads((out / "benchmark.json").read_text("utf-8"))
    assert found["cases"] == {"elbow": {"none": 2}}
    rows = csv.DictReader((out / "cases.csv").read_text("utf-8").splitlines())
    assert [row["verdict"] for row in rows] == ["failed"] * 2


def counted(worked_on: list[Lot]) -> Callable[..., Iterator[tuple[Task, Worked]]]:
    """In place of the work: answers that are wrong, and which cases were asked for."""

    def each(work: object, tasks: list[Task], jobs: int | None) -> Iterator[tuple[Task, Worked]]:
        for task in tasks:
            worked_on.append(task.lot)
            label = plain(drawn(task.lot).label.as_dict())
            answers = {who: failed(label) for who in ANSWERERS}
            yield task, Worked(task.lot, f"case{task.lot.place}", label, answers, 1.0, 1.0, None, ("it is made up",))

    return each


def test_a_journal_goes_on_where_it_ended(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    journal, worked_on = tmp_path / "kept" / "cases.jsonl", []
    monkeypatch.setattr(gap_benchmark_run, "each", counted(worked_on))

    def run(cases: int, name: str) -> dict:
        options = ("--system", "elbow", "--kinds", "none", "--cases", cases, "--seed", 5, "--journal", journal)
        done(call("gap", "benchmark", "--out", tmp_path / name, *options))
        return json.loads((tmp_path / name / "benchmark.json").read_text("utf-8"))

    run(2, "a")
    whole = journal.read_text("utf-8")
    journal.write_text(whole + whole.splitlines()[-1][:40], "utf-8")  # killed while it wrote
    found = run(3, "b")
    assert [lot.place for lot in worked_on] == [0, 1, 2]
    assert found["cases"] == {"elbow": {"none": 3}} and len(found["trouble"]) == 3
    assert journal.read_text("utf-8").startswith(whole) and len(journal.read_text("utf-8").splitlines()) == 4
    assert run(3, "c")["figures"] == found["figures"] and len(worked_on) == 3


def test_a_journal_of_other_sources_is_refused(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    journal = tmp_path / "cases.jsonl"
    journal.write_text('{"sources": "0123456789ab"}\n', "utf-8")
    made = call("gap", "benchmark", "--out", tmp_path / "out", "--cases", 1, "--seed", 5, "--journal", journal)
    assert made.code == 2 and "was written by sources 0123456789ab, these are" in made.err
    assert not (tmp_path / "out").exists()
