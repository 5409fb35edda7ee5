"""What lies beside the shipped mat recordings: a motion, a model's forces, a belt, a second scan, another frame."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from benchmarks.same_outputs.inputs.leg import turned
from benchmarks.same_outputs.inputs.text import table, written
from meshes.segments import TORSO
from meshes.stl import read_stl, stl_bytes

TURN = turned(0, 0.3) @ turned(1, -0.5) @ turned(2, 0.2)
SHIFT = np.array([40.0, -25.0, 60.0])
"""Pose of the thigh's scan in the frame of a body [-, mm]."""
ROUND, WIDE, LEVEL = 32, 6, -40.0
"""Cells around the waist and along it; height of the belt's middle [mm]."""
LANDMARKS = "id, row, column, x [mm], y [mm], z [mm]"


def make(home: Path, meshes: Path) -> None:
    """All of them for the thigh but the belt, which is around the torso."""
    time = np.linspace(0.0, 3.0, 31)
    half = 0.3 * time
    pose = {"tx [m]": 0.3 + 0.1 * time, "ty [m]": 0.9 - 0.05 * time, "tz [m]": 0.02 * time - 0.1}
    still = np.zeros_like(time)
    quaternion = {"qw": np.cos(half), "qx": still, "qy": still, "qz": np.sin(half)}
    table(home / "motion.csv", {"time [s]": time, **pose, **quaternion})
    vertices, faces = read_stl(meshes / "thigh.stl")
    (home / "thigh_with_mat.stl").write_bytes(second_scan(vertices, faces))
    (home / "scan.stl").write_bytes(stl_bytes((vertices - SHIFT) @ TURN, faces, "thigh, standing elsewhere"))
    elsewhere(home, meshes / "mat_thigh_16x8" / "landmarks.csv")
    forces(home, meshes / "mat_thigh_16x8" / "truth.csv")
    belt(home)


def elsewhere(home: Path, landmarks: Path) -> None:
    """Landmarks of the scan in its own frame, and their places on the body, 1 mm off."""
    rows = [line.split(",") for line in landmarks.read_text("utf-8").splitlines()[1:]]
    there = np.array([row[3:] for row in rows], float)
    here = (there - SHIFT) @ TURN
    names = [row[0] for row in rows]
    places = dict(zip(("x [mm]", "y [mm]", "z [mm]"), here.T, strict=True))
    cells = {"row": [float(row[1]) for row in rows], "column": [float(row[2]) for row in rows]}
    table(home / "landmarks.csv", {"id": names, **cells, **places})
    off = there + np.random.default_rng(4).normal(0.0, 1.0, there.shape)
    body = {f"body_{axis} [mm]": off[:, k] for k, axis in enumerate("xyz")}
    table(home / "pairs.csv", {"id": names, **places, **body})


def forces(home: Path, truth: Path) -> None:
    """A model's forces, 5 % and 0.02 s off the exact ones; phases of the recording."""
    lines = truth.read_text("utf-8").splitlines()
    values = np.array([line.split(",")[:7] for line in lines[4:]], float)
    names = [name.strip() for name in lines[3].split(",")[:7]]
    columns = dict(zip(names, (1.05 * values).T, strict=True)) | {names[0]: values[:, 0] + 0.02}
    table(home / "model.csv", columns)
    written(home / "phases.csv", "name, start [s], end [s]\nup,0.4,1.4\ndown,1.4,2.6\n")


def second_scan(vertices: np.ndarray, faces: np.ndarray) -> bytes:
    """The thigh, faces in four, with a slab of 3 mm where the mat lies and noise of 0.2 mm, standing elsewhere."""
    vertices, faces = halved(vertices, faces)
    normals = np.zeros_like(vertices)
    corners = vertices[faces]
    flat = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    for k in range(3):
        np.add.at(normals, faces[:, k], flat)
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    x, y, z = vertices.T
    side = np.interp(y, (-90.5, 21.0, 133.4), (49.615, 50.979, 52.226))
    bend = (z / side) ** 2
    under = (x > 0.0) & (np.abs(z) < side) & (y < 133.042 + 0.667 * bend) & (y > -92.174 + 3.230 * bend)
    moved = vertices + 3.0 * under[:, None] * normals
    moved += np.random.default_rng(5).normal(0.0, 0.2, moved.shape)
    return stl_bytes(moved @ TURN.T + [40.0, -20.0, 90.0], faces, "thigh with a mat")


def halved(vertices: np.ndarray, faces: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Every face in four, new corners in the middle of the edges."""
    edges = np.sort(np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]]), axis=1)
    unique, which = np.unique(edges, axis=0, return_inverse=True)
    a, b, c = faces.T
    ab, bc, ca = len(vertices) + which.reshape(3, -1)
    quarters = [np.column_stack(part) for part in ((a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca))]
    return np.concatenate([vertices, vertices[unique].mean(axis=1)]), np.concatenate(quarters)


def belt(home: Path) -> None:
    """A belt of square-ish cells around the waist, pressed in front and less so behind [kPa]."""
    theta = np.linspace(0.0, 2.0 * np.pi, 4001)
    points = TORSO.points(np.column_stack([theta, np.full_like(theta, LEVEL)]))
    gone = np.concatenate([[0.0], np.linalg.norm(np.diff(points, axis=0), axis=1).cumsum()])
    rows = []
    for k in range(4):
        x, y, z = (np.interp(k / 4 * gone[-1], gone, points[:, axis]) for axis in range(3))
        rows.append(f"m{k},{WIDE / 2:g},{ROUND * (1 - k / 4):g},{x:.6f},{y:.6f},{z:.6f}")
    written(home / "belt_landmarks.csv", "\n".join([LANDMARKS, *rows]) + "\n")
    pitch = f"[15.0, {gone[-1] / ROUND:.6f}]"
    written(home / "belt.toml", f'rows = {WIDE}\ncolumns = {ROUND}\npitch_mm = {pitch}\nunit = "kPa"\norder = "row"\n')
    time = np.arange(0.0, 1.0, 0.02)
    around = 8.0 + 6.0 * np.cos(2.0 * np.pi * (np.arange(ROUND) + 0.5) / ROUND)
    cells = {
        f"r{r}c{c}": around[c] * np.sin(np.pi * time) ** 2 * (1.0 + 0.1 * r) for r in range(WIDE) for c in range(ROUND)
    }
    table(home / "belt.csv", {"time [s]": time, **cells})
