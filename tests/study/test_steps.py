"""Studies of several steps: each takes from others what belongs to it, and only what changed is evaluated again."""

from __future__ import annotations

import re
from pathlib import Path

import pandas as pd
import pytest

from tests.cli.calls import Call, call
from tests.study.chained import NUMBERS, chain, sine

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
