"""Jobs of a queueing system: a real SLURM on this machine, and the scripts that all four are given."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import psutil
import pytest

from geocontact.data.errors import InputError
from geocontact.study.cluster import SYSTEMS, ClusterSettings, Jobs, job_size
from geocontact.study.description import read_study_file
from geocontact.study.limits import Limits
from geocontact.study.options import CohortOptions
from tests.cli.calls import ROOT
from tests.study import slurm_host
from tests.study.quick import study, tables

CLUSTER = ("[cluster]", "jobs = 2", 'memory = "1GB"', 'walltime = "00:10:00"', "")


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, str]]:
    """A SLURM of its own, ended with the tests."""
    if why := slurm_host.missing():
        pytest.skip(why)
    with slurm_host.slurm(tmp_path_factory.mktemp("slurm")) as environment:
        yield environment


def start(file: Path, out: Path, environment: dict[str, str], *more: str) -> subprocess.Popen[str]:
    """A study that is run by jobs."""
    command = [sys.executable, "cli.py", "cohort", str(file), "--run-simulator", "--out", str(out), *more]
    own = environment | {"PYTHONPATH": str(ROOT), "MPLBACKEND": "agg"}
    return subprocess.Popen(command, cwd=ROOT, env=own, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def workers() -> list[psutil.Process]:
    """Processes of jobs."""
    found = []
    for one in psutil.process_iter(["cmdline"]):
        words = one.info["cmdline"] or []
        if "distributed.cli.dask_worker" in words and "tls://" in " ".join(words):
            found.append(one)
    return found


@pytest.mark.slow
def test_a_study_on_slurm_whose_workers_are_killed_has_the_tables_of_an_undisturbed_one(
    tmp_path: Path, cluster: dict[str, str]
) -> None:
    """The nanny and the worker of a job are killed; a job is cancelled; another trial takes longer than it may."""
    numbers = {f"S{k:02d}": f"{k} slow" for k in range(40)}
    file = study(tmp_path, numbers, *CLUSTER)
    out = tmp_path / "out"
    running = start(file, out, cluster, "--scheduler", "slurm")
    disturbed: list[str] = []

    def disturb() -> None:
        slurm_host.wait_for(lambda: len(list(out.glob("results/*/trial.json"))) > 3, 300.0)
        job = workers()[0]
        for one in [*job.children(recursive=True), job]:
            one.kill()
        disturbed.append("killed")
        ids = slurm_host.said_by(cluster, "squeue", "-h", "-o", "%i").split()
        slurm_host.said_by(cluster, "scancel", ids[-1])
        disturbed.append("cancelled")

    other = threading.Thread(target=disturb)
    other.start()
    said, complaints = running.communicate(timeout=500)
    other.join()
    assert running.returncode == 0 and disturbed == ["killed", "cancelled"], complaints
    assert "40 of 40 trials" in said
    slurm_host.wait_for(lambda: not slurm_host.said_by(cluster, "squeue", "-h", "-o", "%i"))
    plain = subprocess.run(
        [
            sys.executable,
            "cli.py",
            "cohort",
            str(file),
            "--run-simulator",
            "--workers",
            "2",
            "--out",
            tmp_path / "plain",
        ],
        cwd=ROOT,
        env=os.environ | {"PYTHONPATH": str(ROOT)},
        capture_output=True,
        text=True,
    )
    assert plain.returncode == 0 and tables(out) == tables(tmp_path / "plain")
