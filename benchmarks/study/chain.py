"""What a chained study costs beside its analyses: subjects × 3 steps on two workers, then after one file has changed.

`python -m benchmarks.study.chain --subjects 500` writes results/cohort_chain.json. The study is that of `leg_chain`. It
is run from nothing, again, and after one subject's file has changed: only that subject's chain may be evaluated.
Overhead of an evaluation is the time of the study, its start and its tables among it, less what the same analyses take
alone in one process that writes the same files. CPU time is that of all processes; wall time hangs on what else the
machine does, `load` is the mean count of processes that wanted a core before and after.
"""

from __future__ import annotations

import argparse
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Mapping
from contextlib import chdir
from pathlib import Path
from typing import Any

from benchmarks.machine import write_results
from benchmarks.study.leg_chain import MODEL, STEPS, Measured, factor, made, measured, name, swing, work_of

PACKAGES = {"dask", "distributed", "pyarrow"}
CHANGED = 7
"""Subject whose file changes."""


def alone(folder: Path, subjects: int) -> dict[str, dict[str, float]]:
    """CPU and wall milliseconds of one evaluation of each step, one after another in this process, none of the first.

    The files of the study are in `folder`, what is written there by a worker is written here.
    """
    spent: dict[str, list[tuple[float, float]]] = {step: [] for step in STEPS}
    with chdir(folder):
        for k in (0, *range(subjects)):  # the first one imports and compiles
            for step, options in typed(k).items():
                out = Path("alone", f"{step}{k}")
                shutil.rmtree(out, ignore_errors=True)
                at = time.process_time(), time.perf_counter()
                evaluate(STEPS[step], options, out)
                spent[step].append((time.process_time() - at[0], time.perf_counter() - at[1]))
        shutil.rmtree("alone")
    found = {}
    for step, each in spent.items():
        cpu, wall = (1e3 * sum(times) / subjects for times in zip(*each[1:], strict=True))
        found[step] = {"cpu_ms": round(cpu, 2), "wall_ms": round(wall, 2)}
    return found


def typed(subject: int) -> dict[str, dict[str, Any]]:
    """Options of each step of a subject, with the files that `alone` writes."""
    markers, angles = (f"alone/{step}{subject}/{file}" for step, file in (("markers", "markers.trc"), ("ik", "ik.mot")))
    return {
        "markers": {"coordinates": f"{name(subject)}.mot", "model": MODEL},
        "ik": {"markers": markers, "model": MODEL},
        "id": {"coordinates": angles, "model": MODEL},
    }


def evaluate(analysis: str, options: Mapping[str, Any], out: Path) -> None:
    """One evaluation as a worker makes it, without the study around it."""
    from geocontact.analyses.catalogue import job_named
    from geocontact.analyses.frame.job import Call, execute
    from geocontact.analyses.frame.record import Listener
    from geocontact.analyses.frame.table_forms import TableForms
    from geocontact.study.address import options_of

    job = job_named(analysis)
    call = Call(dict(options), Listener(), forms=TableForms(parquet=True), without=frozenset({"pages", "figures"}))
    execute(job, options_of(job.options, options), out, call)


def figures_of(run: Measured) -> dict[str, Any]:
    """A run as it stands in the file."""
    if run.code:
        raise SystemExit(f"the study ended with {run.code}: {run.err[-500:]}")
    return {"seconds": round(run.seconds, 2), "cpu_seconds": round(run.cpu_seconds, 2), "new": run.new}


def overhead(run: Measured, each: Mapping[str, Mapping[str, float]], workers: int) -> dict[str, float]:
    """Milliseconds of one evaluation beside the analysis, in CPU time and, of each worker, in wall time."""
    cpu, wall = (1e-3 * sum(run.new[step] * each[step][key] for step in each) for key in ("cpu_ms", "wall_ms"))
    count = run.all_new
    return {
        "cpu_ms": round(1e3 * (run.cpu_seconds - cpu) / count, 2),
        "wall_ms": round(1e3 * (run.seconds * workers - wall) / count, 2),
    }


def compared(folder: Path, subjects: int, workers: int, tell: Callable[[Mapping[str, Any]], None]) -> None:
    """All runs, `tell` is called after each; the new evaluations are those that depend on what changed."""
    file, out = made(folder, subjects), folder / "out"
    found: dict[str, Any] = {"alone": alone(folder, min(20, subjects))}
    first = measured(file, out, workers)
    work, spent = work_of(out)
    found["from_nothing"] = figures_of(first) | {"work_seconds": work, "seconds_of_evaluations": spent}
    found["overhead"] = overhead(first, found["alone"], workers)
    tell(found)
    found["again"] = figures_of(measured(file, out, workers))
    tell(found)
    swing(folder / f"{name(CHANGED % subjects)}.mot", factor(subjects + 1))
    found["one_file_changed"] = figures_of(measured(file, out, workers))
    expect(found, subjects)
    tell(found)


def expect(found: Mapping[str, Any], subjects: int) -> None:
    """AssertionError where a run evaluated other than what its change reaches."""
    assert found["from_nothing"]["new"] == dict.fromkeys(STEPS, subjects), found["from_nothing"]
    assert found["again"]["new"] == dict.fromkeys(STEPS, 0), found["again"]
    assert found["one_file_changed"]["new"] == dict.fromkeys(STEPS, 1), found["one_file_changed"]


def main() -> None:
    """One study of so many subjects."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--subjects", type=int, default=500)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--dry", action="store_true", help="write no results")
    asked = parser.parse_args()
    load = os.getloadavg()[0]

    def tell(found: Mapping[str, Any]) -> None:
        told = {**found, "load": [round(load, 1), round(os.getloadavg()[0], 1)]}
        print(told, flush=True)
        if not asked.dry:
            write_results("cohort_chain", vars(asked), told, PACKAGES)

    with tempfile.TemporaryDirectory() as scratch:
        compared(Path(scratch), asked.subjects, asked.workers, tell)


if __name__ == "__main__":
    main()
