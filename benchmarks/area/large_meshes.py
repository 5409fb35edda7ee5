"""The whole command `geocontact area` on two meshes of a million faces each: peak memory, CPU seconds, error.

`python -m benchmarks.area.large_meshes` writes results/large_meshes.json, with what the arrays of a body take
(`--only-held`: only that is measured anew). Two balls of 18 and 20 mm
(synthetic), 0.5 mm apart, one pose, threshold 4 mm: what a user types, with its figures and its page. The areas of
smooth balls are known (`tests.closed_forms`); those of balls made of triangles differ from them by the square of the
edge.
"""

from __future__ import annotations

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks.machine import as_json, stamp, write_results
from benchmarks.pairs import ROOT, THRESHOLD, Pair
from benchmarks.whole_command import words_of
from geocontact.geometry.surface import Surface
from meshes.simple_shapes import sphere
from tests import closed_forms as exact

RADII = (18.0, 20.0)  # mm
GAP = 0.5  # mm
HELD = 80_000  # faces of the ball whose arrays are weighed

PROGRAM = """
import json, sys, time
from benchmarks.area.memory import peak_of_this_process
from geocontact.cli.main import run

code = run(sys.argv[1:])
sys.stderr.write("\\n" + json.dumps([peak_of_this_process(), time.process_time()]) + "\\n")
sys.exit(code)
"""


def balls(faces: int) -> Pair:
    """The smaller one above the larger one, `faces` each or a little more."""
    cells = int(np.ceil((faces / 20) ** 0.5))
    made = (sphere(radius, cells) for radius in RADII)
    small, large = (Surface(1e-3 * v, np.ascontiguousarray(f, np.int64), f"ball of {len(f)} faces") for v, f in made)
    return Pair("balls", small, large, np.eye(3)[None], 1e-3 * np.array([[0.0, sum(RADII) + GAP, 0.0]]))


def measured(faces: int) -> dict[str, object]:
    """Once to load every cache, with small meshes, and once with `faces`."""
    with tempfile.TemporaryDirectory() as folder:
        _once(words_of(balls(2000), Path(folder)))
        pair = balls(faces)
        count = len(pair.moving.faces)
        arguments = words_of(pair, Path(folder))
        del pair
        peak, cpu = _once(arguments)
        row = pd.read_csv(Path(folder) / "result" / "area.csv").iloc[0]
    areas = {"moving": exact.sphere_sphere_on_first(*RADII, GAP, 1e3 * THRESHOLD)}
    areas["fixed"] = exact.sphere_sphere_on_first(*RADII[::-1], GAP, 1e3 * THRESHOLD)
    found = {f"relative_error_{body}": float(row[f"area_{body} [mm^2]"]) / area - 1.0 for body, area in areas.items()}
    return {"faces": count, "peak_MB": peak, "cpu_s": cpu} | found


def held(surface: Surface) -> dict[str, float]:
    """Bytes for each face of every array that a surface keeps while its frames are computed, the tree's with them."""
    bounds = surface.tree, surface.topology
    surface.normals_trusted, surface.face_area, surface.face_normal, surface.local  # noqa: B018 - kept once asked for
    named = [("surface", vars(surface)), *((type(each).__name__, _fields(each)) for each in bounds)]
    arrays = {f"{name}.{key}": each for name, own in named for key, each in own.items() if isinstance(each, np.ndarray)}
    found = {name: round(array.nbytes / len(surface.faces), 1) for name, array in arrays.items()}
    return {name: size for name, size in found.items() if size} | {"all": round(sum(found.values()), 1)}


def _fields(found: object) -> dict[str, object]:
    return found._asdict() if hasattr(found, "_asdict") else vars(found)


def _once(arguments: list[str]) -> tuple[float, float]:
    """Peak [MB] and CPU seconds of the command in a process of its own."""
    command = [sys.executable, "-c", PROGRAM, *arguments]
    done = subprocess.run(command, cwd=ROOT, env=dict(os.environ), capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise RuntimeError(done.stderr)
    peak, cpu = json.loads(done.stderr.strip().splitlines()[-1])
    return float(peak), float(cpu)


def main() -> None:
    """Measure and write."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--faces", type=int, default=1_000_000)
    parser.add_argument("--only-held", action="store_true", help="what each face takes; the rest stays as it is")
    asked = parser.parse_args()
    kept = ROOT / "benchmarks" / "results" / "large_meshes.json"
    before = json.loads(kept.read_text("utf-8")) if asked.only_held else {}
    figures = before["figures"] if asked.only_held else measured(asked.faces)
    figures["held"] = {**stamp(), "bytes_each_face": held(balls(HELD).moving)}
    if asked.only_held:
        kept.write_text(as_json(before), encoding="utf-8")
        return
    print(figures, write_results("large_meshes", vars(asked), figures, {"libigl", "matplotlib"}))


if __name__ == "__main__":
    main()
