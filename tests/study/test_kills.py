"""A study that is killed, or loses a worker, comes to the same tables; long: benchmarks/study/kills.py."""

from __future__ import annotations

import multiprocessing
import os
import subprocess
import sys
import time
from pathlib import Path

import psutil
import pytest

from benchmarks.study.kills import ROOT, disturb, prepare, start
from geocontact.study.worker_setup import dask_setup
from tests.study.quick import study


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.slow
@pytest.mark.long  # with every change: workers that are killed, in test_cohort.py, and those below
def test_tables_after_one_kill_are_those_of_an_undisturbed_run(tmp_path: Path) -> None:
    """The study itself, by SIGKILL, after 86 % of the time that it takes: about when its trials are run."""
    found = disturb(prepare(tmp_path, 3), tmp_path, 1, seed=537)
    assert sum(found.kills.values()) == 1 and found.ended >= 1
    assert (found.different, found.left_running) == (0, 0), found


@pytest.mark.skipif(sys.platform == "win32", reason="signals")
@pytest.mark.slow
@pytest.mark.long
def test_tables_after_kills_are_those_of_an_undisturbed_run(tmp_path: Path) -> None:
    found = disturb(prepare(tmp_path, 6), tmp_path, 3, seed=11)
    assert sum(found.kills.values()) == 3 and found.ended >= 1
    assert (found.different, found.left_running) == (0, 0), found


def late() -> None:
    """A worker that comes to its set-up when the process that started it has been killed."""
    starter = multiprocessing.parent_process()
    assert starter is not None
    starter.join()
    os.write(1, b"late\n")
    dask_setup(None)
    os.write(1, b"left running\n")


KILLED_EARLY = """import multiprocessing, os, signal
from tests.study.test_kills import late
multiprocessing.get_context("spawn").Process(target=late).start()
os.kill(os.getpid(), signal.SIGKILL)"""


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the system does not end them")
def test_a_worker_whose_study_is_killed_while_it_starts_ends() -> None:
    done = subprocess.run([sys.executable, "-c", KILLED_EARLY], cwd=ROOT, check=False, capture_output=True, timeout=300)
    assert (done.returncode, done.stdout) == (-9, b"late\n"), done.stderr


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere the system does not end them")
@pytest.mark.slow
def test_workers_end_with_a_killed_study_whatever_they_are_at(tmp_path: Path) -> None:
    """A trial of a minute in compiled code that does not let other threads run, so none of them can end it."""
    process = start(study(tmp_path, {"S1": "1 holds"}), tmp_path / "out")
    end = time.monotonic() + 300.0
    while not (tmp_path / "S1.begun").exists():
        assert process.poll() is None and time.monotonic() < end
        time.sleep(0.05)
    children = psutil.Process(process.pid).children(recursive=True)
    process.kill()
    process.wait()
    assert len(children) > 1 and psutil.wait_procs(children, 20.0)[1] == []
