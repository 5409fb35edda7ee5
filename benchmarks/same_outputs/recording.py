"""Every run of `runs.txt` in a child process of a checkout; results, words and exit codes in a folder."""

from __future__ import annotations

import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import time
from collections.abc import Iterable, Iterator, Mapping
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from benchmarks.machine import git
from benchmarks.same_outputs.inputs import make
from geocontact.analyses.catalogue import Entry

ROOT = Path(__file__).resolve().parents[2]
RUNS = Path(__file__).with_name("runs.txt")
ENTRY = re.compile(r"^(\w+)(?: \[(\w+)\])?:((?:.*)(?:\n[ \t]+\S.*)*)", re.MULTILINE)
PRINT_ONLY = ("view", "doctor", "--help")
"""First arguments of runs that write no results."""
SET = {
    "PYTHONHASHSEED": "0",  # sums over sets come in one order
    "OMP_NUM_THREADS": "1",
    "OPENBLAS_NUM_THREADS": "1",
    "MKL_NUM_THREADS": "1",
    "MPLBACKEND": "Agg",
    "BROWSER": "true",  # `view` opens nothing
    "COLUMNS": "100",
    "NO_COLOR": "1",
    "LC_ALL": "C.UTF-8",
    "TZ": "UTC",
}
"""Environment of the child processes, over that of this one."""


@dataclass(frozen=True)
class Run:
    """A call of the command line, and runs whose results it reads."""

    name: str
    arguments: tuple[str, ...]
    needs: tuple[str, ...]


@dataclass(frozen=True)
class Place:
    """Where runs are done: in the folder of a recording, by the cli.py of a checkout."""

    folder: Path
    checkout: Path

    def python(self, *arguments: str) -> subprocess.CompletedProcess[str]:
        """A child process of this interpreter that finds the package in the checkout."""
        kept = {key: value for key, value in os.environ.items() if not key.startswith("PYTHON")}
        environment = kept | SET | {"PYTHONPATH": str(self.checkout)}
        command = [sys.executable, *arguments]
        said = {"capture_output": True, "encoding": "utf-8"}
        return subprocess.run(command, cwd=self.folder, env=environment, check=False, **said)

    def done(self, run: Run) -> tuple[int, float]:
        """Exit code and seconds of a run; what it said is kept beside its results."""
        home, began = self.folder / run.name, time.perf_counter()
        shutil.rmtree(home, ignore_errors=True)
        home.mkdir()
        child = self.python(str(self.checkout / "cli.py"), *run.arguments)
        for name, text in (("stdout.txt", child.stdout), ("stderr.txt", child.stderr)):
            (home / name).write_text(text, encoding="utf-8")
        call = {"arguments": run.arguments, "code": child.returncode}
        (home / "call.json").write_text(json.dumps(call, indent=1) + "\n", encoding="utf-8")
        return child.returncode, time.perf_counter() - began

    def about(self) -> dict[str, str]:
        """Commit and places; SystemExit where the package would come from elsewhere."""
        found = self.python("-c", "import geocontact; print(geocontact.__file__)").stdout.strip()
        if self.checkout not in Path(found).resolve().parents:
            sys.exit(f"geocontact would be imported from {found}, not from {self.checkout}")
        commit = git(self.checkout, "describe", "--always", "--dirty", "--abbrev=7")
        return {"commit": commit or "unknown", "folder": str(self.folder), "checkout": str(self.checkout)}


def runs(text: str) -> dict[str, Run]:
    """Runs by name, those first whose results others read."""
    entries = {name: (other, shlex.split(words)) for name, other, words in ENTRY.findall(text)}
    found: dict[str, Run] = {}

    def add(name: str) -> None:
        other, arguments = entries[name]
        read = [match for word in arguments for match in re.findall(r"(?:^|=)(\w+)/out\b", word)]
        needs = dict.fromkeys([*read, *([other] if other else [])])
        for one in needs:
            if one not in found:
                add(one)
        out = [] if arguments[0] in PRINT_ONLY else ["--out", f"{name}/out"]
        found[name] = Run(name, (*arguments, *out), tuple(needs))

    for name in entries:
        if name not in found:
            add(name)
    return found


def first_run(every: Iterable[Run], entry: Entry) -> str:
    """Name of the first run of an analysis as the table has them, "" where there is none."""
    return next((run.name for run in every if entry.calls(run.arguments)), "")


def wanted(every: Mapping[str, Run], only: Iterable[str]) -> list[Run]:
    """Those named and those they read, all where none is named; SystemExit for a name that is not there."""
    chosen, waiting = set(), list(only) or list(every)
    while waiting:
        name = waiting.pop()
        if name not in every:
            sys.exit(f"no run {name!r}; there are {', '.join(every)}")
        chosen.add(name)
        waiting += every[name].needs
    return [run for name, run in every.items() if name in chosen]


def worked(chosen: Iterable[Run], place: Place, jobs: int) -> Iterator[tuple[Run, int, float]]:
    """Runs in their order with exit codes and seconds, each after those that it reads."""
    with ThreadPoolExecutor(jobs) as pool:
        waiting: dict[str, Future[tuple[int, float]]] = {}

        def after(run: Run) -> tuple[int, float]:
            for name in run.needs:
                waiting[name].result()
            return place.done(run)

        chosen = list(chosen)
        for run in chosen:
            waiting[run.name] = pool.submit(after, run)
        for run in chosen:
            yield run, *waiting[run.name].result()


def record(folder: Path, checkout: Path, only: Iterable[str], jobs: int) -> int:
    """Make the inputs and do the runs, a line for each; other runs that are there stay."""
    place, began = Place(folder.resolve(), checkout.resolve()), time.perf_counter()
    chosen = wanted(runs(RUNS.read_text("utf-8")), only)
    make(place.folder / "inputs", ROOT / "meshes")
    about = place.about()
    (place.folder / "recording.json").write_text(json.dumps(about, indent=1) + "\n", encoding="utf-8")
    ended = 0
    for run, code, seconds in worked(chosen, place, jobs):
        ended += code == 0
        print(f"{run.name}: exit {code}, {seconds:.1f} s", flush=True)
    took = time.perf_counter() - began
    print(f"{len(chosen)} runs of {about['commit']} in {took:.0f} s, {ended} of them ended with exit code 0")
    return 0
