"""What a chained study costs beside its analyses: subjects × 3 steps on two workers, then after one file has changed.

`python -m benchmarks.study.chain --subjects 500` writes results/cohort_chain.json. The study is that of `leg_chain`. It
is run from nothing, again, and after one subject's file has changed: only that subject's chain may be evaluated.
Overhead of an evaluation is the time of the study, its start and its tables among it, less what the same analyses take
alone in one process that writes the same files. CPU time is that of all processes; wall time hangs on what else the
machine does, `load` is the mean count of processes that wanted a core before and after.
"""

from __future__ import annotations

import argparse
import json
import os
import shutil
import tempfile
import time
from collections.abc import Callable, Mapping
from contextlib import chdir
from pathlib import Path
from typing import Any

from benchmarks.machine import write_results
from benchmarks.study.leg_chain import MODEL, ROOT, STEPS, Measured, factor, made, measured, name, swing, work_of

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


def stages(folder: Path, subjects: int, workers: int) -> dict[str, Callable[[], dict[str, Any]]]:
    """What is measured on the study in a folder, by name, in this order; each gives figures for the file."""
    file, out = folder / "study.toml", folder / "out"

    def from_nothing() -> dict[str, Any]:
        each, run = alone(made(folder, subjects).parent, min(20, subjects)), measured(file, out, workers)
        work, spent = work_of(out)
        told = figures_of(run) | {"work_seconds": work, "seconds_of_evaluations": spent}
        return {"alone": each, "from_nothing": told, "overhead": overhead(run, each, workers)}

    def again() -> dict[str, Any]:
        return {"again": figures_of(measured(file, out, workers))}

    def one_file_changed() -> dict[str, Any]:
        swing(folder / f"{name(CHANGED % subjects)}.mot", factor(subjects + 1))
        return {"one_file_changed": figures_of(measured(file, out, workers))}

    return {"from_nothing": from_nothing, "again": again, "one_file_changed": one_file_changed}


def expect(found: Mapping[str, Any], subjects: int) -> None:
    """AssertionError where a run evaluated other than what its change reaches."""
    for stage, count in (("from_nothing", subjects), ("again", 0), ("one_file_changed", 1)):
        assert stage not in found or found[stage]["new"] == dict.fromkeys(STEPS, count), (stage, found[stage])


def main() -> None:
    """One study of so many subjects."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--subjects", type=int, default=500)
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--folder", type=Path, help="the study is kept there, and other stages find it")
    parser.add_argument("--only", nargs="*", default=["from_nothing", "again", "one_file_changed"], metavar="STAGE")
    parser.add_argument("--dry", action="store_true", help="write no results")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = asked.folder or Path(scratch)
        for stage, measure in stages(folder, asked.subjects, asked.workers).items():
            if stage in asked.only:
                load = os.getloadavg()[0]
                figures = measure()
                figures[stage]["load"] = [round(each, 1) for each in (load, os.getloadavg()[0])]
                expect(figures, asked.subjects)
                print(figures, flush=True)
                if not asked.dry:
                    keep(figures, asked.subjects, asked.workers)


def keep(figures: Mapping[str, Any], subjects: int, workers: int) -> None:
    """Write figures into the file of results, in place of those of the same stages."""
    file = ROOT / "benchmarks" / "results" / "cohort_chain.json"
    known = json.loads(file.read_text(encoding="utf-8"))["figures"] if file.is_file() else {}
    write_results("cohort_chain", {"subjects": subjects, "workers": workers}, {**known, **figures}, PACKAGES)


if __name__ == "__main__":
    main()
