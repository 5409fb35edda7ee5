"""What a study of 100,000 trials would cost: measured on this machine by the trial, simulated on clusters.

`python -m benchmarks.study.plan` writes results/cohort_plan.json. Measured: CPU seconds, bytes and files of a trial
(the shipped knee, 101 frames), and what a study costs its own process by the trial, from studies of two sizes, first
and again. Simulated, with intervals over seeds: workers that end at random and come back, trials that fail, trials
that kill their worker and are set aside after three times, a study that is itself ended and started again. CPU seconds
of a diagnosis are those of the cases of results/gap_benchmark_cases.csv. Rates of failure are assumed.
"""

from __future__ import annotations

import argparse
import csv
import heapq
import resource
import tempfile
import time
from collections import deque
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from jaxtyping import Bool, Float

from benchmarks.machine import write_results
from geocontact.study.store import MOST_ENDED

ROOT = Path(__file__).resolve().parents[2]
TRIALS = 100_000
WORKERS = (8, 64, 256)
SEEDS = 20
SPREAD = 0.2  # assumed: standard deviation of log CPU seconds of an area trial
RETURNS = 60.0  # s, assumed: until a worker that ended is there again
SIZES = (100, 500)  # trials of the studies that are measured
SCENARIOS = {  # assumed: workers that end per hour, trials that fail, that kill their worker; ends of the study per day
    "calm": (0.01, 0.001, 0.0, 0.0),
    "usual": (0.1, 0.01, 0.0005, 0.5),
    "rough": (2.0, 0.05, 0.005, 4.0),
}


@dataclass(frozen=True)
class Cluster:
    """Workers, how often each ends by itself [1/h], how often the study does [1/day], what the study needs [s]."""

    workers: int
    ends: float
    study_ends: float
    giving_out: float
    beginning_again: float


@dataclass
class Course:
    """A simulated study so far: trials to be given out, and (end, begin, trial) of each worker, -1 for no trial."""

    waiting: deque[int]
    workers: list[tuple[float, float, int]]
    client: float = 0.0  # when the study's own process has time again
    lost: float = 0.0
    again: int = 0

    def ends(self, at: float, beginning_again: float) -> None:
        """The study's process ends, and what is at work is lost; it is started again at once."""
        for end, begin, trial in self.workers:
            if end > at and trial >= 0:
                self.lost += max(0.0, at - begin)
                self.waiting.appendleft(trial)
        self.client = at + beginning_again
        self.workers = [(self.client, self.client, -1)] * len(self.workers)
        self.again += 1


def simulated(
    seconds: Float[np.ndarray, " n"],
    fails: Bool[np.ndarray, " n"],
    kills: Bool[np.ndarray, " n"],
    c: Cluster,
    seed: int,
) -> dict[str, float]:
    """One study: hours, share of the workers' time that came to results, trials that failed and were set aside.

    A trial whose worker ends under it is given out again, and set aside when that has happened three times in one run
    of the study; a trial that kills does so at a random moment of its time. When the study's own process ends, every
    trial at work is lost, and the next run begins after it has looked at what is there.
    """
    rng = np.random.default_rng(seed)
    at = Course(deque(range(len(seconds))), [(0.0, 0.0, -1)] * c.workers, c.beginning_again)
    ended, set_aside = np.zeros(len(seconds), int), np.zeros(len(seconds), bool)
    next_end = _wait(rng, c.study_ends / 86_400.0)
    while at.waiting or max(at.workers)[0] > next_end:
        begin = max(at.workers[0][0], at.client) if at.waiting else np.inf
        if begin > next_end:
            at.ends(next_end, c.beginning_again)
            ended[:] = 0
            next_end = at.client + _wait(rng, c.study_ends / 86_400.0)
            continue
        trial = at.waiting.popleft()
        at.client = begin + c.giving_out
        stop = seconds[trial] * rng.uniform() if kills[trial] else _wait(rng, c.ends / 3600.0)
        if stop >= seconds[trial]:
            heapq.heapreplace(at.workers, (begin + seconds[trial], begin, trial))
            continue
        at.lost += stop
        heapq.heapreplace(at.workers, (begin + stop + RETURNS, begin, -1))
        ended[trial] += 1
        set_aside[trial] = ended[trial] >= MOST_ENDED
        if not set_aside[trial]:
            at.waiting.append(trial)
    last = max((end for end, _, trial in at.workers if trial >= 0), default=at.client)
    return {
        "hours": last / 3600.0,
        "share": float(seconds[~set_aside].sum()) / (last * c.workers),
        "lost_cpu_hours": at.lost / 3600.0,
        "failed": int((fails & ~set_aside).sum()),
        "set_aside": int(set_aside.sum()),
        "set_aside_innocent": int((set_aside & ~kills).sum()),
        "started_again": at.again,
    }


def _wait(rng: np.random.Generator, rate: float) -> float:
    """Until something happens that happens at this rate."""
    return rng.exponential(1.0 / rate) if rate else np.inf


def over_seeds(
    draw: Any, trials: int, scenario: tuple[float, ...], workers: int, client: dict[str, float]
) -> dict[str, Any]:
    """Mean and the middle 95 % of seeds."""
    ends, fail, kill, study_ends = scenario
    told = []
    for seed in range(SEEDS):
        rng = np.random.default_rng([seed, workers])
        seconds = draw(rng, trials)
        fails, kills = rng.uniform(size=(2, trials)) < np.array([[fail], [kill]])
        again = client["again_ms"] * trials / 1e3
        cluster = Cluster(workers, ends, study_ends, client["first_ms"] / 1e3, again)
        told.append(simulated(seconds, fails, kills, cluster, seed))
    return {
        key: [
            round(float(f(values)), 3)
            for f in (np.mean, lambda v: np.quantile(v, 0.025), lambda v: np.quantile(v, 0.975))
        ]
        for key in told[0]
        for values in [[one[key] for one in told]]
    }


def a_trial() -> dict[str, float]:
    """CPU seconds, bytes and files of the shipped knee over its cycle, as a worker of a study evaluates it."""
    from geocontact.analyses.area.options import AreaOptions
    from geocontact.analyses.area.result import area
    from geocontact.analyses.frame.job import Call, execute
    from geocontact.analyses.frame.record import Listener
    from geocontact.analyses.frame.table_forms import TableForms

    meshes, cpu = ROOT / "meshes", []
    options = AreaOptions(
        meshes / "femoral_component_right_medium.stl",
        meshes / "tibial_insert_right_medium.stl",
        unit="mm",
        motion=(str(meshes / "gait.csv"),),
        workers=1,
    )
    with tempfile.TemporaryDirectory() as scratch:
        for k in range(3):  # the first one compiles
            started = time.process_time()
            execute(area, options, Path(scratch, str(k)), Call({}, Listener(), forms=TableForms(parquet=True)))
            cpu.append(time.process_time() - started)
        files = [file for file in Path(scratch, "2").rglob("*") if file.is_file()]
        tables = sum(file.stat().st_size for file in files if file.suffix in (".parquet", ".csv"))
        return {
            "cpu_seconds": round(min(cpu[1:]), 3),
            "bytes": sum(file.stat().st_size for file in files),
            "bytes_of_tables": tables,
            "files": len(files),
            "frames": 101,
        }


def of_the_study() -> dict[str, float]:
    """CPU milliseconds and bytes of memory of the study's own process, scheduler included, for one more trial.

    `first`: planned, given out, kept, put into tables and page; `again`: the same when all of it is there.
    """
    from geocontact.analyses.frame.job import Call, execute
    from geocontact.analyses.frame.record import Listener
    from geocontact.study.options import CohortOptions
    from geocontact.study.result import cohort
    from tests.study.quick import study

    spent: dict[str, list[float]] = {"first": [], "again": []}
    memory = []
    for trials in SIZES:
        with tempfile.TemporaryDirectory() as scratch:
            file = study(Path(scratch), {f"S{k:04d}": str(k % 50) for k in range(trials)})
            for of_run in spent.values():
                started = time.process_time()
                execute(cohort, CohortOptions(file, workers=1), Path(scratch, "out"), Call({}, Listener()))
                of_run.append(time.process_time() - started)
            memory.append(1024.0 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss)
    more = SIZES[1] - SIZES[0]
    slopes = {f"{name}_ms": round(1e3 * (two - one) / more, 3) for name, (one, two) in spent.items()}
    return {**slopes, "memory_bytes": round((memory[1] - memory[0]) / more)}


def main() -> None:
    """Measure, then simulate both analyses on clusters of several sizes and tempers."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--trials", type=int, default=TRIALS)
    asked = parser.parse_args()
    trial, client = a_trial(), of_the_study()
    print(trial, client)
    with (ROOT / "benchmarks/results/gap_benchmark_cases.csv").open(encoding="utf-8") as file:
        diagnoses = np.array([float(row["cpu [s]"]) for row in csv.DictReader(file)])
    draws = {
        "area": lambda rng, n: trial["cpu_seconds"] * rng.lognormal(-0.5 * SPREAD**2, SPREAD, n),
        "gap diagnose": lambda rng, n: rng.choice(diagnoses, n),
    }
    figures: dict[str, Any] = {
        "trial": trial,
        "study": client,
        "assumed": {"scenarios": SCENARIOS, "returns_s": RETURNS},
    }
    figures["diagnosis_cpu_seconds"] = round(float(diagnoses.mean()), 3)
    for analysis, draw in draws.items():
        for name, scenario in SCENARIOS.items():
            for workers in WORKERS:
                key = f"{analysis}, {name}, {workers}"
                figures[key] = over_seeds(draw, asked.trials, scenario, workers, client)
                print(key, figures[key], flush=True)
                write_results("cohort_plan", {**vars(asked), "seeds": SEEDS}, figures, {"dask", "distributed"})


if __name__ == "__main__":
    main()
