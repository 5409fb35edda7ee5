"""How commands grow with their input: `nice python -m benchmarks.robustness.growth FOLDER`, 10 CPU minutes.

Synthetic inputs of four sizes for each command; CPU seconds and peak memory of a process of its own, on one thread,
kernels compiled before. A slope is that of a straight line through the logarithms of the larger three sizes, after
what the smallest takes has been subtracted: 1 where each further row costs the same. Writes results/growth.json,
in which commands that were not run stay as they were.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path

import numpy as np

from benchmarks.machine import write_results
from benchmarks.one_core import THREADS

ROOT = Path(__file__).resolve().parents[2]
MESHES = ROOT / "meshes"
KEPT = ROOT / "benchmarks" / "results" / "growth.json"
TILES = 10  # turns of a recording whose noise differs
CHUNK = 10_000  # rows that are made at a time


@dataclass(frozen=True)
class Run:
    """One command on an input of `n` rows, frames or faces."""

    command: str
    n: int
    cpu_s: float
    peak_mb: float
    output_mb: float
    page_mb: float


def rows_of(
    file: Path, head: str, n: int, made: Callable[[np.ndarray], np.ndarray], form: str, between: str = ","
) -> None:
    """A table of n rows, written in chunks; `made` gives the columns for numbers of rows."""
    with file.open("w", encoding="utf-8") as stream:
        stream.write(head + "\n")
        for start in range(0, n, CHUNK):
            np.savetxt(stream, made(np.arange(start, min(n, start + CHUNK))), form, between)


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


def inverse_dynamics(folder: Path, n: int) -> list[str]:
    """Its coordinates."""
    return ["id", *swing(folder, n)[1:]]


COMMANDS: dict[str, tuple[Callable[[Path, int], list[str]], tuple[int, ...]]] = {
    "loadcells": (loadcells, (1_000, 10_000, 100_000, 1_000_000)),
    "cop": (cop, (1_000, 10_000, 100_000, 1_000_000)),
    "mat": (mat, (1_000, 10_000, 100_000, 360_000)),
    "area": (area, (11, 101, 303, 1_010)),
    "markers": (swing, (1_000, 10_000, 30_000, 100_000)),
    "ik": (ik, (1_000, 10_000, 30_000, 100_000)),
    "id": (inverse_dynamics, (1_000, 10_000, 30_000, 100_000)),
}
"""Inputs of each command, and their sizes: rows or frames."""


def run(folder: Path, words: Sequence[str]) -> tuple[float, float]:
    """CPU seconds and peak memory [MB] of a command that starts in a folder; RuntimeError with what a failure says."""
    environment = os.environ | dict.fromkeys(THREADS, "1") | {"PYTHONPATH": str(ROOT)}
    program = f"import os, sys; os.chdir({str(folder)!r})\nfrom geocontact.cli.main import main\nmain()\n"
    with (folder / "said").open("wb") as said:
        streams = [(os.POSIX_SPAWN_DUP2, said.fileno(), each) for each in (1, 2)]
        child = os.posix_spawn(
            sys.executable, [sys.executable, "-c", program, *words], environment, file_actions=streams
        )
        _, status, used = os.wait4(child, 0)
    if status:
        raise RuntimeError((folder / "said").read_text(encoding="utf-8"))
    return used.ru_utime + used.ru_stime, used.ru_maxrss * 1024e-6


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
    """For each command: its runs, the slope of CPU time, and memory for each further row [kB]."""
    found: list[dict[str, object]] = []
    for command in dict.fromkeys(run.command for run in runs):
        own = [run for run in runs if run.command == command]
        sizes = [run.n for run in own]
        memory = (own[-1].peak_mb - own[0].peak_mb) / (sizes[-1] - sizes[0]) * 1e3
        found.append(
            {
                "command": command,
                "runs": [asdict(run) for run in own],
                "cpu_slope": slope(sizes, [run.cpu_s for run in own]),
                "memory_kb_each": round(memory, 3),
            }
        )
    return found


def main() -> None:
    """Run all, or those that are named, and keep the figures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--only", nargs="*", default=list(COMMANDS))
    parser.add_argument("--largest", type=int, default=sys.maxsize, help="of the sizes; larger ones are left out")
    given = parser.parse_args()
    runs = []
    for command in given.only:
        for n in (size for size in COMMANDS[command][1] if size <= given.largest):
            runs.append(measured(command, n, given.folder.resolve() / f"{command}_{n}"))
            print(json.dumps(asdict(runs[-1])), flush=True)
    before = json.loads(KEPT.read_text(encoding="utf-8"))["figures"] if KEPT.exists() else []
    found = {each["command"]: each for each in [*before, *table(runs)]}
    ordered = [found[command] for command in COMMANDS if command in found]
    print(write_results("growth", {"largest": given.largest}, ordered, {"numpy", "pandas", "scipy", "numba"}))


if __name__ == "__main__":
    main()
