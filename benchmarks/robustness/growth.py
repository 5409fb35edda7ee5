"""How commands grow with their input: `nice python -m benchmarks.robustness.growth FOLDER --only COMMAND …`.

Without `--only` all of them are run, half a CPU hour. Synthetic inputs of four sizes for each command; CPU seconds
and peak memory of a process of its own, on one thread, kernels compiled before. Slopes are those of a straight line
through the logarithms of the larger three sizes, after what the smallest takes has been subtracted, the program with
it: 1 where each further row costs the same. Writes results/growth.json after each command, in which commands that were
not run stay as they were, and prints the table of docs/reference/speed.md.
"""

from __future__ import annotations

import argparse
import json
import re
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import write_results
from benchmarks.robustness import growth_inputs as more
from benchmarks.robustness.growth_inputs import MESHES, ROOT, rows_of, run
from meshes.simple_shapes import sphere
from meshes.stl import stl_bytes

KEPT = ROOT / "benchmarks" / "results" / "growth.json"
TILES = 10  # turns of a recording whose noise differs


@dataclass(frozen=True)
class Run:
    """One command on an input of `n` rows, frames or faces."""

    command: str
    n: int
    cpu_s: float
    peak_mb: float
    output_mb: float
    page_mb: float


def loadcells(folder: Path, n: int) -> list[str]:
    """Four cells at 100 Hz, a step each second."""
    parts = np.array([0.35, 0.25, 0.2, 0.2])

    def made(k: np.ndarray) -> np.ndarray:
        time_ = 0.01 * k
        loads = [900.0 * one * np.abs(np.sin(np.pi * time_ + 0.1 * i)) for i, one in enumerate(parts)]
        return np.column_stack([time_, *loads])

    rows_of(folder / "cells.csv", "time [s],PM [N],AM [N],AL [N],PL [N]", n, made, "%.9g")
    return ["loadcells", "cells.csv"]


def cop(folder: Path, n: int) -> list[str]:
    """The foot of docs/how-to/cop.md, that tilts from heel to toe and back in 2 s, at 1000 Hz."""
    spheres = "px [m], py [m], pz [m], radius [m]\n0.00, 0.012, 0.00, 0.012\n0.16, 0.012, -0.03, 0.012\n"
    (folder / "spheres.csv").write_text(spheres + "0.16, 0.012, 0.03, 0.012\n0.22, 0.012, 0.00, 0.012\n", "utf-8")

    def made(k: np.ndarray) -> np.ndarray:
        tilt = 2.0 * np.cos(np.pi * 1e-3 * k)
        zero = np.zeros(len(k))
        return np.column_stack([1e-3 * k, zero, -6.0 - 1.92 * tilt, zero, zero, zero, tilt])

    rows_of(folder / "foot.csv", "time [s],tx [mm],ty [mm],tz [mm],rx [deg],ry [deg],rz [deg]", n, made, "%.9g")
    law = ["--stiffness", "8e4", "--exponent", "1.2", "--damping", "0", "--friction", "0,0"]
    return ["cop", "spheres.csv", "--motion", "foot.csv", "--order", "XYZ", *law]


def mat(folder: Path, n: int) -> list[str]:
    """The sample of the thigh, 16 x 8 cells at 50 Hz, over and over; 0.05 kPa of noise (seed 58) in ten turns."""
    sample = MESHES / "mat_thigh_16x8"
    lines = (sample / "frames.csv").read_text(encoding="utf-8").splitlines()
    head = next(k for k, line in enumerate(lines) if line.startswith("time"))
    given = np.array([[float(each) for each in line.split(",")] for line in lines[head + 1 :]])
    values = np.tile(given[:, 1:], (TILES, 1))
    values += 0.05 * np.random.default_rng(58).standard_normal(values.shape) * (values > 0.0)
    texts = [",".join(f"{each:.7g}" for each in row) for row in values]
    with (folder / "frames.csv").open("w", encoding="utf-8") as stream:
        stream.write("\n".join(lines[: head + 1]) + "\n")
        stream.writelines(f"{0.02 * k:.7g},{texts[k % len(texts)]}\n" for k in range(n))
    surface = ["--surface", str(MESHES / "thigh.stl"), "--unit", "mm"]
    places = ["--layout", str(sample / "layout.toml"), "--landmarks", str(sample / "landmarks.csv")]
    return ["mat", "frames.csv", *places, *surface]


def insole(folder: Path, n: int) -> list[str]:
    """A mat of 4 x 4 cells on a plate, at 100 Hz: a press each second that wanders, 0.1 kPa of noise (seed 58)."""
    (folder / "layout.toml").write_text('rows = 4\ncolumns = 4\npitch_mm = 10\nunit = "kPa"\norder = "row"\n', "utf-8")
    marks = "a,0,0,20,30,0\nb,4,0,60,30,0\nc,0,4,20,70,0\nd,4,4,60,70,0\n"
    (folder / "landmarks.csv").write_text(f"id, row, column, x [mm], y [mm], z [mm]\n{marks}", "utf-8")
    corners = [f"v {x} {y} 0" for x in range(0, 101, 20) for y in range(0, 101, 20)]
    at = [6 * a + b + 1 for a in range(5) for b in range(5)]
    halves = [f"f {k} {k + 6} {k + 7}\nf {k} {k + 7} {k + 1}" for k in at]
    (folder / "plate.obj").write_text("\n".join([*corners, *halves]) + "\n", "utf-8")
    row, column = np.divmod(np.arange(16), 4)
    noise = np.random.default_rng(58)

    def made(k: np.ndarray) -> np.ndarray:
        time_ = 0.01 * k[:, None]
        place = 1.5 + np.sin(0.7 * time_)
        press = 40.0 * np.abs(np.sin(np.pi * time_)) * np.exp(-((row - place) ** 2) - 0.3 * (column - 1.5) ** 2)
        return np.column_stack([time_, press + 0.1 * noise.standard_normal(press.shape)])

    rows_of(folder / "frames.csv", ",".join(["time [s]", *map(str, range(1, 17))]), n, made, "%.7g")
    places = ["--layout", "layout.toml", "--landmarks", "landmarks.csv"]
    return ["mat", "frames.csv", *places, "--surface", "plate.obj", "--unit", "mm"]


def area(folder: Path, n: int) -> list[str]:
    """Frames of the shipped coarse knee: the sample of a gait cycle over and over."""
    lines = (MESHES / "gait.csv").read_text(encoding="utf-8").splitlines()
    head = next(k for k, line in enumerate(lines) if line.startswith("time"))
    given = np.array([[float(each) for each in line.split(",")] for line in lines[head + 1 :]])

    def made(k: np.ndarray) -> np.ndarray:
        return np.column_stack([0.01 * k, given[k % len(given), 1:]])

    rows_of(folder / "motion.csv", "\n".join(lines[: head + 1]), n, made, "%.9g")
    bodies = [str(MESHES / f"{name}_right_coarse.stl") for name in ("femoral_component", "tibial_insert")]
    return ["area", *bodies, "--unit", "mm", "--motion", "motion.csv", "--workers", "1"]


def balls(folder: Path, n: int) -> list[str]:
    """One pose of two balls of n faces each, of 18 and 20 mm, 0.5 mm apart."""
    for radius in (18, 20):
        ball(folder, n, radius)
    pose = "time [s],tx [mm],ty [mm],tz [mm],rx [deg],ry [deg],rz [deg]\n0,0,38.5,0,0,0,0\n"
    (folder / "motion.csv").write_text(pose, "utf-8")
    options = ["--unit", "mm", "--motion", "motion.csv", "--order", "XYZ", "--workers", "1"]
    return ["area", "ball18.stl", "ball20.stl", *options]


def ball(folder: Path, n: int, radius: int = 20) -> list[str]:
    """A ball of about n faces."""
    vertices, faces = sphere(float(radius), round((n / 20) ** 0.5))
    (folder / f"ball{radius}.stl").write_bytes(stl_bytes(vertices, faces, "ball"))
    return ["fit", f"ball{radius}.stl", "--shape", "sphere", "--unit", "mm"]


def swing(folder: Path, n: int) -> list[str]:
    """The sample of a swinging leg over and over, at 100 Hz."""
    lines = (MESHES / "leg_swing.mot").read_text(encoding="utf-8").splitlines()
    head = lines.index("endheader")
    given = np.array([[float(each) for each in line.split()] for line in lines[head + 2 :]])

    def made(k: np.ndarray) -> np.ndarray:
        return np.column_stack([0.01 * k, given[k % (len(given) - 1), 1:]])

    top = [f"nRows={n}" if line.startswith("nRows") else line for line in lines[: head + 2]]
    rows_of(folder / "swing.mot", "\n".join(top), n, made, "%.9g", "\t")
    return ["markers", "swing.mot", "--model", str(MESHES / "leg.osim")]


def ik(folder: Path, n: int) -> list[str]:
    """Its 16 markers."""
    run(folder, [*swing(folder, n), "--out", "virtual"])
    return ["ik", "virtual/markers.trc", "--model", str(MESHES / "leg.osim")]


def joint(folder: Path, n: int) -> list[str]:
    """The axis of the knee from its markers."""
    run(folder, [*swing(folder, n), "--out", "virtual"])
    markers = ["--first", "femur_r0,femur_r1,femur_r2", "--second", "tibia_r0,tibia_r1,tibia_r2"]
    return ["joint", "virtual/markers.trc", "--axis", *markers]


def inverse_dynamics(folder: Path, n: int) -> list[str]:
    """Its coordinates."""
    return ["id", *swing(folder, n)[1:]]


COMMANDS: dict[str, tuple[Callable[[Path, int], list[str]], tuple[int, ...]]] = {
    "loadcells": (loadcells, (1_000, 10_000, 100_000, 1_000_000)),
    "cop": (cop, (1_000, 10_000, 100_000, 1_000_000)),
    "mat": (mat, (1_000, 10_000, 40_000, 100_000)),
    "mat, 16 cells": (insole, (10_000, 40_000, 90_000, 360_000)),
    "area": (area, (11, 101, 303, 1_010)),
    "area, faces": (balls, (2_000, 8_000, 32_000, 128_000)),
    "fit": (ball, (2_000, 8_000, 32_000, 128_000)),
    "markers": (swing, (1_000, 10_000, 30_000, 100_000)),
    "joint": (joint, (300, 1_000, 3_000, 10_000)),
    "ik": (ik, (300, 1_000, 3_000, 10_000)),
    "id": (inverse_dynamics, (1_000, 4_000, 10_000, 40_000)),
    "pairs": (more.pairs, (11, 31, 101, 303)),
    "settle-pairs": (more.settle_pairs, (3, 12, 48, 192)),
    "knee settle": (more.knee_settle, (3, 11, 31, 101)),
    "modulus": (more.modulus, (100, 1_000, 10_000, 100_000)),
    "scale": (more.scale, (100, 1_000, 10_000, 40_000)),
    "elbow simulate": (more.elbow_simulate, (1_000, 10_000, 40_000, 100_000)),
    "elbow fit": (more.elbow_fit, (1_000, 10_000, 40_000, 100_000)),
    "shoulder simulate": (more.shoulder_simulate, (200, 800, 2_400, 8_000)),
    "shoulder compare": (more.shoulder_compare, (800, 8_000, 40_000, 100_000)),
    "prosthesis simulate": (more.prosthesis_simulate, (97, 200, 400, 800)),
    "sit-to-stand predict": (more.standing_predict, (10, 20, 40, 80)),
    "sit-to-stand calibrate": (more.standing_calibrate, (10, 15, 20, 30)),
    "cohort": (more.cohort, (2, 6, 18, 54)),
}
"""Inputs of each command, and their sizes: rows, frames, faces, samples, nodes or subjects."""


def measured(command: str, n: int, folder: Path) -> Run:
    """One run in a process of its own, its results weighed."""
    folder.mkdir(parents=True, exist_ok=True)
    cpu, peak = run(folder, [*COMMANDS[command][0](folder, n), "--out", "out"])
    sizes = {each: each.stat().st_size / 1e6 for each in (folder / "out").rglob("*") if each.is_file()}
    page = max(size for each, size in sizes.items() if each.name == "report.html")
    return Run(command, n, round(cpu, 2), round(peak, 1), round(sum(sizes.values()), 2), round(page, 3))


def slope(sizes: Sequence[int], values: Sequence[float]) -> float:
    """Of a line through the logarithms of sizes and values beyond the first ones; NaN where nothing is added."""
    n, more = np.array(sizes[1:]) - sizes[0], np.array(values[1:]) - values[0]
    return float(np.polyfit(np.log(n), np.log(more), 1)[0]) if (more > 0.0).all() else float("nan")


def table(runs: Sequence[Run]) -> list[dict[str, object]]:
    """For each command: its runs, the slopes of CPU time and of memory, and memory for each further row [kB]."""
    found: list[dict[str, object]] = []
    for command in dict.fromkeys(one.command for one in runs):
        own = [one for one in runs if one.command == command]
        sizes = [run.n for run in own]
        memory = (own[-1].peak_mb - own[0].peak_mb) / (sizes[-1] - sizes[0]) * 1e3
        found.append(
            {
                "command": command,
                "runs": [asdict(run) for run in own],
                "cpu_slope": slope(sizes, [run.cpu_s for run in own]),
                "memory_slope": slope(sizes, [run.peak_mb for run in own]),
                "memory_kb_each": round(memory, 3),
            }
        )
    return found


COLUMNS = {"n": "{}", "cpu_s": "{:.1f}", "peak_mb": "{:.0f}"}


def lines(found: Sequence[Mapping[str, Any]]) -> list[str]:
    """The table of the page: what the four sizes take, one after the other."""
    head = ["| command | sizes | CPU s | peak MB | slopes: CPU/memory |", "|---|---|---|---|---|"]
    for each in found:
        runs = each["runs"]
        cells = ["/".join(form.format(run[key]) for run in runs) for key, form in COLUMNS.items()]
        cells.append(f"{_two(each['cpu_slope'])}/{_two(each['memory_slope'])}")
        head.append(f"| `{each['command']}` | {' | '.join(cells)} |")
    return head


def _two(value: float | None) -> str:
    return "–" if value is None or not np.isfinite(value) else f"{value:.2f}"


def main() -> None:
    """Run all, or those that are named, and keep the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="*", choices=COMMANDS, default=list(COMMANDS))
    parser.add_argument("--largest", type=int, default=sys.maxsize, help="of the sizes; larger ones are left out")
    given = parser.parse_args()
    for command in given.only:
        runs = []
        for n in (size for size in COMMANDS[command][1] if size <= given.largest):
            runs.append(measured(command, n, given.folder.resolve() / f"{re.sub('[ ,]+', '_', command)}_{n}"))
            print(json.dumps(asdict(runs[-1])), flush=True)
        kept = keep(command, runs, given.largest)
    print("\n".join(lines(kept)))


def keep(command: str, runs: Sequence[Run], largest: int) -> list[Mapping[str, Any]]:
    """Write the figures with those of a command in place of its earlier ones; all of them, in the order of the page."""
    before = json.loads(KEPT.read_text(encoding="utf-8"))["figures"] if KEPT.exists() else []
    others = [Run(**one) for each in before if each["command"] != command for one in each["runs"]]
    found: dict[object, Mapping[str, Any]] = {each["command"]: each for each in table([*others, *runs])}
    ordered = [found[each] for each in COMMANDS if each in found]
    asked = {"largest": largest if largest < sys.maxsize else None}
    print(write_results("growth", asked, ordered, {"numpy", "pandas", "scipy", "numba"}))
    return ordered


if __name__ == "__main__":
    main()
