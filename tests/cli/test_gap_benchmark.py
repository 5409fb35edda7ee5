"""`geocontact gap benchmark`: fresh or given cases, labels that nobody sees, figures that add up."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from geocontact.analyses.gap.benchmark.case import Task
from geocontact.gap_benchmark.drawing import drawn, lots
from geocontact.io.cases.gap_case import read_gap_case
from tests.cli.calls import Call, call, done, process

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


@pytest.mark.slow
def test_figures_are_those_of_the_rows(ran: Call, content: dict) -> None:
    """Counted again from cases.csv, without the scoring code."""
    assert content["seed"] == SEED and content["cases"] == {"elbow": {"absorbed": 1, "outside": 2}}
    ours = content["figures"]["elbow"]["diagnosis"]
    hidden = [row for row in rows(ran) if row["kind"] == "absorbed"]
    recognised = [row["verdict"] == "no_gap" and row["truth"] in row["absorbed"].split() for row in hidden]
    assert (ours["absorbed_recognised"]["hits"], ours["absorbed_recognised"]["count"]) == (sum(recognised), 1)
    assert ours["false_alarms"]["count"] == 0
    strange = [row for row in rows(ran) if row["kind"] == "outside" and float(row["imitation_left [-]"]) >= 0.1]
    assert ours["unknown_called"]["hits"] == sum(row["verdict"] in ("unknown", "partly_explained") for row in strange)
    assert ours["brier"] == pytest.approx(np.mean([float(row["brier [-]"]) for row in rows(ran)]), abs=1e-9)
    assert content["cpu_seconds"]["elbow"]["most"] == pytest.approx(
        max(float(r["cpu [s]"]) for r in rows(ran)), abs=1e-3
    )
    assert content["same_in_another_dress"]["elbow"]["count"] == 1
    oracle = content["figures"]["elbow"]["oracle"]
    assert oracle["brier"] == 0.0 and oracle["absorbed_recognised"]["hits"] == 1


@pytest.mark.slow
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


@pytest.mark.slow
def test_a_kept_case_is_the_planted_one(ran: Call) -> None:
    for lot in lots(("elbow",), 2, ("absorbed", "outside"), SEED):
        planted = drawn(lot).case
        kept = read_gap_case(ran.folder / f"cases-{SEED}" / planted.name)
        for one, other in zip(planted.calibration, kept.calibration, strict=True):
            np.testing.assert_allclose(one.signals.values, other.signals.values, rtol=1e-8)


def test_cases_that_are_lost_are_told_and_written(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    def killed(work: object, tasks: list[Task], jobs: int | None) -> Iterator[tuple[Task, BaseException]]:
        yield from ((task, RuntimeError("killed")) for task in tasks)

    monkeypatch.setattr("geocontact.analyses.gap.benchmark.result.each", killed)
    out = tmp_path / "out"
    words = ("--system", "elbow", "--cases", 2, "--kinds", "none")
    told = done(call("gap", "benchmark", "--out", out, *words, folder=out))
    assert "was lost: RuntimeError: killed" in told.err
    assert {p.name for p in out.iterdir()} == FILES
    assert (out / "benchmark.md").read_text("utf-8") in told.out
    record = told.record()
    assert record["options"]["seed"] == record["results"]["seed"] and record["results"]["cases"] == {"none": 2}


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
