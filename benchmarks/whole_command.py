"""Whole commands: what a user waits for, in a process of its own, warm and on one core.

The `area` command on a pair is here; `benchmarks.gap.speed` has the diagnosis of gaps.

Interpreter, imports, reading, both bodies' maps, refined areas with bounds, areas at 13 further thresholds, exact least
distance and depth of every frame, table, figures and page.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from benchmarks.pairs import ROOT, THRESHOLD, Pair
from geocontact.geometry.surface import Surface
from meshes.stl import stl_bytes

HEAD = "time [s],tx [mm],ty [mm],tz [mm],qw,qx,qy,qz"

PROGRAM = """
import json, sys, time
from importlib import import_module
from geocontact.cli.main import run

taken = {}

def timed(where, name, what):
    module, _, inside = where.partition(":")
    owner = import_module(module)
    owner = getattr(owner, inside) if inside else owner
    function, depth = getattr(owner, name), []

    def call(*args, **named):
        depth.append(0)
        start = time.process_time()
        try:
            return function(*args, **named)
        finally:
            depth.pop()
            if not depth:
                taken[what] = taken.get(what, 0.0) + time.process_time() - start

    setattr(owner, name, call)

if __name__ == "__main__":  # processes of a study import this file
    for each in json.loads(sys.argv[1]):
        timed(*each)
    code = run(sys.argv[2:])
    taken["all"] = time.process_time()
    sys.stderr.write("\\n" + json.dumps(taken) + "\\n")
    sys.exit(code)
"""

AREA = (
    ("geocontact.analyses.area.bodies", "read_body_and_outer", "reading"),
    ("geocontact.analyses.area.result", "area_evolution", "frames"),
    ("geocontact.analyses.frame.pages", "save_both", "figures"),
    ("geocontact.analyses.frame.pages", "write_finished", "page"),
)
"""What is timed of `area`: module, or module:class; function; what it is called."""


@dataclass(frozen=True)
class Whole:
    """CPU seconds of the command and of its parts, one entry per run."""

    all: list[float]
    parts: dict[str, list[float]]


def whole_command(pair: Pair, rounds: int) -> Whole:
    """Run it once to load every cache and then `rounds` times."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = words_of(pair, Path(folder))
        runs = [once(arguments, AREA) for _ in range(rounds + 1)]
    parts = {name: [run[name] for run in runs[1:]] for name in runs[0] if name != "all"}
    return Whole([run["all"] for run in runs[1:]], parts)


def words_of(pair: Pair, folder: Path) -> list[str]:
    """The pair as files, and the words of the command."""
    for name, body in (("moving", pair.moving), ("fixed", pair.fixed)):
        (folder / f"{name}.stl").write_bytes(_stl(body, name))
    turns = Rotation.from_matrix(pair.rotation).as_quat(scalar_first=True)
    time = 0.01 * np.arange(len(turns))
    rows = np.column_stack([time, 1e3 * pair.translation, turns])
    np.savetxt(folder / "motion.csv", rows, "%.12f", ",", header=HEAD, comments="")
    bodies = [str(folder / "moving.stl"), str(folder / "fixed.stl")]
    options = ["--unit", "mm", "--motion", str(folder / "motion.csv"), "--threshold", f"{1e3 * THRESHOLD:g}"]
    return ["area", *bodies, *options, "--workers", "1", "--out", str(folder / "result")]


def _stl(body: Surface, name: str) -> bytes:
    return stl_bytes(1e3 * body.vertices, body.faces, name)


def once(arguments: Sequence[str], parts: Sequence[tuple[str, str, str]]) -> dict[str, float]:
    """CPU seconds of one run of the command line `arguments`, "all", and of those of `parts` that were called."""
    command = [sys.executable, "-c", PROGRAM, json.dumps(parts), *arguments]
    done = subprocess.run(command, cwd=ROOT, env=dict(os.environ), capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    found: dict[str, float] = json.loads(done.stderr.strip().splitlines()[-1])
    return found
