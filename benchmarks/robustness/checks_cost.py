"""What the checks of inputs and results cost beside the whole command: `python -m
benchmarks.robustness.checks_cost FOLDER`.

The commands of docs/gallery.md, kernels compiled before: CPU seconds of the checks
of a recorded trial, of the test of fit, and of the whole process with its imports. Writes results/checks_cost.json.
"""

from __future__ import annotations

import argparse
import json
import os
import statistics
import subprocess
import sys
from pathlib import Path

from benchmarks.machine import write_results
from benchmarks.page_pictures.gallery import ROOT, Shown, entries
from benchmarks.whole_command import PROGRAM

CHECKS = (
    ("geocontact.trial_checks.table", "contradictions", "trial"),
    ("geocontact.trial_checks.mesh_checks", "surface_contradictions", "trial"),
    ("geocontact.identify.goodness_of_fit", "residual_test", "fit"),
    ("geocontact.analyses.frame.record:Record", "judge", "fit"),
)
"""What is timed: module, or module:class; function; what it is called."""
AIM = 0.03
"""Share of a command, in the median."""


def prepare(folder: Path) -> None:
    """A folder with the samples and a program `geocontact` that says at its end what it took."""
    (folder / "bin").mkdir(parents=True, exist_ok=True)
    (folder / "bin" / "timed.py").write_text(PROGRAM, encoding="utf-8")
    program = folder / "bin" / "geocontact"
    program.write_text(
        f'#!/bin/sh\nexec "{sys.executable}" "{folder}/bin/timed.py" \'{json.dumps(CHECKS)}\' "$@"\n', encoding="utf-8"
    )
    program.chmod(0o755)
    if not (folder / "meshes").exists():
        (folder / "meshes").symlink_to(ROOT / "meshes")


def taken(shown: Shown, folder: Path) -> dict[str, float]:
    """CPU seconds of the last command of a block: of the checks, and of all."""
    environment = os.environ | {"PYTHONPATH": str(ROOT), "PATH": f"{folder / 'bin'}{os.pathsep}{os.environ['PATH']}"}
    done = subprocess.run(
        ["bash", "-eu", "-c", shown.code], cwd=folder, env=environment, check=False, capture_output=True, text=True
    )
    figures = [json.loads(line) for line in done.stderr.splitlines() if line.startswith('{"') and '"all"' in line]
    if done.returncode or not figures:
        sys.exit(f"{shown.name}: exit {done.returncode}\n{done.stderr[-2000:]}")
    last: dict[str, float] = figures[-1]
    return last


def main() -> None:
    """Measure and write."""
    names = [one.name for one in entries()]
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.robustness.checks_cost", description=__doc__.splitlines()[0]
    )
    parser.add_argument("folder", type=Path, help="new folder of the runs")
    parser.add_argument("--only", nargs="+", default=names, choices=names, metavar="NAME")
    given = parser.parse_args()
    folder = given.folder.resolve()
    prepare(folder)
    rows = {}
    for one in entries():
        if one.name not in given.only:
            continue
        seconds = taken(one, folder)
        checks = sum(value for name, value in seconds.items() if name != "all")
        rows[one.name] = {**seconds, "share": checks / seconds["all"]}
        print(f"{one.name:24} {100 * rows[one.name]['share']:6.2f} %  {seconds}", flush=True)
    used = [row["share"] for row in rows.values() if len(row) > 2]
    figures = {"commands": rows, "median": statistics.median(used), "most": max(used), "aim": AIM}
    print(write_results("checks_cost", {"only": given.only}, figures))


if __name__ == "__main__":
    main()
