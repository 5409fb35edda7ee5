"""Whole commands of two commits on one machine: `python -m benchmarks.before_after --before 4c8c161 [--rounds 3]`.

Both commits are unpacked beside each other and run turn by turn on the same shipped and synthetic inputs, one core, a
process each: the first `area` after installation, which compiles kernels, then commands whose code is cached. CPU
seconds are of the whole process and what it waits for, with figures and page. Writes results/before_after.json, and
prints the table of docs/reference/peers.md.
"""

from __future__ import annotations

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np

from benchmarks.machine import ROOT, write_results
from benchmarks.one_core import pin
from benchmarks.profiles import COMMANDS

KEPT = ROOT / "benchmarks" / "results" / "before_after.json"
PROGRAM = "from geocontact.cli.main import main\nmain()\n"
FIRST, AREA = "area, first", "area, 101 frames"
KNEE = ("femoral_component_right_medium.stl", "tibial_insert_right_medium.stl")
Seconds = dict[str, dict[str, list[float]]]


def unpacked(commit: str, folder: Path) -> Path:
    """The files of a commit, without anything compiled."""
    archive = folder.with_suffix(".tar")
    subprocess.run(["git", "archive", "-o", str(archive), commit], cwd=ROOT, check=True)
    shutil.unpack_archive(archive, folder)
    return folder


def cpu_seconds(checkout: Path, words: Sequence[str], folder: Path) -> float:
    """Of a command of a checkout that starts in a folder; RuntimeError with what a failure says."""
    home = folder / "home"  # nobody else's: compiled code is kept there
    home.mkdir(mode=0o700, exist_ok=True)
    environment = os.environ | {"PYTHONPATH": str(checkout), "HOME": str(home), "XDG_CACHE_HOME": str(home)}
    with (folder / "said").open("wb") as said:
        streams = [(os.POSIX_SPAWN_DUP2, said.fileno(), each) for each in (1, 2)]
        program = [sys.executable, "-c", PROGRAM, *words]
        _, status, used = os.wait4(os.posix_spawn(sys.executable, program, environment, file_actions=streams), 0)
    if os.waitstatus_to_exitcode(status) not in (0, 1):  # 1: a result that is to be doubted
        raise RuntimeError((folder / "said").read_text(encoding="utf-8"))
    return used.ru_utime + used.ru_stime


def measured(checkouts: Mapping[str, Path], rounds: int, scratch: Path) -> Seconds:
    """CPU seconds of each command by commit; a run before the first round fills the caches."""
    knee = [*(str(ROOT / "meshes" / name) for name in KNEE), "--unit", "mm", "--threshold", "4"]
    jobs = {AREA: ["area", *knee, "--motion", str(ROOT / "meshes" / "gait.csv")]}
    for command, (make, size) in COMMANDS.items():
        (folder := scratch / command.replace(" ", "_")).mkdir()
        jobs[command] = make(folder, size)
    found: Seconds = {name: {} for name in (FIRST, *jobs)}
    for k, commit in enumerate(checkouts):
        found[FIRST][commit] = [_of(checkouts[commit], AREA, jobs[AREA], scratch, f"first{k}")]
    for name, words in jobs.items():
        for turn in range(rounds + 1):
            for k, commit in enumerate(checkouts):
                took = _of(checkouts[commit], name, words, scratch, f"out{k}_{turn}")
                if turn:
                    found[name].setdefault(commit, []).append(took)
        print(name, found[name], flush=True)
    return found


def _of(checkout: Path, name: str, words: Sequence[str], scratch: Path, out: str) -> float:
    folder = scratch / name.replace(" ", "_")
    folder.mkdir(exist_ok=True)
    there = Path.cwd()
    os.chdir(folder)
    try:
        return round(cpu_seconds(checkout, [*words, "--out", out], folder), 2)
    finally:
        os.chdir(there)


def lines(found: Seconds) -> list[str]:
    """The table of the page: medians, before and after."""
    rows = ["| command | before | after | ratio |", "|---|---|---|---|"]
    for name, own in found.items():
        before, after = (float(np.median(each)) for each in own.values())
        rows.append(f"| `{name}` | {before:.1f} | {after:.1f} | {before / after:.1f} |")
    return rows


def main() -> None:
    """Measure both, keep the figures, print the table."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.before_after", description=__doc__.splitlines()[0])
    parser.add_argument("--before", required=True, metavar="COMMIT")
    parser.add_argument("--after", default="HEAD", metavar="COMMIT")
    parser.add_argument("--rounds", type=int, default=3)
    asked = parser.parse_args()
    pin()
    with tempfile.TemporaryDirectory() as text:
        scratch = Path(text)
        checkouts = {name: unpacked(getattr(asked, name), scratch / name) for name in ("before", "after")}
        found = measured(checkouts, asked.rounds, scratch)
    settings = {"before": asked.before, "rounds": asked.rounds}
    write_results("before_after", settings, found, {"numpy", "scipy", "numba", "pandas", "casadi"})
    print("\n".join(lines(found)))


if __name__ == "__main__":
    main()
