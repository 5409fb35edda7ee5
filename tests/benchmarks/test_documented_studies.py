"""Figures of chained studies on the pages are those of the results, and what these must show."""

from __future__ import annotations

import re

import pytest

from benchmarks.robustness.chain_faults import FAULTS, only
from benchmarks.study.kills import OF_KILLS
from benchmarks.study.leg_chain import STEPS
from tests.benchmarks.test_documented_figures import ROOT, near, results, row

PAGE = "reference/large_study.md"


def text(page: str) -> str:
    """The page in one line."""
    return " ".join((ROOT / "docs" / page).read_text(encoding="utf-8").split())


def test_a_chained_study_evaluates_what_changed_and_costs_little() -> None:
    told = results("cohort_chain")
    figures, subjects = told["figures"], told["asked"]["subjects"]
    runs = {"from nothing": "from_nothing", "again": "again", "one file changed": "one_file_changed"}
    measured = [(label, stage, count) for (label, stage), count in zip(runs.items(), (subjects, 0, 1), strict=True)]
    assert {*runs.values()} >= {*figures} - {"alone", "overhead"} >= {"from_nothing"}
    for label, stage, count in (each for each in measured if each[1] in figures):
        one = figures[stage]
        assert one["new"] == dict.fromkeys(STEPS, count)
        evaluated, cpu = row(PAGE, label)
        assert int(evaluated) == len(STEPS) * count and near(cpu, one["cpu_seconds"])
    first, alone = figures["from_nothing"], [figures["alone"][step]["cpu_ms"] for step in STEPS]
    beside = 1e3 * first["cpu_seconds"] / (len(STEPS) * subjects) - sum(alone) / len(STEPS)
    assert abs(beside - figures["overhead"]["cpu_ms"]) < 0.1 and 0.0 < beside < 300.0
    found = re.search(r"alone takes (\d+) CPU ms, the study adds (\d+)", text(PAGE))
    assert found and near(found[1], sum(alone) / len(STEPS)) and near(found[2], beside)
    assert f"Three steps of {subjects} subjects" in text(PAGE)


def test_snakemake_beside_a_study() -> None:
    """The same numbers; what each evaluates again, in the order of the table's columns."""
    told = results("cohort_snakemake")
    figures, subjects = told["figures"], told["asked"]["subjects"]
    assert figures["same"] and figures["again"]["nothing"] == {"cohort": only(), "snakemake": only()}
    changes = [
        "one subject's file",
        "time of one subject's file",
        "an option of the last step",
        "a module of the last step",
        "a digit of a kept file",
    ]
    changes = [change for change in changes if change in figures["again"]]
    assert len(changes) >= 3
    for tool, label, file in (
        ("cohort", "`cohort`", "study.toml"),
        ("snakemake", f"Snakemake {told['asked']['snakemake']}", "Snakefile"),
    ):
        counts = [sum(figures["again"][change][tool].values()) for change in changes]
        cells = [str(each) for each in (*counts, figures["lines"][file])]
        if tool == "cohort" and changes[-1] == "a digit of a kept file":  # a dry run counts what may follow
            real = results("chain_faults")["figures"]["a bit of an earlier step's file differs"]
            assert 0 < sum(real["evaluated_in_the_last_run"].values()) < counts[-1]
            cells[-2] = f"≤ {counts[-1]}"
        assert row(PAGE, label) == cells
    ours, theirs = (figures[tool]["cpu_seconds"] for tool in ("cohort", "snakemake"))
    overhead = figures["overhead_of_a_job_cpu_seconds"]
    assert overhead == pytest.approx(theirs / 6 - figures["commands_typed_cpu_seconds"] / 3) and subjects == 2
    said = f"took {ours:.1f} CPU s, Snakemake {theirs:.1f}, of which a job's overhead is {overhead:.2f}"
    assert said in " ".join(text(PAGE).split())
    ours = {change: figures["again"][change]["cohort"] for change in changes}
    last = {"an option of the last step", "a module of the last step"}
    assert all(ours[change] == only(id=subjects) for change in last & {*ours})
    assert ours["one subject's file"] == dict.fromkeys(STEPS, 1) and ours["time of one subject's file"] == only()


def test_kills_and_faults_of_chained_studies() -> None:
    """Kills of several seeds together; what runs of a killed worker ended with is of kills, or 0, but for one run."""
    page, faults = text("reference/durability.md"), results("chain_faults")
    runs = [results(f"cohort_kills_chain_{seed}")["figures"] for seed in (58, 59, 60)]
    for kills in runs:
        assert kills["with_other_tables"] == kills["processes_left_running"] == 0
        assert kills["kills_with_some_results"] > 0
    codes = [code for kills in runs for code, count in kills["exit_codes_of_killed"].items() for _ in range(count)]
    assert [code for code in codes if int(code) not in (*OF_KILLS, 0)] == ["2"]
    assert "one run ended by itself with code 2" in page and not any(kills["ended_with_an_error"] for kills in runs[1:])
    assert f"{sum(sum(kills['kills'].values()) for kills in runs)} kills" in page
    assert f"{sum(kills['runs_to_the_end'] for kills in runs)} runs" in page
    assert len(faults["figures"]) >= 12 and {*faults["figures"]} == {*FAULTS}
    for name, one in faults["figures"].items():
        assert one["right"], name
        assert FAULTS[name].new is None or one["evaluated_in_the_last_run"] == FAULTS[name].new, name
    assert f"{len(FAULTS)} faults" in page
