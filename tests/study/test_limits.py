"""A trial that takes more than it may is ended, tried once more with twice that, and set aside; its log says where."""

from __future__ import annotations

import os
import subprocess
import sys
import textwrap
from dataclasses import replace
from operator import length_hint
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import psutil
import pytest

from geocontact.analyses.catalogue import job_named
from geocontact.data.errors import InputError
from geocontact.study import trial_run, workers
from geocontact.study.description import read_study_file
from geocontact.study.limits import TrialLimits, bytes_of, ended, is_size, size_text, widest
from geocontact.study.options import CohortOptions
from geocontact.study.plan import StudyPlan, jobs_of, limits_of
from geocontact.study.steps import runs_of
from geocontact.study.store import WORK, Store
from geocontact.study.trial_run import DONE, SET_ASIDE, TrialTask, run_trial
from geocontact.study.workers import _fitting
from tests.cli.calls import ROOT, call
from tests.study.chained import NUMBERS, chain
from tests.study.quick import study


def ends(folder: Path, limits: str, body: str) -> tuple[int, str]:
    """Exit code of a process that is kept within limits, and what its log says, "" where there is none."""
    log = folder / "a.log"
    program = f"""
        import ctypes, time
        from pathlib import Path
        import numpy as np
        from geocontact.study.limits import TrialLimits, kept_within
        def deep():
            {body}
        with kept_within(TrialLimits({limits}), Path({str(log)!r})):
            deep()
    """
    command = [sys.executable, "-c", textwrap.dedent(program)]
    done = subprocess.run(command, cwd=ROOT, env=os.environ | {"PYTHONPATH": str(ROOT)}, timeout=120)
    return done.returncode, log.read_text(encoding="utf-8") if log.exists() else ""


HUNGRY = "taken = [(np.ones(5_000_000), time.sleep(0.02)) for _ in range(60)]"  # 40 MB each, 2.4 GB after 1.2 s


@pytest.mark.parametrize(
    ("limits", "body", "word"),
    [
        ("time=0.5", "time.sleep(60)", "Timeout ("),
        ("time=0.5", "ctypes.PyDLL(None).sleep(60)", "Timeout ("),  # compiled code that keeps the interpreter
        ("memory=400_000_000", HUNGRY, "Memory ("),
    ],
)
def test_what_takes_more_is_ended_and_the_log_says_where(tmp_path: Path, limits: str, body: str, word: str) -> None:
    code, log = ends(tmp_path, limits, body)
    assert code == 1 and log.startswith(word) and "in deep" in log
    assert ended(tmp_path / "a.log") == ((1, 0) if word == "Timeout (" else (0, 1))


def test_what_a_trial_started_ends_with_it_at_its_time(tmp_path: Path) -> None:
    body = f"open({str(tmp_path / 'pid')!r}, 'w').write(str(subprocess.Popen(['sleep', '60']).pid)); time.sleep(60)"
    code, log = ends(tmp_path, "time=2.0", f"import subprocess; {body}")
    assert code == 1 and log.startswith("Timeout (0:00:02)!") and ended(tmp_path / "a.log") == (1, 0)
    started = int((tmp_path / "pid").read_text(encoding="utf-8"))
    assert not psutil.pid_exists(started) or psutil.Process(started).status() == psutil.STATUS_ZOMBIE


def test_what_stays_within_its_limits_leaves_no_log(tmp_path: Path) -> None:
    assert ends(tmp_path, "time=60.0, memory=4_000_000_000", "np.ones(5_000_000)") == (0, "")


def test_the_second_try_may_take_twice_as_much(tmp_path: Path) -> None:
    """1 s and 0.4 GB are too much the first time, and not the second."""
    for limits, body in (
        ("time=0.7", "time.sleep(1.0)"),
        ("memory=300_000_000", "x = np.ones(40_000_000); time.sleep(1)"),
    ):
        assert [ends(tmp_path, limits, body)[0] for _ in range(2)] == [1, 0]


def test_a_limit_that_was_passed_twice_is_named(tmp_path: Path) -> None:
    log = tmp_path / "a.log"
    both = TrialLimits(4.0, 1_500_000_000)
    assert both.exceeded(log) == ""
    log.write_text("Timeout (0:00:04)!\nThread\nMemory (1.6 GB of 1.5 GB)!\n", encoding="utf-8")
    assert both.exceeded(log) == ""
    log.write_text("Timeout (0:00:04)!\nMemory (1.6 GB of 1.5 GB)!\nTimeout (0:00:08)!\n", encoding="utf-8")
    assert both.exceeded(log) == "took more than 4 s, and then more than 8 s"
    log.write_text("Memory (1.6 GB of 1.5 GB)!\n" * 2, encoding="utf-8")
    assert (
        both.exceeded(log) == "took more than 1.5 GB, and then more than 3 GB" and TrialLimits(4.0).exceeded(log) == ""
    )


def trial(folder: Path, limits: TrialLimits, text: str = "1") -> TrialTask:
    """One of the quick analysis."""
    (folder / "A.txt").write_text(text, encoding="utf-8")
    store = Store(folder / "results")
    (store.folder / WORK).mkdir(parents=True, exist_ok=True)
    options = {"file": str(folder / "A.txt")}
    return TrialTask("tests.study.quick:quick", options, folder, store, "a", trial_run._sources(), "run", limits)


def test_a_trial_that_passed_a_limit_twice_is_set_aside_with_its_log(tmp_path: Path) -> None:
    task = trial(tmp_path, TrialLimits(4.0))
    log = task.store.log("a")
    log.write_text("Timeout (0:00:04)!\n", encoding="utf-8")
    assert run_trial(task).state == DONE and not log.exists()
    log.write_text("Timeout (0:00:04)!\n" * 2, encoding="utf-8")
    outcome = run_trial(task)
    line = "took more than 4 s, and then more than 8 s (where it was: results/a.log)"
    assert (outcome.state, outcome.line) == (SET_ASIDE, line) and log.exists()


def test_a_trial_has_the_cores_that_it_may_take(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those of an analysis that uses several, unless the study says how many."""
    seen: list[Any] = []

    def execute(job: Any, options: Any, *_: Any) -> Any:
        seen.append(options.workers)
        raise InputError("", "", "seen")

    monkeypatch.setattr(trial_run, "execute", execute)
    assert "workers" in job_named("area").options.__dataclass_fields__
    (tmp_path / "a.stl").touch()
    options = {"moving": "a.stl", "fixed": "a.stl", "unit": "mm", "sweep": "flexion=0:10:10"}
    for cores, more in ((1, {}), (2, {}), (2, {"workers": 3})):
        task = trial(tmp_path, TrialLimits(cores=cores))
        found = run_trial(replace(task, analysis="area", options={**options, **more}))
        assert found.line == "seen"
    assert seen == [1, 2, 3]


@pytest.mark.parametrize(
    ("text", "size"), [("4GB", 4e9), ("1.5 GB", 1.5e9), ("700MB", 7e8), ("2GiB", 2 * 1024**3), ("10kB", 1e4)]
)
def test_sizes_are_those_of_si_and_of_two(text: str, size: float) -> None:
    assert bytes_of(text) == size and is_size(text)


def test_other_texts_are_no_sizes() -> None:
    assert not any(is_size(text) for text in ("", "4", "GB", "-4GB", "4 gb", "0GB", "4GB/s"))
    assert size_text(1.5e9) == "1.5 GB" and size_text(7e8) == "700 MB"


def test_the_call_goes_before_the_description(tmp_path: Path) -> None:
    lines = ("[limits]", 'time = { value = 10, unit = "min" }', 'memory = "2GB"', "cores = 2")
    settings = read_study_file(study(tmp_path, {"A": "1"}, *lines)).limits
    assert limits_of(settings, CohortOptions(Path("s.toml"))) == TrialLimits(600.0, 2_000_000_000, 2)
    given = CohortOptions(Path("s.toml"), memory="1GB", limit=5.0, cores=1)
    assert limits_of(settings, given) == TrialLimits(5.0, 1_000_000_000, 1)


def test_a_step_has_limits_of_its_own_and_the_others_of_the_study(tmp_path: Path) -> None:
    """Each task has those of its step; workers have room for all."""
    file = chain(tmp_path, NUMBERS)
    own = '[steps.offset.limits]\nmemory = "3GB"\ncores = 4\n\n[limits]\ntime = { value = 1, unit = "min" }\n'
    file.write_text(f"{file.read_text(encoding='utf-8')}\n{own}", encoding="utf-8")
    described, o = read_study_file(file), CohortOptions(file, run_simulator=True)
    plan = StudyPlan(described, runs_of(described), Store(tmp_path / "results"), o, lambda _: True)
    assert {one.run.step for one in plan.evaluations} == {*described.all_steps} and length_hint(plan) == 0
    plan.look()
    assert length_hint(plan) == 2, "two offsets can be evaluated at once, and what takes from them cannot"
    assert {task.step: task.limits for task in plan} == {"offset": TrialLimits(60.0, 3_000_000_000, 4)}
    found = {step: limits_of(described.limits_of(step), o) for step in described.all_steps}
    assert {step: each for step, each in found.items() if step != "offset"} == dict.fromkeys(
        {*found} - {"offset"}, TrialLimits(60.0)
    )
    assert widest(found.values()) == TrialLimits(60.0, None, 4), "some have no limit of memory"
    assert (
        widest([TrialLimits(5.0, 10, 1), TrialLimits(8.0, 7, 2)]) == TrialLimits(8.0, 10, 2)
        and widest([]) == TrialLimits()
    )
    given = CohortOptions(file, memory="1GB", limit=5.0, cores=1)
    assert limits_of(described.limits_of("offset"), given) == TrialLimits(5.0, 1_000_000_000, 1)


def test_a_step_that_does_not_fit_into_jobs_is_refused(tmp_path: Path) -> None:
    file = study(tmp_path, {"A": "1"}, "[cluster]", "jobs = 2", 'memory = "4GB"')
    described, store = read_study_file(file), Store(tmp_path / "results")
    o = CohortOptions(file, scheduler="slurm")
    assert jobs_of(described, [TrialLimits(), TrialLimits(memory=2_000_000_000)], store, o) is not None
    assert jobs_of(described, [TrialLimits(memory=3_000_000_000)], store, replace(o, scheduler="local")) is None
    with pytest.raises(InputError, match=r"\[cluster\] memory: 4 GB are less than 1 trials .*; write 6 GB"):
        jobs_of(described, [TrialLimits(), TrialLimits(memory=3_000_000_000)], store, o)


def test_there_are_no_more_processes_than_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workers, "cores", lambda: 16)
    monkeypatch.setattr(psutil, "virtual_memory", lambda: SimpleNamespace(total=32_000_000_000))
    asked = (TrialLimits(), TrialLimits(cores=3), TrialLimits(memory=4 * 10**9), TrialLimits(memory=10**12))
    assert [_fitting(limits) for limits in asked] == [16, 5, 8, 1]


@pytest.mark.slow
def test_a_study_goes_on_without_the_trial_that_takes_too_much(tmp_path: Path) -> None:
    out = tmp_path / "out"
    lines = ("[limits]", 'time = { value = 15, unit = "s" }', 'memory = "700MB"')
    file = study(tmp_path, {"A": "1", "B": "2 hungry", "C": "3 holds", "D": "4"}, *lines)
    done = call("cohort", file, "--run-simulator", "--workers", "1", "--out", out, folder=out)
    assert list(done.table("trials.csv")["state"]) == ["done", "set aside", "set aside", "done"], done.err
    assert done.code == 1 and "B: took more than 700 MB, and then more than 1.4 GB (where it was: results/" in done.err
    assert "C: took more than 15 s, and then more than 30 s (where it was: results/" in done.err
    logs = sorted((out / "results").glob("*.log"))
    assert len(logs) == 2 and all("quick.py" in log.read_text(encoding="utf-8") for log in logs)
