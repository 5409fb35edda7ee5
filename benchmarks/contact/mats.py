"""Pressure mats: time and memory at full size, what a wrench owes to the mat's place: `python -m
benchmarks.contact.mats`.

Speed: a synthetic thigh of about so many faces, a mat of 32 × 16 cells, 3000 frames, one core: laying the mat, mapping
it, the wrench of all frames, its covariance. Peak memory is that of the process, what Python and the kernels need
beforehand included. And the whole command on such a scan and recording, files and page included, in a process of its
own.

Registration: the shipped synthetic recording on the shipped thigh; the mat is laid where its landmarks say, and again
with landmarks shifted by 1 mm and turned by 2° at random about the middle of the mat, and once more with the scan off
by as much in the body's frame, the mat lying on it where it should. Forces, moments and centres are held against those
of the closed form (`truth.csv`).

Draping: the area under each cell against that of the flat cell, laid along the surface and pushed down along the
shortest way, on a cylinder and on a doubly curved thigh.
"""

from __future__ import annotations

import argparse
import json
import resource
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.one_core import pin

HERE = Path(__file__).resolve().parents[1]
MESHES = HERE.parent / "meshes"
ROWS, COLUMNS, PITCH = 32, 16, 0.0141421356
DRAWS = 40
SHIFT, TURN = 1e-3, np.radians(2.0)


def main() -> None:
    """Measure, print, write the JSON."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.contact.mats", description=__doc__.splitlines()[0])
    parser.add_argument("--faces", type=int, default=100_000)
    parser.add_argument("--frames", type=int, default=3000)
    parser.add_argument("--draws", type=int, default=DRAWS)
    parser.add_argument("--out", type=Path, default=HERE / "results")
    options = parser.parse_args()
    pin()
    from benchmarks.machine import machine, versions

    report = {
        "machine": machine(),
        "versions": versions({"scipy"}),
        "speed": speed(options.faces, options.frames),
        "command": command(options.faces, options.frames),
        "registration": registration(options.draws),
        "draping": draping(),
    }
    text = json.dumps(report, indent=1)
    (options.out / "mats.json").write_text(text + "\n", encoding="utf-8")
    print(text)


def tube(faces: int, radius, length: float = 0.6):
    """A closed strip of triangles around y, outwards; `radius(angle, y)` [m]."""
    from geocontact.geometry.surface import Surface

    around = round(np.sqrt(faces))
    along = max(faces // (2 * around), 2)
    angle = np.linspace(0.0, 2.0 * np.pi, around, endpoint=False)
    a, y = np.meshgrid(angle, np.linspace(-0.5 * length, 0.5 * length, along + 1), indexing="ij")
    r = radius(a, y)
    vertices = np.stack([r * np.cos(a), y, r * np.sin(a)], axis=-1).reshape(-1, 3)
    k = np.arange(vertices.shape[0]).reshape(around, along + 1)
    next_k = np.roll(k, -1, axis=0)
    one = np.stack([k[:, :-1], k[:, 1:], next_k[:, 1:]], axis=-1).reshape(-1, 3)
    two = np.stack([k[:, :-1], next_k[:, 1:], next_k[:, :-1]], axis=-1).reshape(-1, 3)
    return Surface(vertices, np.concatenate([one, two]), "tube")


def thigh(angle, y):
    """A tapering oval with a belly [m]."""
    return (0.085 + 0.05 * y + 0.01 * np.cos(2.0 * angle)) * (1.0 + 0.08 * np.exp(-((y - 0.05) ** 2) / 0.02))


def four_marks(rows: int, columns: int, radius, first: float):
    """Corners of a mat wrapped around a tube, rows downwards, columns to the right seen from outside."""
    from geocontact.geometry.drape.mat import Marks

    mid = float(radius(0.0, 0.0))
    cells = np.array([[0.0, 0.5 * columns], [rows, 0.5 * columns]])
    y = first - cells[:, 0] * PITCH
    points = np.stack([radius(np.zeros(2), y), y, np.zeros(2)], axis=-1)
    return Marks(cells, points), mid


def speed(faces: int, frames: int) -> dict[str, object]:
    """Seconds of each step, and the largest memory of the process [MB]."""
    from geocontact.geometry.drape.lay import lay
    from geocontact.geometry.drape.mat import Mat
    from geocontact.geometry.drape.spread import Geodesics
    from geocontact.loads.mat_load import MatErrors, mat_load, wrench_covariance
    from geocontact.loads.mat_map import mat_map

    mat = Mat(ROWS, COLUMNS, (PITCH, PITCH))
    marks, _ = four_marks(ROWS, COLUMNS, thigh, 0.5 * ROWS * PITCH)
    small = Geodesics(tube(2000, thigh))
    lay(small, mat, marks)  # compiles
    rng = np.random.default_rng(0)
    pressure = rng.uniform(0.0, 2e4, (frames, ROWS, COLUMNS))
    valid, area = np.ones((ROWS, COLUMNS), bool), np.full((ROWS, COLUMNS), PITCH**2)
    before = memory()
    steps: dict[str, float] = {}

    def timed(name: str, work):
        begin = time.perf_counter()
        found = work()
        steps[name] = round(time.perf_counter() - begin, 3)
        return found

    surface = tube(faces, thigh)
    geodesics = timed("tree and neighbours [s]", lambda: prepared(Geodesics(surface)))
    laid = timed("laying [s]", lambda: lay(geodesics, mat, marks))
    placed = timed("mapping [s]", lambda: mat_map(surface, laid.nodes, valid & laid.covered, area))
    load = timed("wrench of all frames [s]", lambda: mat_load(placed, placed.of(pressure), np.zeros(3), "tube"))
    timed(
        "covariance of all frames [s]",
        lambda: wrench_covariance(placed, placed.of(pressure), load.wrench, MatErrors(0.1, 0.05, 1e-3, 0.03)),
    )
    timed(
        "pressure on the faces of 201 frames [s]",
        lambda: placed.face_pressure(placed.of(pressure[:201]), surface.face_area),
    )
    return {
        "faces": len(surface.faces), "cells": ROWS * COLUMNS, "frames": frames, **steps,
        "all [s]": round(sum(steps.values()), 3), "covered": int(laid.covered.sum()),
        "memory before [MB]": before, "memory at most [MB]": memory(),
    }  # fmt: skip


def command(faces: int, frames: int) -> dict[str, object]:
    """Seconds of `geocontact mat` and the largest memory of its process [MB], kernels compiled beforehand."""
    surface, (marks, _) = tube(faces, thigh), four_marks(ROWS, COLUMNS, thigh, 0.5 * ROWS * PITCH)
    rng = np.random.default_rng(0)
    with TemporaryDirectory() as place:
        folder = Path(place)
        lines = [f"v {x:.9g} {y:.9g} {z:.9g}" for x, y, z in surface.vertices]
        lines += [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in surface.faces]
        (folder / "scan.obj").write_text("\n".join(lines) + "\n")
        names = ",".join(["time [s]", *(f"r{r}c{c} [kPa]" for r in range(ROWS) for c in range(COLUMNS))])
        table = np.column_stack([0.02 * np.arange(frames), rng.uniform(0.0, 20.0, (frames, ROWS * COLUMNS))])
        np.savetxt(folder / "frames.csv", table, "%.4g", ",", header=names, comments="")
        (folder / "layout.toml").write_text(f"rows = {ROWS}\ncolumns = {COLUMNS}\npitch_mm = {1e3 * PITCH}\n")
        rows = [
            f"m{k}, {row:g}, {column:g}, {x}, {y}, {z}"
            for k, ((row, column), (x, y, z)) in enumerate(zip(marks.cells, 1e3 * marks.points, strict=True))
        ]
        (folder / "marks.csv").write_text("\n".join(["id, row, column, x [mm], y [mm], z [mm]", *rows]) + "\n")
        words = [
            sys.executable, HERE.parent / "cli.py", "mat", folder / "frames.csv", "--layout", folder / "layout.toml",
            "--surface", folder / "scan.obj", "--unit", "m", "--landmarks", folder / "marks.csv",
            "--out", folder / "out",
        ]  # fmt: skip
        begin = time.perf_counter()
        subprocess.run(words, check=True, capture_output=True)
        seconds = time.perf_counter() - begin
    most = resource.getrusage(resource.RUSAGE_CHILDREN).ru_maxrss / 1024.0
    return {"seconds": round(seconds, 2), "memory at most [MB]": round(most, 1)}


def prepared(geodesics):
    """With everything that is made on first use."""
    geodesics.nearest(geodesics.surface.vertices[:1])
    return geodesics


def memory() -> float:
    """Largest resident size of this process so far [MB]."""
    return round(resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0, 1)


def registration(draws: int) -> dict[str, object]:
    """Errors of force, moment and centre: of the mat where it is, and where it is thought to be."""
    from scipy.spatial.transform import RigidTransform, Rotation

    from geocontact.geometry.drape.lay import lay
    from geocontact.geometry.drape.mat import Marks, Mat
    from geocontact.geometry.drape.spread import Geodesics
    from geocontact.geometry.surface import Surface
    from geocontact.io.mats.catalogue import read_mat
    from geocontact.io.mats.layout import read_layout
    from geocontact.io.mesh.meshes import read_mesh
    from geocontact.io.recordings.mat_results import read_mat_landmarks
    from geocontact.loads.mat_load import mat_load
    from geocontact.loads.mat_map import mat_map

    folder = MESHES / "mat_thigh_16x8"
    (frames,) = read_mat(folder / "frames.csv", read_layout(folder / "layout.toml"))
    surface = Surface.of(read_mesh(MESHES / "thigh.stl", "mm"))
    marks = read_mat_landmarks(folder / "landmarks.csv", frames.rows, frames.columns)
    mat, geodesics = Mat(frames.rows, frames.columns, frames.pitch), Geodesics(surface)
    truth = np.genfromtxt(folder / "truth.csv", delimiter=",", comments="#", skip_header=4)
    middle = marks.point.mean(axis=0)

    def found(points: np.ndarray):
        laid = lay(geodesics, mat, Marks(marks.place, points, marks.name))
        placed = mat_map(surface, laid.nodes, frames.valid & laid.covered, frames.cell_area)
        return mat_load(placed, placed.of(frames.pressure), np.zeros(3), "thigh")

    pressed = truth[:, 7] > 0.25 * truth[:, 7].max()
    force, moment, centre = truth[pressed, 1:4], truth[pressed, 4:7], truth[pressed, 10:13] * 1e-3
    size = np.linalg.norm(force, axis=1)

    def off(load) -> dict[str, np.ndarray]:
        return {
            "force [%]": 100.0 * np.linalg.norm(load.wrench.force[pressed] - force, axis=1) / size,
            "direction [deg]": np.degrees(np.arccos(np.clip(
                np.einsum("ti,ti->t", load.wrench.force[pressed], force)
                / size / np.linalg.norm(load.wrench.force[pressed], axis=1), -1.0, 1.0))),
            "moment [% of force x 0.1 m]": 1e3 * np.linalg.norm(load.wrench.moment[pressed] - moment, axis=1) / size,
            "centre [mm]": 1e3 * np.linalg.norm(load.centre[pressed] - centre, axis=1),
        }  # fmt: skip

    exact = {name: round(float(values.max()), 4) for name, values in off(found(marks.point)).items()}
    rng, right = np.random.default_rng(1), found(marks.point)
    of_marks: dict[str, list[float]] = {name: [] for name in exact}
    of_scan: dict[str, list[float]] = {name: [] for name in exact}
    for _ in range(draws):
        axis, way = (each / np.linalg.norm(each) for each in rng.standard_normal((2, 3)))
        turn = Rotation.from_rotvec(TURN * axis)
        pose = RigidTransform.from_components(middle - turn.apply(middle) + SHIFT * way, turn)
        for drawn, load in ((of_marks, found(pose.apply(marks.point))), (of_scan, carried(right, pose))):
            for name, values in off(load).items():
                drawn[name].append(float(values.mean()))
    return {
        "frames": int(pressed.sum()),
        "landmarks exact, largest": exact,
        "1 mm and 2 deg off": spread(of_marks),
        "scan 1 mm and 2 deg off": spread(of_scan),
        "draws": draws,
    }


def spread(drawn: dict[str, list[float]]) -> dict[str, dict[str, float]]:
    """Mean and 95 % quantile."""
    return {
        name: {"mean": round(float(np.mean(v)), 4), "95 %": round(float(np.quantile(v, 0.95)), 4)}
        for name, v in drawn.items()
    }


def carried(load, pose):
    """A load with everything that it acts on moved by a pose, moments about the origin of the frame."""
    force = pose.rotation.apply(load.wrench.force)
    moment = pose.rotation.apply(load.wrench.moment) + np.cross(pose.translation, force)
    return replace(load, wrench=replace(load.wrench, force=force, moment=moment), centre=pose.apply(load.centre))


DOWN = np.array([[0.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0]])
"""Rows of the flat mat along -y, columns along -z, its outside along x."""


def draping() -> list[dict[str, object]]:
    """Area distortion of cells, laid and pushed."""
    from scipy.spatial.transform import RigidTransform, Rotation

    from geocontact.geometry.drape.closest_point import project
    from geocontact.geometry.drape.lay import lay
    from geocontact.geometry.drape.mat import Mat
    from geocontact.geometry.drape.spread import Geodesics

    rows = []
    shapes = {"cylinder of radius 80 mm": lambda a, y: 0.08 + 0.0 * a, "doubly curved thigh": thigh}
    mat = Mat(16, 8, (PITCH, PITCH))
    for name, radius in shapes.items():
        for faces in (2_000, 10_000, 50_000):
            geodesics = Geodesics(tube(faces, radius))
            marks, _ = four_marks(16, 8, radius, 8 * PITCH)
            row: dict[str, object] = {"surface": name, "faces": len(geodesics.surface.faces)}
            flat = RigidTransform.from_components([float(radius(0.0, 0.0)), 0.0, 0.0], Rotation.from_matrix(DOWN))
            for way, laid in (("laid", lay(geodesics, mat, marks)), ("pushed", project(geodesics, mat, flat))):
                known = np.abs(laid.distortion[laid.covered])
                row[f"{way}: largest area error [%]"] = round(100.0 * float(known.max()), 4)
                row[f"{way}: rms [%]"] = round(100.0 * float(np.sqrt(np.mean(known**2))), 4)
                row[f"{way}: folded"] = int(laid.folded.sum())
            rows.append(row)
    return rows


if __name__ == "__main__":
    main()
