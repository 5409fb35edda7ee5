"""What a study of steps costs beside its steps: many subjects, three steps each, of analyses that compute nothing.

`python -m benchmarks.study.steps --subjects 500` writes results/cohort_steps.json. Each subject is a file with a
number: a sum, a sine of as many rows, and their sum. The study is run from nothing, again, and after one file has
changed: only that subject's three evaluations may be new. Overhead is what the workers' time has beside the
evaluations' own, in ms of an evaluation; an evaluation's own time is writing its files. Subjects are synthetic.
"""

from __future__ import annotations

import argparse
import json
import re
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.machine import write_results

ROOT = Path(__file__).resolve().parents[2]
STUDY = """files = "{subject}.txt"
analysis = "tests.study.chained:add"
pages = PAGES
figures = PAGES
options = { files = ["{sine:sine.csv}"] }

[steps.sum]
analysis = "tests.study.chained:add"
options = { files = ["{file}"] }

[steps.sine]
analysis = "tests.study.quick:quick"
options = { file = "{sum:total.txt}" }
"""
STEPS = 3


def measured(file: Path, out: Path, workers: int) -> dict[str, float]:
    """One run: its CPU time with that of its workers, how many evaluations were new, overhead of each."""
    before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = [sys.executable, "cli.py", "cohort", str(file), "--run-simulator", "--out", str(out)]
    command += ["--workers", str(workers)]
    told = subprocess.run(command, cwd=ROOT, check=False, stdout=subprocess.PIPE, encoding="utf-8")
    if told.returncode:
        raise SystemExit(f"the study ended with {told.returncode}")
    after, whole = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter() - started
    results = json.loads((out / "run.json").read_text(encoding="utf-8"))["results"]
    cpu = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    found = {"seconds": round(whole, 2), "cpu_seconds": round(cpu, 2)}
    found["new"] = sum(int(each) for each in re.findall(r"(\d+) of them new", told.stdout))
    if "work" in results:
        work, spent = results["work"]["seconds"], results["one_by_one"]["seconds"]
        found |= {
            "own_ms": round(1e3 * spent / found["new"], 2),
            "overhead_ms": round(1e3 * (work * workers - spent) / found["new"], 2),
        }
    return found


def made(folder: Path, subjects: int, *, pages: bool) -> Path:
    """The study of so many subjects."""
    for k in range(subjects):
        (folder / f"S{k:04d}.txt").write_text(str(10 + k), encoding="utf-8")
    file = folder / "study.toml"
    file.write_text(STUDY.replace("PAGES", str(pages).lower()), encoding="utf-8")
    return file


def main() -> None:
    """A study from nothing, again, and after a change; a smaller one with pages and figures."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--subjects", type=int, default=500)
    parser.add_argument("--with-pages", type=int, default=10)
    parser.add_argument("--workers", type=int, default=2)
    asked = parser.parse_args()
    figures: dict[str, object] = {}
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        file = made(folder, asked.subjects, pages=False)
        figures["from_nothing"] = measured(file, folder / "out", asked.workers)
        figures["again"] = again = measured(file, folder / "out", asked.workers)
        (folder / "S0007.txt").write_text("5000", encoding="utf-8")
        figures["one_file_changed"] = changed = measured(file, folder / "out", asked.workers)
        assert again["new"] == 0 and changed["new"] == STEPS, "only the chain of that subject"
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        figures["with_pages"] = measured(made(folder, asked.with_pages, pages=True), folder / "out", asked.workers)
    print(figures, write_results("cohort_steps", vars(asked), figures, {"dask", "distributed"}))


if __name__ == "__main__":
    main()
