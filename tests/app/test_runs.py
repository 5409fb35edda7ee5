"""Runs in processes of their own: what they print, their order, and that a cancelled one leaves nothing."""

from __future__ import annotations

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from geocontact.app import calls, runs, samples
from geocontact.app.fields import Form, fields_of, shown
from geocontact.app.pages import Shared, earlier_runs
from geocontact.app.runs import Queue, Run
from geocontact.cli.demo import sample_folder
from tests.cli.test_tool_folders import leg, opencap, put

__all__ = ["leg"]
PATIENCE = 240.0  # s on a busy machine


@pytest.fixture
def queue(tmp_path: Path) -> Iterator[Queue]:
    made = Queue(tmp_path)
    yield made
    made.close()


def until(run: Run, *states: str) -> None:
    end = time.monotonic() + PATIENCE
    while run.state not in states:
        assert time.monotonic() < end and not (run.over and run.state not in states), (run.state, run.said)
        time.sleep(0.02)


def words(command: str, folder: Path, out: str, **more: str | bool) -> list[str]:
    form = Form.of_words(samples.sample(command, folder).words)
    form.values |= more
    return form.words(folder / out)


def test_numbers_are_those_of_the_command_line(queue: Queue, tmp_path: Path) -> None:
    """The line that is shown, given to the shell with the program's name replaced, writes the same table."""
    run = queue.add(words("fit", tmp_path, "window"), tmp_path / "window", "fit")
    line = shown(words("fit", tmp_path, "shell")).partition(" ")[2]
    program = f'"{sys.executable}" -c "from geocontact.cli.main import main; main()"'
    done = subprocess.run(f"{program} {line}", shell=True, cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    until(run, "done")
    found = [json.loads((tmp_path / name / "fit.json").read_text("utf-8")) for name in ("window", "shell")]
    assert found[0] == found[1] and "radius" in str(found[0])
    assert (tmp_path / "window" / "report.html").is_file() and any("sphere" in line for line in run.printed)
    assert run.pages == {"fit": f"/result/{run.key}/report.html"}


def test_each_trial_of_a_folder_has_its_page(leg: Path, queue: Queue, tmp_path: Path) -> None:
    """In this window and, by their names, in the next one; a page that another run left beside them is not its own."""
    folder, out = opencap(leg, tmp_path / "session"), tmp_path / "markers-1"
    put(leg, folder, ("walk.mot", "OpenSimData/Kinematics/walk 2.mot"), ("walk.trc", "MarkerData/walk 2.trc"))
    (out / "other").mkdir(parents=True)
    (out / "other" / "report.html").touch()
    form = Form("markers", {fields_of("markers")[0].name: str(folder), "trial": "walk1\nwalk 2"})
    run = queue.add(form.words(out), out, out.name)
    until(run, "done")
    address = f"/result/{run.key}/"
    assert run.pages == {
        "markers-1/walk 2": f"{address}walk%202/report.html",
        "markers-1/walk1": f"{address}walk1/report.html",
    }
    assert Shared(queue).file(run.key, "walk 2/report.html") == out / "walk 2" / "report.html"
    later = {each.title: each.pages for each in earlier_runs(tmp_path)}
    assert later.keys() == run.pages.keys()
    assert all(list(pages) == [title] for title, pages in later.items())


def test_what_is_refused_says_why_and_warnings_come(queue: Queue, tmp_path: Path) -> None:
    wrong = queue.add(words("fit", tmp_path, "a", unit="m"), tmp_path / "a", "a")
    until(wrong, "refused")
    assert "too large" in wrong.message and not (tmp_path / "a").exists() and not wrong.pages


def test_no_module_of_a_folder_is_run_and_relative_paths_start_where_the_window_does(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Where the window was started and where its results lie somebody left a module; the form and the run read one
    file."""
    home = tmp_path / "results"
    home.mkdir()
    for folder in (tmp_path, home):
        (folder / "cyclopts.py").write_text(f"open({str(tmp_path / 'was run')!r}, 'w')\n", encoding="utf-8")
    (tmp_path / "cup.stl").write_bytes((sample_folder() / "cup_r24.stl").read_bytes())
    monkeypatch.chdir(tmp_path)
    queue = Queue(home)
    try:
        typed = words("fit", home, "fit", mesh="cup.stl")
        assert "cup.stl" in typed and calls.checked(typed, "fit", home / "fit")[1] == ""
        until(queue.add(typed, home / "fit", "fit"), "done")
    finally:
        queue.close()
    assert not (tmp_path / "was run").exists()


def test_what_cannot_be_started_fails_and_the_next_one_runs(
    queue: Queue, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    wrong = queue.add(["fit", "a\0b.stl"], tmp_path / "a", "a")
    until(wrong, "failed")
    assert "null" in wrong.message and wrong.complaints == [wrong.message]
    right, queue.start = queue.start, tmp_path / "gone"
    gone = queue.add(words("fit", tmp_path, "b"), tmp_path / "b", "b")
    until(gone, "failed")
    assert "gone" in gone.message
    queue.start = right
    until(queue.add(words("fit", tmp_path, "c"), tmp_path / "c", "c"), "done")


def test_quick_runs_have_a_folder_each(queue: Queue, tmp_path: Path) -> None:
    """Three at once, one of another page that shows the same folder, and one that spells it in another way."""
    (tmp_path / "fit-4").mkdir()
    form = Form.of_words(samples.sample("fit", tmp_path).words)
    asked = [tmp_path / "fit-1", tmp_path / "fit-1", tmp_path / "fit-2", tmp_path / "x" / ".." / "fit-1"]
    found = [queue.add_apart(form.words, out) for out in asked]
    assert [run.out.name for run in found] == ["fit-1", "fit-2", "fit-3", "fit-5"]
    assert all(run.words[-1] == f"--out={run.out}" for run in found)
    queue.cancel(found[-1])
    assert queue.add_apart(form.words, found[-1].out).out == found[-1].out  # nothing was written there


@pytest.mark.parametrize(
    ("code", "wrote", "state"),
    [
        *((0, False, "done"), (1, True, "done"), (2, True, "done"), (2, False, "refused"), (1, False, "failed")),
        *((-9, True, "failed"), (130, True, "failed")),
    ],
)
def test_results_count_before_the_code(code: int, wrote: bool, state: str) -> None:
    """A study with one wrong trial ends with 2 and has results; what it said of that trial is shown."""
    printed = ["a", "results in out: report.html"] if wrote else ["a"]
    run = Run([], Path("out"), "x", state="running", code=code, printed=printed, said=["trial_3.csv: is empty"])
    run.state = runs._judged(run)
    assert run.state == state and run.complaints == (run.said if code else [])


def test_how_far_it_is_and_the_time_left() -> None:
    run = Run([], Path("out"), "x", state="running")
    for line in ("warning: look", "area: frames …", "pairs: 2 of 10 done …"):
        run.take(line)
    assert (run.warnings, run.stage, run.share) == (["look"], "pairs", 0.2)
    time.sleep(0.2)
    run.take("pairs: 6 of 10 done …")
    left = run.seconds_left()
    assert left is not None and 0.15 < left < 2.0  # 4 of 10 in 0.2 s or a little more: the other 4 take as long
    run.take("x.stl: is damaged; mend it")
    run.state = "failed"
    assert run.message == "x.stl: is damaged; mend it"


@pytest.mark.skipif(os.name == "nt", reason="groups of processes of POSIX")
def test_cancel_ends_all_processes_and_leaves_nothing(queue: Queue, tmp_path: Path) -> None:
    """Two runs of minutes: one with worker processes is cancelled while it runs, the other one before it begins."""
    before = sorted(tmp_path.rglob("*"))
    first = queue.add(
        ["gap", "benchmark", "--system=all", "--cases=5", "--jobs=2", f"--out={tmp_path / 'first'}"],
        tmp_path / "first",
        "first",
    )
    second = queue.add(words("fit", tmp_path, "second"), tmp_path / "second", "second")
    until(first, "running")
    process = first.process
    assert process is not None
    end = time.monotonic() + PATIENCE
    while len(group(process.pid)) < 2 and time.monotonic() < end:
        time.sleep(0.1)
    assert len(group(process.pid)) >= 2, "its workers have begun"
    assert second.state == "waiting"
    queue.cancel(second)
    queue.cancel(first)
    until(first, "cancelled")
    assert not alive(group(process.pid))
    assert sorted(tmp_path.rglob("*")) == before and second.process is None


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_a_run_that_must_be_killed_leaves_nothing(
    queue: Queue, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """It is stopped while its draft is there, so that it does not hear that it is to end; a draft of others stays."""
    monkeypatch.setattr(runs, "GRACE", 0.5)
    others = tmp_path / ".geocontact-0123456789abcdef"
    others.mkdir()
    out = tmp_path / "benchmark"
    run = queue.add(["gap", "benchmark", "--system=all", "--cases=5", "--jobs=2", f"--out={out}"], out, "benchmark")
    end = time.monotonic() + PATIENCE
    while len(list(tmp_path.glob(".geocontact-*"))) < 2:
        assert time.monotonic() < end and not run.over, run.said
        time.sleep(0.02)
    assert run.process is not None
    os.kill(run.process.pid, signal.SIGSTOP)
    queue.cancel(run)
    assert [each.name for each in tmp_path.glob(".geocontact-*")] == [others.name] and not out.exists()


def group(leader: int) -> list[int]:
    """Processes of a group."""
    told = subprocess.run(["ps", "-eo", "pgid=,pid="], capture_output=True, text=True).stdout
    return [int(pid) for pgid, pid in (line.split() for line in told.splitlines()) if int(pgid) == leader]


def alive(processes: list[int]) -> bool:
    """Whether one of them still runs; those that nobody has asked after yet do not."""
    states = [
        subprocess.run(["ps", "-o", "stat=", "-p", str(pid)], capture_output=True, text=True) for pid in processes
    ]
    return any(state.stdout.strip() and not state.stdout.startswith("Z") for state in states)
