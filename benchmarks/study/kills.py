"""Kills of a study at random moments; the tables that come out in the end are those of a run that nobody disturbed.

`python -m benchmarks.study.kills --kills 50` writes results/cohort_kills.json after every run, with `--chain`
results/cohort_kills_chain_SEED.json, and ends after `--minutes` at the latest. A study of 12 evaluations is started
again and again on the same folder, and killed: its own process (SIGKILL or SIGTERM) or one of its workers (SIGKILL).
When a run comes to its end the tables are compared, and the next one starts from nothing. The 12 are short trials of
one step that waits, or in the chain four subjects of three steps (`leg_chain`): there every second kill comes at a
random moment of the run, the others after a random count of results, so that steps are cut off from earlier ones.
"""

from __future__ import annotations

import argparse
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
import psutil

from benchmarks.machine import write_results
from benchmarks.study.leg_chain import STEPS, made, tables
from geocontact.study.store import RESULTS, Store
from tests.study.quick import study

ROOT = Path(__file__).resolve().parents[2]
TRIALS = 12
"""Evaluations, of all steps together."""
SOON = 0.5  # s; a kill after a count of results comes within this time
GONE = 15.0  # s; in which workers of a killed study are to end
GIVEN = 2.0  # s of a core that one may take first where other work keeps the cores: until it can end it takes 0.6
MOST = 180.0  # s; then it counts as left, however little it was given
PACKAGES = {"dask", "distributed", "pyarrow"}
OF_KILLS = (143, -15, -9)
"""Exit codes of a killed study: ended by its own handler of SIGTERM, or before it had one."""
WAYS = ("study, SIGKILL", "study, SIGTERM", "worker, SIGKILL")


@dataclass
class Killed:
    """What came of it: kills by way, runs that came to their end, how many of them had other tables.

    `kept` is how many evaluations had results at each kill, `odd` what runs said that ended with an error of their own.
    """

    kills: Counter[str] = field(default_factory=Counter)
    ended: int = 0
    different: int = 0
    left_running: int = 0
    kept: list[int] = field(default_factory=list)
    odd: list[str] = field(default_factory=list)
    codes: Counter[int] = field(default_factory=Counter)


def prepare(folder: Path, trials: int = TRIALS) -> Path:
    """A study of trials that take 0.3 s each."""
    return study(folder, {f"S{k:03d}": f"{k} slow" for k in range(trials)})


def command(file: Path, out: Path) -> list[str]:
    return [sys.executable, "cli.py", "cohort", str(file), "--run-simulator", "--out", str(out), "--workers", "2"]


def start(file: Path, out: Path) -> subprocess.Popen[bytes]:
    """A run, whose lines on stderr go beside the description."""
    with said(file).open("wb") as err:
        return subprocess.Popen(command(file, out), cwd=ROOT, stdout=subprocess.DEVNULL, stderr=err)


def said(file: Path) -> Path:
    """What the last run said on stderr."""
    return file.with_suffix(".err")


def reference(file: Path, out: Path) -> tuple[dict[str, bytes], float]:
    """Tables of a run that nobody disturbs, and how long it takes [s]."""
    started = time.perf_counter()
    if start(file, out).wait() != 0:
        raise RuntimeError("the study fails without a kill")
    return tables(out), time.perf_counter() - started


def disturb(
    file: Path,
    folder: Path,
    kills: int,
    seed: int,
    told: Callable[[Killed], None] = lambda _: None,
    most: float = 1e9,
    evaluations: int = 0,
) -> Killed:
    """Kill at random moments until it has been done so often, or for `most` seconds; `told` hears after every run.

    With a number of `evaluations` every second kill comes after a random count of results.
    """
    rng, found = np.random.default_rng(seed), Killed()
    expected, seconds = reference(file, folder / "undisturbed")
    out, began = folder / "out", time.perf_counter()
    while sum(found.kills.values()) < kills and time.perf_counter() - began < most:
        told(found)
        process = start(file, out)
        way, moment = WAYS[rng.integers(len(WAYS))], rng.uniform(0.0, seconds)
        if evaluations and rng.integers(2):
            moment = rng.uniform(0.0, SOON)
            _wait(process, out, int(rng.integers(min(kept(out), evaluations - 1), evaluations)), way)
        children = _kill(process, way, moment, found, out)
        code = process.wait()
        found.left_running += _left(children)
        if code == 0:
            found.ended += 1
            found.different += tables(out) != expected
            shutil.rmtree(out)
        else:
            found.codes[code] += 1
            if code not in OF_KILLS:
                found.odd.append(said(file).read_text(encoding="utf-8", errors="replace")[-1000:])
    process = start(file, out)  # the last one is left to its end
    found.codes[process.wait()] += 0
    found.ended += 1
    found.different += tables(out) != expected
    return found


def kept(out: Path) -> int:
    """How many evaluations have results."""
    return len(Store(out / RESULTS).addresses())


def _wait(process: subprocess.Popen[bytes], out: Path, count: int, way: str) -> None:
    """Until so many results are there, and a worker where one is to be killed; no longer than the run takes."""
    while process.poll() is None and (kept(out) < count or (way.startswith("worker") and not _workers(process))):
        time.sleep(0.02)


def _workers(process: subprocess.Popen[bytes]) -> list[psutil.Process]:
    try:
        children = psutil.Process(process.pid).children(recursive=True)
    except psutil.NoSuchProcess:
        return []
    return [each for each in children if "spawn_main" in " ".join(_words(each))]


def _left(children: list[psutil.Process]) -> int:
    """How many do not end though they had the time to."""
    began = time.perf_counter()
    taken = {each: _seconds(each) for each in children}
    alive = psutil.wait_procs(children, GONE)[1]
    while alive and time.perf_counter() - began < MOST and any(_seconds(each) - taken[each] < GIVEN for each in alive):
        alive = psutil.wait_procs(alive, 1.0)[1]
    return len(alive)


def _seconds(process: psutil.Process) -> float:
    """Of a core, taken so far; infinite for one that has ended."""
    try:
        return sum(process.cpu_times()[:2])
    except psutil.Error:
        return np.inf


def _kill(process: subprocess.Popen[bytes], way: str, after: float, found: Killed, out: Path) -> list[psutil.Process]:
    """Kill in that way after so many seconds, unless it has ended; its children at that moment."""
    try:
        process.wait(after)
        return []
    except subprocess.TimeoutExpired:
        pass
    try:
        children = psutil.Process(process.pid).children(recursive=True)
    except psutil.NoSuchProcess:
        return []
    if way.startswith("study"):
        process.send_signal(signal.SIGTERM if "TERM" in way else signal.SIGKILL)
    else:
        workers = _workers(process)
        if not workers:
            return []
        workers[0].kill()
    found.kills[way] += 1
    found.kept.append(kept(out))
    return children if way.startswith("study") else []


def _words(process: psutil.Process) -> list[str]:
    try:
        return process.cmdline()
    except psutil.Error:
        return []


def main() -> None:
    """So many kills, and what came of them."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--kills", type=int, default=50)
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--minutes", type=float, default=60.0)
    parser.add_argument("--chain", action="store_true", help="a study of three steps")
    asked = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        started = time.perf_counter()

        def tell(found: Killed) -> None:
            name = f"cohort_kills_chain_{asked.seed}" if asked.chain else "cohort_kills"
            write_results(name, vars(asked), figures(found, started), PACKAGES)

        file = made(folder, TRIALS // len(STEPS)) if asked.chain else prepare(folder)
        of_chain = TRIALS if asked.chain else 0
        tell(disturb(file, folder, asked.kills, asked.seed, tell, 60.0 * asked.minutes, of_chain))


def figures(found: Killed, started: float) -> dict[str, object]:
    """What the file of results holds."""
    return {
        "kills": dict(found.kills),
        "runs_to_the_end": found.ended,
        "with_other_tables": found.different,
        "processes_left_running": found.left_running,
        "exit_codes_of_killed": {str(code): count for code, count in found.codes.items()},
        "ended_with_an_error": found.odd,
        "trials": TRIALS,
        "kills_with_some_results": sum(0 < count < TRIALS for count in found.kept),
        "results_at_kills": sorted(found.kept),
        "seconds": round(time.perf_counter() - started),
    }


if __name__ == "__main__":
    main()
