"""Commands beside peers that do the same job, in one run on one core: `python -m benchmarks.peers_table [--rounds 3]`.

Jobs of whole commands are those of synthetic files: scaled model, angles and moments of a swinging leg (OpenSim's
tools run the set-up files that the commands write), spheres and cylinders (a script with scipy's least squares).
Seconds are CPU, medians, peers turn by turn: of a new process from its start to its end, and of the same job done a
second time in one process, without start and imports. The command also writes figures and page, the peer does not.
Distances and clipped areas are of `benchmarks.area.measure`: trees built beforehand.
"""

from __future__ import annotations

import argparse
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from scipy.interpolate import CubicSpline

from benchmarks.machine import ROOT, as_json, stamp, write_results
from benchmarks.one_core import pin

FRAMES = 1001
KEPT = ROOT / "benchmarks" / "results" / "peers_table.json"
FACTORS = {"femur_r": 1.1, "tibia_r": 0.93}
"""Of the person to whom the model is scaled."""
COLUMNS = ("time", "tilt", "list", "turn", "tx", "ty", "tz", "hip_x", "hip_y", "hip_z", "knee", "ankle")
TURNING = tuple(each for each in COLUMNS if each not in ("time", "tx", "ty", "tz"))
BESIDE = {"list": 4.0, "turn": 7.0, "hip_x": 6.0, "hip_y": 9.0}
"""Amplitudes [deg] of what the shipped swing keeps at zero."""
ENGINES = ("warp (CPU), bounded to 4 mm + longest edge", "fcpw, bounded", "libigl", "open3d", "VTK implicit distance")
"""Rows of the table of distances, by how their names begin; ours come first."""

OURS = """
import sys
from geocontact.cli.main import run
def job():
    if run(sys.argv[2:]):
        raise SystemExit("the command failed")
"""
OPENSIM = """
import os, sys, opensim
opensim.Logger.setLevelString("Off")
os.chdir(sys.argv[3])
def job():
    if not getattr(opensim, sys.argv[2])(sys.argv[4]).run():
        raise SystemExit("the tool failed")
"""
FITTED = """
import sys
import numpy as np
from scipy.optimize import least_squares
def job():
    faces = np.fromfile(sys.argv[2], np.dtype([("n", "<f4", 3), ("x", "<f4", (3, 3)), ("a", "<u2")]), offset=84)
    x = faces["x"].astype(float)
    if sys.argv[3] == "sphere":
        points = np.unique(x.reshape(-1, 3), axis=0)
        found = least_squares(lambda v: np.linalg.norm(points - v[:3], axis=1) - v[3], [*points.mean(axis=0), 1.0])
        print("radius", found.x[3], flush=True)
        return
    normals, middle = np.cross(x[:, 1] - x[:, 0], x[:, 2] - x[:, 0]), x.mean(axis=1)
    outward = (normals[:, :2] * middle[:, :2]).sum(axis=1)
    outward /= np.linalg.norm(normals, axis=1) * np.linalg.norm(middle[:, :2], axis=1)
    points = np.unique(x[outward > 0.5].reshape(-1, 3), axis=0)
    def off(v):
        along = np.array([v[2], v[3], 1.0]) / np.sqrt(1.0 + v[2] ** 2 + v[3] ** 2)
        return np.linalg.norm(np.cross(points - [v[0], v[1], 0.0], along), axis=1) - v[4]
    print("radius", least_squares(off, [0.1, 0.1, 0.01, 0.01, 1.0]).x[4], flush=True)
"""
TIMED = """
import sys, time
for _ in range(int(sys.argv[1])):
    began = time.process_time()
    job()
sys.stderr.write(f"\\nseconds {time.process_time() - began}\\n")
"""


@dataclass
class Side:
    """One of the two that do a job.

    Parameters
    ----------
    name
        Command, or library.
    program, words
        What Python runs, and with which words.
    error
        Of what it wrote, read from its output and its folder.
    whole, again
        CPU seconds from start to end, and of the second time in one process, by round.
    """

    name: str
    program: str
    words: Sequence[str]
    error: Callable[[str], float]
    said: str = ""
    off: float = np.nan
    whole: list[float] = field(default_factory=list)
    again: list[float] = field(default_factory=list)


@dataclass(frozen=True)
class Job:
    """A job, the unit and the meaning of its error, and both sides."""

    name: str
    error: str
    ours: Side
    peer: Side


def main() -> None:
    """Measure, print both tables, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.peers_table", description=__doc__.splitlines()[0])
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--frames", type=int, default=FRAMES, help="of the swinging leg")
    parser.add_argument("--no-distances", action="store_true", help="whole commands only")
    again = "only rows of distances whose engine begins so, each beside the map in this run; the others are kept"
    parser.add_argument("--again", metavar="ENGINE", help=again)
    asked = parser.parse_args()
    pin()
    if asked.again:
        kept = json.loads(KEPT.read_text(encoding="utf-8"))
        kept["figures"]["distances"] = renewed(kept["figures"]["distances"], distances(asked.rounds, (asked.again,)))
        KEPT.write_text(as_json(kept), encoding="utf-8")
        return
    with tempfile.TemporaryDirectory() as folder:
        jobs = all_jobs(Path(folder), asked.frames)
        for job in jobs:
            for _ in range(asked.rounds):
                for side in (job.ours, job.peer):
                    measure(side, Path(folder))
            for side in (job.ours, job.peer):
                side.off = side.error(side.said)
    rows = [] if asked.no_distances else distances(asked.rounds)
    print(text_of(jobs, rows))
    figures = {"jobs": [record(job) for job in jobs], "distances": rows}
    packages = {"opensim", "scipy", "libigl", "open3d", "fcpw", "warp-lang", "vtk"}
    write_results("peers_table", {"rounds": asked.rounds, "frames": asked.frames}, figures, packages)


def all_jobs(folder: Path, frames: int) -> list[Job]:
    """Files of the jobs, written by the commands, and the jobs."""
    model = str(ROOT / "meshes" / "leg.osim")
    truth = swing(folder / "swing.mot", frames)
    command(folder, "markers", "swing.mot", "--model", model, "--out", "v")
    angles = ["ik", "v/markers.trc", "--model", model, "--out", "a"]
    moments = ["id", "a/ik.mot", "--model", model, "--out", "m"]
    for words in (angles, moments):  # what the tools read
        command(folder, *words)

    def turned(file: str) -> Callable[[str], float]:
        return lambda _: angles_off(folder / file, truth)

    def pulled(_: str) -> float:
        own, theirs = motion(folder / "m" / "id.sto"), motion(folder / "m" / "opensim_id.sto")
        return float(np.abs(own - theirs)[:, 1:].max())

    return [
        scale_job(folder, Path(model)),
        Job(
            f"angles of {frames} frames",
            "angles, deg",
            Side("ik", OURS, angles, turned("a/ik.mot")),
            tool("InverseKinematicsTool", "a/setup_ik.xml", turned("a/opensim_ik.mot")),
        ),
        Job(
            f"moments of {frames} frames",
            "between the two, N and N m",
            Side("id", OURS, moments, pulled),
            tool("InverseDynamicsTool", "m/setup_id.xml", pulled),
        ),
        fit_job(folder, "sphere", "sphere_r18.stl", 18.0),
        fit_job(folder, "cylinder", "cylinder_r15_l40.stl", 15.0),
    ]


def tool(kind: str, setup: str, error: Callable[[str], float]) -> Side:
    """One of OpenSim's, with a set-up file that a command wrote."""
    return Side(f"OpenSim {kind}", OPENSIM, [kind, *setup.split("/")], error)


def scale_job(folder: Path, model: Path) -> Job:
    """A model scaled to the markers of a person whose thigh and shank differ from it by known factors."""
    person = stretched(model.read_text(encoding="utf-8"), FACTORS)
    (folder / "person.osim").write_text(person, encoding="utf-8")
    still = folder / "still.mot"
    swing(still, 11)
    command(folder, "markers", still.name, "--model", "person.osim", "--out", "p")
    wanted = mass_centres(folder / "person.osim")
    measured = [word for body in FACTORS for word in ("--scale", f"{body}={body}0/{body}2")]
    words = ["scale", "p/markers.trc", "--model", str(model), "--mass", "30", "--time", "0:0.05", *measured]
    words += ["--out", "s"]
    command(folder, *words)

    def moved(file: str) -> Callable[[str], float]:
        return lambda _: float(1e3 * np.abs(mass_centres(folder / file) - wanted).max())

    peer = tool("ScaleTool", "s/setup_scale.xml", moved("s/opensim_scaled.osim"))
    return Job("a scaled model", "mass centres, mm", Side("scale", OURS, words, moved("s/scaled.osim")), peer)


def stretched(model: str, factors: Mapping[str, float]) -> str:
    """A model's text with lengths of some bodies multiplied: centres of mass, markers, joints towards the next body."""
    place = (
        r"((?:/bodyset/)%s</socket_parent(?:_frame)?>\s*<(?:location|translation)>|<Body name=\"%s\">.*?<mass_center>)"
    )
    for body, factor in factors.items():
        model = re.sub(
            f"{place % (body, body)}([^<]*)",
            lambda found, by=factor: found[1] + " ".join(f"{by * float(each):.12g}" for each in found[2].split()),
            model,
        )
    return model


def angles_off(file: Path, truth: np.ndarray) -> float:
    """Largest difference of any coordinate that turns from the truth's [deg], found by the names in the file."""
    names = file.read_text(encoding="utf-8").partition("endheader\n")[2].splitlines()[0].split()
    found = motion(file)
    return max(float(np.abs(found[:, names.index(each)] - truth[:, COLUMNS.index(each)]).max()) for each in TURNING)


def fit_job(folder: Path, shape: str, name: str, radius: float) -> Job:
    """A fit to a solid whose radius is known [mm]."""
    mesh = str(ROOT / "meshes" / name)
    words = ["fit", mesh, "--shape", shape, "--unit", "mm", "--out", shape]
    words += ["--axis", "0,0,0,0,0,1", "--region", "outward>0.5"] if shape == "cylinder" else []

    def own(_: str) -> float:
        return abs(float(json.loads((folder / shape / "fit.json").read_text(encoding="utf-8"))["radius_mm"]) - radius)

    peer = Side(
        "scipy.optimize.least_squares", FITTED, [mesh, shape], lambda said: abs(float(said.split()[-1]) - radius)
    )
    return Job(f"a {shape} fitted", "radius, mm", Side("fit", OURS, words, own), peer)


def measure(side: Side, folder: Path) -> None:
    """One round: the whole in a process of its own, and the second time in another."""
    for times, seconds in ((1, side.whole), (2, side.again)):
        program = [sys.executable, "-c", side.program + TIMED, str(times), *side.words]
        before = os.times()
        done = subprocess.run(program, cwd=folder, env=environment(), capture_output=True, text=True, check=False)
        after = os.times()
        if done.returncode:
            raise RuntimeError(f"{side.name}: {done.stderr}")
        told = float(done.stderr.rpartition("seconds ")[2])
        spent = after.children_user + after.children_system - before.children_user - before.children_system
        seconds.append(spent if times == 1 else told)
    side.said = done.stdout


def command(folder: Path, *words: str) -> None:
    """Run one of ours, which also fills its caches."""
    measure(Side(words[0], OURS, words, lambda _: 0.0), folder)


def environment() -> dict[str, str]:
    """That of this process, with the checkout first."""
    return {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), os.environ.get("PYTHONPATH", "")])}


def swing(file: Path, frames: int) -> np.ndarray:
    """The shipped swing, drawn out to so many frames at 100 Hz by splines, as a motion file; its values [s, deg, m].

    What it keeps at zero swings as well: once to and fro, from rest to rest.
    """
    head, _, body = (ROOT / "meshes" / "leg_swing.mot").read_text(encoding="utf-8").partition("endheader\n")
    names, _, rows = body.partition("\n")
    values = np.loadtxt(rows.splitlines())
    wanted = np.linspace(values[0, 0], values[-1, 0], frames)
    drawn = CubicSpline(values[:, 0], values)(wanted)
    drawn[:, 0] = 0.01 * np.arange(frames)
    for name, size in BESIDE.items():
        drawn[:, COLUMNS.index(name)] += size * np.sin(np.pi * np.linspace(0.0, 1.0, frames)) ** 2
    lines = ["\t".join(f"{value:.9f}" for value in row) for row in drawn]
    head = re.sub(r"nRows=\d+", f"nRows={frames}", head)
    file.write_text(f"{head}endheader\n{names}\n" + "\n".join(lines) + "\n", encoding="utf-8")
    return drawn


def motion(file: Path) -> np.ndarray:
    """Values of a .mot or .sto, time first."""
    return np.loadtxt(file.read_text(encoding="utf-8").partition("endheader\n")[2].splitlines()[1:])


def mass_centres(model: Path) -> np.ndarray:
    """Those of a model's bodies, in its order [m]."""
    found = re.findall(r"<mass_center>([^<]*)</mass_center>", model.read_text(encoding="utf-8"))
    return np.array([[float(each) for each in one.split()] for one in found])


def renewed(kept: Sequence[Mapping[str, Any]], found: Sequence[Mapping[str, Any]]) -> list[Mapping[str, Any]]:
    """Rows in the place of earlier ones of the same engine, with when and where they were run; ours stays."""
    ours, *others = found
    about = {"run": stamp(), "ours_cpu_s": ours["cpu_s"]}
    names = [each["engine"] for each in others]
    return [*(each for each in kept if each["engine"] not in names), *({**each, **about} for each in others)]


def distances(rounds: int, names: tuple[str, ...] = ENGINES) -> list[dict[str, float | str]]:
    """Rows of `benchmarks.area` that stand for each library, ours first."""
    from benchmarks.area.measure import measured
    from benchmarks.engines.all import all_engines
    from benchmarks.engines.ours import OURS as MAP
    from benchmarks.pairs import PAIRS

    engines = [each for each in all_engines() if each.name == MAP or each.name.startswith(names)]
    rows = measured(PAIRS["knee"](50_000, 101), engines, rounds, lambda line: print(line, file=sys.stderr, flush=True))
    ours = next(row for row in rows if row.engine.name == MAP)
    return [
        {
            "engine": row.engine.name,
            "cpu_s": float(np.median(row.cpu)),
            "ratio": row.ratio(ours),
            "distance_error_mm": 1e3 * row.distance_error,
            "area_error": row.area_error,
        }
        for row in rows
        if not row.skipped
    ]


def ratios(job: Job) -> tuple[float, float]:
    """Peer over ours, medians over the rounds: whole, and without start."""
    whole, again = (np.median(np.array(a) / np.array(b)) for a, b in zip(_of(job.peer), _of(job.ours), strict=True))
    return float(whole), float(again)


def _of(side: Side) -> tuple[list[float], list[float]]:
    return side.whole, side.again


def record(job: Job) -> dict[str, object]:
    """What is written of a job."""
    sides = {
        key: {name: value for name, value in asdict(side).items() if name not in ("program", "words", "error", "said")}
        for key, side in (("ours", job.ours), ("peer", job.peer))
    }
    whole, again = ratios(job)
    return {"job": job.name, "error": job.error, **sides, "ratio_whole": whole, "ratio_again": again}


def text_of(jobs: Sequence[Job], rows: Sequence[dict[str, float | str]]) -> str:
    """Both tables in Markdown."""
    lines = ["| job | command | peer | whole, CPU s | ratio | without start | ratio | errors |", "|---" * 8 + "|"]
    for job in jobs:
        whole, again = ratios(job)
        medians = [[float(np.median(each)) for each in _of(side)] for side in (job.ours, job.peer)]
        columns = [f"{medians[0][k]:.2f} / {medians[1][k]:.2f} | {ratio:.1f}" for k, ratio in enumerate((whole, again))]
        errors = f"{job.ours.off:.1g} / {job.peer.off:.1g} ({job.error})"
        lines.append(f"| {job.name} | `{job.ours.name}` | {job.peer.name} | {' | '.join(columns)} | {errors} |")
    lines += (
        ["", "| engine | CPU s | ÷ geocontact | distance error, mm | area error |", "|---" * 5 + "|"] if rows else []
    )
    for row in rows:
        figures = f"{row['cpu_s']:.2f} | {row['ratio']:.1f} | {row['distance_error_mm']:.0e} | {row['area_error']:.0e}"
        lines.append(f"| {row['engine']} | {figures} |")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
