"""Inputs of a chosen size for commands that take more than one table: made from the shipped samples, all synthetic."""

from __future__ import annotations

import os
import shutil
import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from jaxtyping import Float

from benchmarks.one_core import THREADS
from benchmarks.same_outputs.inputs.knee import LEVELS, MODULUS, RADIUS
from benchmarks.same_outputs.inputs.text import table
from benchmarks.study.leg_chain import made as leg_study

ROOT = Path(__file__).resolve().parents[2]
MESHES = ROOT / "meshes"
CHUNK = 10_000  # rows that are made at a time
TRIALS = 3  # recordings of the elbow
SEED = 58
RATE = 100.0  # Hz; of the samples
HEAD_OF_TRC, PLACES = 5, 2  # lines before the frames, and columns before the places
WALK = "gait_P1_medium_1"
FEMUR, INSERT = (str(MESHES / f"{name}_right_coarse.stl") for name in ("femoral_component", "tibial_insert"))
STAND = MESHES / "standing_up_exoskeleton"


def run(folder: Path, words: Sequence[str]) -> tuple[float, float]:
    """CPU seconds and peak memory [MB] of a command that starts in a folder; RuntimeError with what a failure says.

    What the command starts and waits for is among the seconds; the memory is that of the largest process.
    """
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


def rows_of(
    file: Path, head: str, n: int, made: Callable[[np.ndarray], np.ndarray], form: str, between: str = ","
) -> None:
    """A table of n rows, written in chunks; `made` gives the columns for numbers of rows."""
    with file.open("w", encoding="utf-8") as stream:
        stream.write(head + "\n")
        for start in range(0, n, CHUNK):
            np.savetxt(stream, made(np.arange(start, min(n, start + CHUNK))), form, between)


def there_and_back(n: int, rows: int) -> np.ndarray:
    """Numbers of n rows of a sample that is passed forwards and backwards: nothing jumps where it begins again."""
    turn = np.arange(n) % (2 * rows - 2)
    return np.minimum(turn, 2 * rows - 2 - turn)


def motion(file: Path, sample: str, n: int) -> None:
    """Poses of a shipped motion of 101 frames, forwards and backwards at 100 Hz."""
    lines = (MESHES / sample).read_text(encoding="utf-8").splitlines()
    given = np.array([[float(each) for each in line.split(",")] for line in lines[1:]])
    at = there_and_back(n, len(given))
    rows_of(file, lines[0], n, lambda k: np.column_stack([k / RATE, given[at[k], 1:]]), "%.12g")


def knee(folder: Path, n: int, sample: str) -> list[str]:
    """A shipped description of several bodies, its motions n frames long."""
    for name in ("gait.csv", "gait_patella.csv"):
        motion(folder / name, name, n)
    for name in ("femoral_component", "tibial_insert", "patella"):
        shutil.copy(MESHES / f"{name}_right_coarse.stl", folder)
    shutil.copy(MESHES / sample, folder)
    return [sample]


def pairs(folder: Path, n: int) -> list[str]:
    """Frames of the shipped knee with a patella."""
    return ["pairs", *knee(folder, n, "knee_pairs.toml"), "--workers", "1"]


def settle_pairs(folder: Path, n: int) -> list[str]:
    """Frames of the same that comes to rest."""
    return ["settle-pairs", *knee(folder, n, "resting_knee.toml")]


def knee_settle(folder: Path, n: int) -> list[str]:
    """Frames of the shipped coarse knee under 2000 N."""
    motion(folder / "gait.csv", "gait.csv", n)
    layer = ["--modulus", "463MPa", "--poisson", "0.46", "--region", "ny>0.25"]
    given = ["--motion", "gait.csv", "--side", "right", "--load", "2000"]
    return ["knee", "settle", FEMUR, INSERT, "--unit", "mm", *given, *layer]


def modulus(folder: Path, n: int) -> list[str]:
    """Frames of steps of 1.1 s at 100 Hz: areas at five thresholds with two humps, forces of the law and 20 N of noise.

    The noise is drawn with seed 58: a ripple that repeats would correlate over the whole recording.
    """
    time = np.arange(n) / RATE
    phase = np.pi * time / 1.1
    humps = 500.0 * np.sin(phase) ** 2 + 150.0 * np.sin(3.0 * phase) ** 2
    area = 600.0 + humps[:, None] + 250.0 * LEVELS
    columns = {"time [s]": np.repeat(time, len(LEVELS)), "threshold [mm]": np.tile(LEVELS, n)}
    table(folder / "area.csv", columns | {"area_fixed [mm^2]": area.ravel()})
    force = 4.0 / 3.0 * MODULUS * (1e-6 * area[:, 3] / np.pi) ** 1.5 / RADIUS
    force += 20.0 * np.random.default_rng(SEED).standard_normal(n)
    table(folder / "forces.csv", {"time [s]": time, "total [N]": force})
    return ["modulus", "--area", "area.csv", "--force", "forces.csv", "--radius-mm", "37"]


def scale(folder: Path, n: int) -> list[str]:
    """Frames of the shipped leg that stands: its markers in the first frame of the swing, all of them alike."""
    lines = (MESHES / "leg_swing.mot").read_text(encoding="utf-8").splitlines()
    head = lines.index("endheader")
    first = np.array([float(each) for each in lines[head + 2].split()])[1:]
    top = "\n".join(f"nRows={n}" if line.startswith("nRows") else line for line in lines[: head + 2])
    rows_of(
        folder / "still.mot", top, n, lambda k: np.column_stack([k / RATE, np.tile(first, (len(k), 1))]), "%.9g", "\t"
    )
    model = str(MESHES / "leg.osim")
    run(folder, ["markers", "still.mot", "--model", model, "--out", "virtual"])
    measured = ["--scale", "femur_r=femur_r0/femur_r2,femur_r1/femur_r3", "--scale", "tibia_r=tibia_r0/tibia_r2"]
    return ["scale", "virtual/markers.trc", "--model", model, "--mass", "30", *measured]


def elbow_simulate(folder: Path, n: int) -> list[str]:
    """Samples of each of three trials of a minute: the same movement at a higher rate."""
    return ["elbow", "simulate", "--rate", f"{n / 60.0:.9g}", "--trials", str(TRIALS), "--seed", str(SEED)]


def elbow_fit(folder: Path, n: int) -> list[str]:
    """The same trials."""
    run(folder, [*elbow_simulate(folder, n), "--out", "trials"])
    files = [f"trials/locked_{k + 1}.csv" for k in range(TRIALS)]
    return ["elbow", "fit", *files, "--known", "l=169,z=127"]


def trc(sample: Path, file: Path, n: int) -> None:
    """Markers of a sample, forwards and backwards at its 100 Hz."""
    lines = [line for line in sample.read_text(encoding="utf-8").splitlines() if line.strip()]
    given = np.array([[float(each) for each in line.split("\t")] for line in lines[HEAD_OF_TRC:]])
    _write_trc(file, lines, given[there_and_back(n, len(given)), PLACES:], np.arange(n) / RATE)


def _write_trc(
    file: Path, lines: Sequence[str], places: Float[np.ndarray, "n c"], time: Float[np.ndarray, " n"]
) -> None:
    """Places [mm] under the five header lines of a .trc file, whose counts and rate are those of the times [s]."""
    n, rate = len(time), f"{(len(time) - 1) / (time[-1] - time[0]):.9g}"
    kept = lines[2].split("\t")
    counts = "\t".join([rate, rate, str(n), kept[3], kept[4], rate, "1", str(n)])
    with file.open("w", encoding="utf-8") as stream:
        stream.write("\n".join([*lines[:2], counts, *lines[3:HEAD_OF_TRC]]) + "\n\n")
        columns = np.column_stack([np.arange(1, n + 1), time, places])
        np.savetxt(stream, columns, ["%d", "%.9g", *["%.4f"] * places.shape[1]], "\t")


def shoulder_simulate(folder: Path, n: int) -> list[str]:
    """Frames of the shipped overhead work, its right arm."""
    trc(MESHES / "overhead_P1T1S100" / "markers.trc", folder / "markers.trc", n)
    return ["shoulder", "simulate", "markers.trc", "--upright", "0:0.5", "--side", "right"]


def shoulder_compare(folder: Path, n: int) -> list[str]:
    """Frames of a simulated arm beside a logger that reads its elevation with 0.5 degrees of noise (seed 58).

    The arm is simulated along 800 frames, and passes through them forwards and backwards.
    """
    run(folder, [*shoulder_simulate(folder, 800), "--out", "simulated"])
    arm = pd.read_csv(folder / "simulated" / "right.csv", comment="#")
    arm = arm.iloc[there_and_back(n, len(arm))].reset_index(drop=True)
    arm["time [s]"] = np.arange(n) / RATE
    arm.to_csv(folder / "right.csv", index=False)
    noise = 0.5 * np.random.default_rng(SEED).standard_normal(n)
    table(folder / "logger.csv", {"time [s]": arm["time [s]"], "elevation [deg]": arm["elevation [deg]"] + noise})
    return ["shoulder", "compare", "right.csv", "logger.csv"]


def prosthesis_simulate(folder: Path, n: int) -> list[str]:
    """Frames of the shipped walk, whose markers are recorded at a higher rate: straight lines between its frames."""
    lines = [line for line in (MESHES / WALK / "walking.trc").read_text(encoding="utf-8").splitlines() if line.strip()]
    given = np.array([[float(each) for each in line.split("\t")] for line in lines[HEAD_OF_TRC:]])
    time = np.linspace(given[0, 1], given[-1, 1], n)
    places = np.column_stack([np.interp(time, given[:, 1], column) for column in given[:, PLACES:].T])
    _write_trc(folder / "walking.trc", lines, places, time)
    person = ["--static", str(MESHES / WALK / "standing.trc"), "--mass", "77.3"]
    plates = ["--plates", str(MESHES / WALK / "plates.mot"), "--plate", "own_force", "--other-plate", "other_force"]
    return ["prosthesis", "simulate", "walking.trc", *person, *plates]


def standing_predict(folder: Path, n: int) -> list[str]:
    """Nodes of the prediction of the shipped trial that was held out."""
    study = str(MESHES / "standing_up_held_out" / "study.toml")
    known = ["--parameters", str(STAND / "truth.csv"), "--against", str(STAND / "study.toml")]
    return ["sit-to-stand", "predict", study, *known, "--nodes", str(n)]


def standing_calibrate(folder: Path, n: int) -> list[str]:
    """Nodes for each of the three shipped trials, without resamples."""
    study = str(MESHES / "standing_up" / "study.toml")
    return ["sit-to-stand", "calibrate", study, "--nodes", str(n), "--resamples", "0"]


def cohort(folder: Path, n: int) -> list[str]:
    """Subjects of a study of markers, ik and id of the swinging leg, on one worker."""
    return ["cohort", leg_study(folder, n).name, "--workers", "1"]
