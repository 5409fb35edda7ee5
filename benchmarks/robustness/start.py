"""What each command imports before it reads a file: `python -m benchmarks.robustness.start [COMMAND ...]`.

CPU seconds of a process of its own that imports the command line and the job of a command, as `geocontact COMMAND` does
before it reads, less those of an empty interpreter; the least of the rounds, since others on the machine only add. With
each stand the packages that take a tenth of a second each, and as its floor what numpy and they take alone, in the same
minute. What a job imports while it runs, such as what draws, is not counted. Modules are compiled beforehand, as `pip`
leaves them, also where Python is asked to keep no bytecode. Writes results/start.json.
"""

from __future__ import annotations

import argparse
import compileall
import os
import subprocess
import sys
from collections.abc import Sequence
from typing import Any

from benchmarks.machine import ROOT, write_results
from geocontact.analyses.catalogue import ENTRIES

AIM = 0.6  # CPU s
HEAVY = (
    "casadi",
    "igl",
    "matplotlib",
    "numba",
    "pandas",
    "scipy.integrate",
    "scipy.interpolate",
    "scipy.optimize",
    "scipy.signal",
    "scipy.spatial",
    "scipy.stats",
    "trimesh",
    "xarray",
)
ALONE = ("numpy", "pandas", "numba", "scipy.spatial", "scipy.special", "scipy.optimize", "scipy.stats", "scipy.signal")
"""Measured each by itself, with what it imports: numpy among it."""
SELDOM = "import atexit, gc; gc.set_threshold(100_000); atexit.register(gc.freeze); "
"""What `collect_seldom` of the command line does, for packages by themselves."""
PROGRAM = """
import sys
from geocontact.cli.main import collect_seldom
collect_seldom()
from geocontact.analyses.catalogue import ENTRIES
next(each for each in ENTRIES if each.command == sys.argv[1]).load_job()
print(*sorted({each for each in sys.argv[2:] if each in sys.modules}))
"""


def cpu_seconds(program: str, words: Sequence[str] = ()) -> tuple[float, list[str]]:
    """CPU seconds of a process that runs a program, and the words that it prints; RuntimeError where it fails."""
    began = os.times()
    command = [sys.executable, "-c", program, *words]
    kept = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    done = subprocess.run(command, cwd=ROOT, env=kept, capture_output=True, text=True, check=False)
    ended = os.times()
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    took = ended.children_user + ended.children_system - began.children_user - began.children_system
    return took, done.stdout.split()


def started(command: str, rounds: int, empty: float) -> dict[str, Any]:
    """Least CPU seconds that the imports of a command take, those of its heavy packages alone, and which these are."""
    runs, alone = [], []
    heavy: list[str] = []
    for _ in range(rounds):
        runs.append(cpu_seconds(PROGRAM, (command, *HEAVY)))
        heavy = runs[0][1]
        alone.append(cpu_seconds(f"{SELDOM}import {', '.join(['numpy', *heavy])}")[0])
    return {
        "cpu_s": round(min(took for took, _ in runs) - empty, 2),
        "floor_s": round(min(alone) - empty, 2),
        "heavy": heavy,
    }


def main() -> None:
    """Measure all commands or those that are named, print and write."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.robustness.start", description=__doc__.splitlines()[0])
    parser.add_argument("commands", nargs="*", metavar="COMMAND")
    parser.add_argument("--rounds", type=int, default=2)
    asked = parser.parse_args()
    compileall.compile_dir(ROOT / "geocontact", quiet=1)
    names = asked.commands or [each.command for each in ENTRIES if each.command]
    found, empty = {}, min(cpu_seconds("")[0] for _ in range(asked.rounds))
    for name in names:
        found[name] = started(name, asked.rounds, empty)
        one = found[name]
        print(f"| `{name}` | {one['cpu_s']:.2f} | {one['floor_s']:.2f} | {' '.join(one['heavy'])} |", flush=True)
    quick = sum(each["cpu_s"] <= AIM for each in found.values())
    print(f"{quick} of {len(found)} within {AIM} CPU s")
    programs = {name: f"{SELDOM}import {name}" for name in ALONE}
    alone = {
        name: round(min(cpu_seconds(each)[0] for _ in range(asked.rounds)) - empty, 2)
        for name, each in programs.items()
    }
    print("alone: " + ", ".join(f"{name} {took:.2f}" for name, took in alone.items()))
    figures = {"aim_s": AIM, "alone_s": alone, "commands": found}
    write_results("start", {"rounds": asked.rounds}, figures, {"numpy", "scipy", "numba", "pandas"})


if __name__ == "__main__":
    main()
