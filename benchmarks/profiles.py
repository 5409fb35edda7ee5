"""Where five slow commands spend their time: `python -m benchmarks.profiles [--only COMMAND …] [--functions]`.

Shipped and synthetic inputs, one core, a process each, warm. CPU seconds of parts, each without what it calls of
another: start (interpreter, imports, loading of machine code), reading, computing, figures, page; the rest is words,
tables and checks. With `--functions` each is run once more under cProfile, for those that take most themselves.
Writes results/profiles.json, in which commands that were not run stay; prints the table of docs/reference/peers.md.
"""

from __future__ import annotations

import argparse
import json
import os
import pstats
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.gap.speed import written
from benchmarks.machine import ROOT, write_results
from benchmarks.one_core import pin
from benchmarks.robustness import growth_inputs as made

KEPT = ROOT / "benchmarks" / "results" / "profiles.json"
PARTS = ("start", "reading", "computing", "figures", "page", "rest")
FIRST = 12
"""Functions of a profile that are kept."""

PARTED = """
import importlib._bootstrap as imports, json, os, sys, time
from functools import wraps

began = time.process_time()
spent, stack = {"start": began}, [["rest", began]]

def within(part, function):
    @wraps(function)
    def call(*args, **named):
        now = time.process_time()
        spent[stack[-1][0]] = spent.get(stack[-1][0], 0.0) + now - stack[-1][1]
        stack.append([part, now])
        try:
            return function(*args, **named)
        finally:
            now = time.process_time()
            spent[part] = spent.get(part, 0.0) + now - stack.pop()[1]
            stack[-1][1] = now
    return call

def job(kind):
    first = kind.__init__
    def init(self, command, options, read, run):
        first(self, command, options, within("reading", read), within("computing", run))
    kind.__init__ = init

def result(kind):
    first = kind.__init_subclass__.__func__
    def wrapped(cls):
        for name in {"figures", "pages"} & set(vars(cls)):
            setattr(cls, name, within(name.removesuffix("s") if name == "pages" else name, vars(cls)[name]))
    def sub(cls, **options):
        first(cls, **options)
        wrapped(cls)
    kind.__init_subclass__ = classmethod(sub)
    wrapped(kind)

def named(owner, name, part):
    setattr(owner, name, within(part, getattr(owner, name)))

waiting = {
    "geocontact.analyses.frame.job": lambda m: job(m.Job),
    "geocontact.analyses.frame.result": lambda m: result(m.Result),
    "geocontact.analyses.frame.pages": lambda m: [
        named(m, "save_both", "figures"), named(m, "drawing", "figures"), named(m, "write_finished", "page")],
    "geocontact.dynamics.machine_code": lambda m: named(m, "machine_code", "start"),
    "numba.core.caching": lambda m: named(m.Cache, "load_overload", "start"),
}
load = within("start", imports._find_and_load)

def found(*args):
    module = load(*args)
    for name in [each for each in waiting if each in sys.modules]:
        if not getattr(sys.modules[name].__spec__, "_initializing", False):
            waiting.pop(name)(sys.modules[name])
    return module

imports._find_and_load = found
if __name__ == "__main__":
    from geocontact.cli.main import run
    code = run(sys.argv[1:])
    now = time.process_time()
    spent["rest"] = spent.get("rest", 0.0) + now - stack[0][1]
    below = os.times()
    spent["processes"] = below.children_user + below.children_system
    sys.stderr.write("\\n" + json.dumps(spent) + "\\n")
    sys.exit(code)
"""
FUNCTIONS = """
import cProfile, sys, time
file = sys.argv.pop(1)
profile = cProfile.Profile(time.process_time)
profile.enable()
from geocontact.cli.main import run
code = run(sys.argv[1:])
profile.disable()
profile.dump_stats(file)
sys.exit(code)
"""


def diagnosis(folder: Path, _: int) -> list[str]:
    """An elbow of the benchmark's generator with one effect (seed 1)."""
    written(1, folder / "cases", ("elbow",), ("single",))
    return ["gap", "diagnose", "cases/elbow_single"]


COMMANDS: dict[str, tuple[Callable[[Path, int], list[str]], int]] = {
    "gap diagnose": (diagnosis, 0),
    "sit-to-stand predict": (made.standing_predict, 10),
    "knee settle": (made.knee_settle, 3),
    "prosthesis simulate": (made.prosthesis_simulate, 97),
    "modulus": (made.modulus, 100),
}
"""What makes the input of each command, and its size, as in `benchmarks.robustness.growth`."""


def seconds_of(words: Sequence[str], folder: Path) -> dict[str, float]:
    """CPU seconds of a command's parts and of its whole, in a process of its own."""
    said = _started([sys.executable, "-c", PARTED, *words], folder)
    found: dict[str, float] = json.loads(said.strip().splitlines()[-1])
    found["computing"] = found.get("computing", 0.0) + found.pop("processes")
    return {"whole": sum(found.values()), **{part: found.get(part, 0.0) for part in PARTS}}


def functions_of(words: Sequence[str], folder: Path) -> list[dict[str, Any]]:
    """Those of a profile that take most CPU seconds themselves, with the profiler's own cost."""
    _started([sys.executable, "-c", FUNCTIONS, "profile", *words], folder)
    stats: Mapping[tuple[str, int, str], tuple[int, int, float, float, Any]] = vars(
        pstats.Stats(str(folder / "profile"))
    )["stats"]
    largest = sorted(stats.items(), key=lambda each: each[1][2], reverse=True)[:FIRST]
    return [
        {"function": f"{_place(file)}:{name}", "calls": calls, "own_s": round(own, 3), "with_called_s": round(all_, 3)}
        for (file, _, name), (_, calls, own, all_, _) in largest
    ]


def _place(file: str) -> str:
    """A file without the folders of this machine."""
    text = file.replace(os.sep, "/")
    return text.rpartition("/site-packages/")[2].removeprefix(f"{ROOT.as_posix()}/").rpartition("/lib/")[2]


def _started(program: Sequence[str], folder: Path) -> str:
    environment = os.environ | {"PYTHONPATH": str(ROOT)}
    done = subprocess.run(program, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    if done.returncode:
        raise RuntimeError(done.stderr)
    return done.stderr


def profile(command: str, rounds: int, functions: bool) -> dict[str, Any]:
    """Medians of the parts over the rounds, after a run that fills the caches."""
    make, size = COMMANDS[command]
    with tempfile.TemporaryDirectory() as scratch:
        folder = Path(scratch)
        words = [*make(folder, size), "--out", "out"]
        runs = [seconds_of(words, folder) for _ in range(rounds + 1)][1:]
        parts = {part: round(float(np.median([run[part] for run in runs])), 3) for part in ("whole", *PARTS)}
        return {"cpu_s": parts, "rounds": rounds} | ({"functions": functions_of(words, folder)} if functions else {})


def lines(found: Mapping[str, Mapping[str, Any]]) -> list[str]:
    """The table of the page, slowest first."""
    rows = [f"| command | whole | {' | '.join(PARTS)} |", "|---" * (len(PARTS) + 2) + "|"]
    for command, each in sorted(found.items(), key=lambda one: -one[1]["cpu_s"]["whole"]):
        cells = [f"{each['cpu_s'][part]:.1f}" for part in ("whole", *PARTS)]
        rows.append(f"| `{command}` | {' | '.join(cells)} |")
    return rows


def main() -> None:
    """Profile all, or those that are named, and keep the figures."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.profiles", description=__doc__.splitlines()[0])
    parser.add_argument("--only", nargs="*", choices=COMMANDS, default=list(COMMANDS))
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--functions", action="store_true", help="also under cProfile")
    asked = parser.parse_args()
    pin()
    found = json.loads(KEPT.read_text(encoding="utf-8"))["figures"] if KEPT.exists() else {}
    for command in asked.only:
        found[command] = profile(command, asked.rounds, asked.functions)
        print(command, found[command]["cpu_s"], flush=True)
        write_results("profiles", {"rounds": asked.rounds}, found, {"numpy", "scipy", "numba", "pandas", "casadi"})
    print("\n".join(lines(found)))


if __name__ == "__main__":
    main()
