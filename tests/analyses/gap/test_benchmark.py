"""The benchmark called from Python: cases that are lost, broken or interrupted, and the journal."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np
import pandas as pd
import pytest

import geocontact as gc
import geocontact.gap
from benchmarks.gap.constants_of import numbers_in
from geocontact.analyses.frame.json_file import plain
from geocontact.analyses.gap.benchmark import result as gap_benchmark_result
from geocontact.analyses.gap.benchmark.case import ANSWERERS, Task, Worked, alike, failed, renamed, worked
from geocontact.analyses.gap.benchmark.outcome import BenchmarkOutcome, alarms
from geocontact.analyses.gap.benchmark.result import benchmark, mixed
from geocontact.analyses.gap.benchmark.show import constants_of_all, page_lines
from geocontact.gap_benchmark.drawing import ABROAD, KINDS, SHARES, Lot, drawn, lots, shares
from tests.house.test_gap_theory import ROWS

SEED = 20


def test_every_constant_of_the_theory_page_is_recorded() -> None:
    recorded = constants_of_all(geocontact.gap)
    ours = {
        f"{module}.{name}".removeprefix("gap."): [float(each) for each in value.split(", ")]
        for module, name, value in ROWS
        if "gap." in module
    }
    assert len(ours) > 20 and {name: numbers_in(recorded.get(name)) for name in ours} == ours


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

    monkeypatch.setattr(gap_benchmark_result, "each", until_interrupted)
    with pytest.warns(gc.InputWarning, match="interrupted after 1 of 4 cases"):
        result = benchmark(system="elbow", cases=4, kinds="none")
    assert result.outcome.kinds == {"none": 1}
    out = result.write(tmp_path / "out")
    assert json.loads((out / "benchmark.json").read_text("utf-8"))["cases"] == {"elbow": {"none": 1}}
    written = pd.read_csv(out / "cases.csv").set_index("case")["cpu [s]"]
    assert result.seconds == written.to_dict() == {"elbow_1": 1.0}


def test_an_interruption_before_the_first_case_ends_it(monkeypatch: pytest.MonkeyPatch) -> None:
    def at_once(work: object, tasks: list[Task], jobs: int | None) -> Iterator[tuple[Task, Worked]]:
        raise KeyboardInterrupt
        yield

    monkeypatch.setattr(gap_benchmark_result, "each", at_once)
    with pytest.raises(KeyboardInterrupt):
        benchmark(cases=2, kinds="none")


@pytest.mark.parametrize(("laboratory", "expected"), [("abroad", [*ABROAD, ABROAD[0]]), ("inputs", ["inputs"] * 4)])
def test_the_laboratory_that_is_asked_for_records(
    monkeypatch: pytest.MonkeyPatch, laboratory: str, expected: list[str]
) -> None:
    asked: list[Lot] = []

    def noted(work: object, tasks: list[Task], jobs: int | None) -> Iterator[tuple[Task, Worked]]:
        asked.extend(task.lot for task in tasks)
        raise KeyboardInterrupt
        yield

    monkeypatch.setattr(gap_benchmark_result, "each", noted)
    with pytest.raises(KeyboardInterrupt):
        benchmark(system="elbow", cases=4, kinds="none", laboratory=laboratory)
    assert sorted(lot.laboratory for lot in asked) == sorted(expected)


def test_a_case_whose_process_is_lost_counts_as_wrong(monkeypatch: pytest.MonkeyPatch) -> None:
    def killed(work: object, tasks: list[Task], jobs: int | None) -> Iterator[tuple[Task, BaseException]]:
        yield from ((task, RuntimeError("killed")) for task in tasks)

    monkeypatch.setattr(gap_benchmark_result, "each", killed)
    with pytest.warns(gc.InputWarning, match="was lost: RuntimeError: killed"):
        result = benchmark(system="elbow", cases=2, kinds="none", seed=SEED)
    assert result.outcome.kinds == {"none": 2} and result.table()["verdict"].tolist() == ["failed"] * 2
    assert result.record.options["seed"] == SEED and "<img src=" in result._repr_html_()
    assert str(result).startswith(f"# Gap benchmark\n\nSeed {SEED}, ")


def counted(worked_on: list[Lot]) -> Callable[..., Iterator[tuple[Task, Worked]]]:
    """In place of the work: answers that are wrong, and which cases were asked for."""

    def each(work: object, tasks: list[Task], jobs: int | None) -> Iterator[tuple[Task, Worked]]:
        for task in tasks:
            worked_on.append(task.lot)
            label = plain(drawn(task.lot).label.as_dict())
            answers = {who: failed(label) for who in ANSWERERS}
            yield task, Worked(task.lot, f"case{task.lot.place}", label, answers, 1.0, 1.0, None, ("it is made up",))

    return each


def test_claims_of_cases_that_lack_nothing_have_a_row_by_system_and_laboratory() -> None:
    label = plain(drawn(Lot("knee", "none", SEED, 0)).label.as_dict())
    sure = failed(label) | {"verdict": "unknown", "probabilities": {"unknown": 0.97, "none": 0.03}}
    quiet = failed(label) | {"verdict": "no_gap", "probabilities": {"none": 1.0}}

    def one(system: str, laboratory: str, said: dict) -> Worked:
        lot = Lot(system, "none", SEED, 0, laboratory)
        return Worked(lot, f"{system} {laboratory}", label, dict.fromkeys(ANSWERERS, said), 1.0, 1.0)

    cases = (one("knee", "recorder", sure), one("knee", "inputs", quiet), one("elbow", "inputs", quiet))
    outcome = BenchmarkOutcome(SEED, ("knee", "elbow"), cases)
    found = {
        (row.system, row.laboratory): (row.claimed.hits, row.sure.hits, row.claimed.count) for row in alarms(outcome)
    }
    assert found[("knee", "recorder")] == (1, 1, 1) and found[("knee", "inputs")] == (0, 0, 1)
    assert found[("elbow", "recorder")] == (0, 0, 0) and found[("all", "inputs")] == (0, 0, 2)
    assert found[("all", "all")] == (1, 1, 3)
    assert sum(line.startswith("| knee | recorder | 1/1") for line in page_lines(outcome, "today")) == 1


@pytest.mark.slow
def test_a_journal_goes_on_where_it_ended(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    journal, worked_on = tmp_path / "kept" / "cases.jsonl", []
    monkeypatch.setattr(gap_benchmark_result, "each", counted(worked_on))

    def run(cases: int, name: str) -> dict:
        with pytest.warns(gc.InputWarning, match="it is made up"):
            result = benchmark(system="elbow", kinds="none", cases=cases, seed=5, journal=journal)
        return json.loads((result.write(tmp_path / name) / "benchmark.json").read_text("utf-8"))

    run(2, "a")
    whole = journal.read_text("utf-8")
    journal.write_text(whole + whole.splitlines()[-1][:40], "utf-8")  # killed while it wrote
    found = run(3, "b")
    assert [lot.place for lot in worked_on] == [0, 1, 2]
    assert found["cases"] == {"elbow": {"none": 3}} and len(found["trouble"]) == 3
    assert journal.read_text("utf-8").startswith(whole) and len(journal.read_text("utf-8").splitlines()) == 4
    assert run(3, "c")["figures"] == found["figures"] and len(worked_on) == 3


def test_a_journal_of_other_sources_is_refused(tmp_path: Path) -> None:
    journal = tmp_path / "cases.jsonl"
    journal.write_text('{"sources": "0123456789ab"}\n', "utf-8")
    with pytest.raises(gc.InputError, match="was written by sources 0123456789ab, these are"):
        benchmark(cases=1, seed=5, journal=journal)
