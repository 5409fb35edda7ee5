"""How a study scales with its workers, and what it costs beside its trials.

`python -m benchmarks.study.scaling --trials 500` writes results/cohort_scaling.json. Trials that wait 0.3 s show the
study's own scaling on a machine whose cores others use too; `--real N` adds N contact areas of the shipped knee, two
frames each, which need the cores. Overhead per trial is what the workers' time has beside the trials' own: (seconds
from the first trial given out to the last one back) x workers - (sum of the trials' seconds), over the trials.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from benchmarks.machine import write_results
from tests.study.quick import study, tables

ROOT = Path(__file__).resolve().parents[2]
POSES = 2


def waiting(folder: Path, trials: int) -> Path:
    return study(folder, {f"S{k:04d}": f"{k % 50} slow" for k in range(trials)})


def areas(folder: Path, trials: int) -> Path:
    """Each trial has two poses of the shipped cycle."""
    head, *rows = (ROOT / "meshes" / "gait.csv").read_text(encoding="utf-8").splitlines()
    for k in range(trials):
        two = "\n".join([head, *rows[k % 90 : k % 90 + POSES]]) + "\n"
        (folder / f"S{k:04d}.csv").write_text(two, encoding="utf-8")
    file = folder / "study.toml"
    file.write_text(
        f"""analysis = "area"
files = "{{subject}}.csv"
[options]
moving = "{ROOT}/meshes/femoral_component_right_coarse.stl"
fixed = "{ROOT}/meshes/tibial_insert_right_coarse.stl"
unit = "mm"
motion = "{{file}}"
""",
        encoding="utf-8",
    )
    return file


def measured(file: Path, out: Path, workers: int) -> dict[str, float]:
    before, started = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter()
    command = [sys.executable, "cli.py", "cohort", str(file), "--run-simulator", "--out", str(out)]
    subprocess.run(
        [*command, "--workers", str(workers)],
        cwd=ROOT,
        check=True,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    after, whole = resource.getrusage(resource.RUSAGE_CHILDREN), time.perf_counter() - started
    told = json.loads((out / "run.json").read_text(encoding="utf-8"))["results"]
    trials, work, spent = told["trials"]["all"], told["work"]["seconds"], told["one_by_one"]["seconds"]
    return {
        "workers": workers,
        "trials": trials,
        "seconds": work,
        "seconds_with_start_and_tables": round(whole, 2),
        "cpu_seconds": round(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, 2),
        "trials_seconds": spent,
        "overhead_per_trial_ms": round(1e3 * (work * workers - spent) / trials, 2),
    }


def compared(file: Path, folder: Path) -> dict[str, object]:
    one, two = (measured(file, folder / f"out{workers}", workers) for workers in (1, 2))
    same = tables(folder / "out1") == tables(folder / "out2")
    return {"one": one, "two": two, "speed_up": round(one["seconds"] / two["seconds"], 3), "tables_equal": same}


def main() -> None:
    """One worker and two, on the same trials."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--trials", type=int, default=500)
    parser.add_argument("--real", type=int, default=0)
    asked = parser.parse_args()
    figures = {}
    for name, make, trials in (("waiting", waiting, asked.trials), ("areas", areas, asked.real)):
        if trials:
            with tempfile.TemporaryDirectory() as scratch:
                figures[name] = compared(make(Path(scratch), trials), Path(scratch))
            print(name, figures[name], write_results("cohort_scaling", vars(asked), figures, {"dask", "distributed"}))


if __name__ == "__main__":
    main()
