"""What a pressure mat on the arm exports, from the cells of the finer truth, and its force by the mat pipeline.

The mat is `meshes/mat_upper_arm_16x8` on `meshes/upper_arm.stl`, 128 cells of 2 cm² laid along the skin. The arm is
turned about its axis so that the mat's middle lies on the armrest, the middle of the segment at that of the sphere;
left arms are mirrored. Between two directions about the axis the skin carries the force that the armrest presses with
there, whatever its radius. The mat reaches 74 degrees to either side, the armrest 90; cells read noise and steps,
and no friction. All sizes are invented, nothing was measured.
"""

from __future__ import annotations

from functools import cache
from pathlib import Path

import numpy as np
import pandas as pd

import geocontact as gc
from benchmarks.shoulder.truth import ALONG
from geocontact.shoulder_exoskeleton.device import Device
from meshes.mat_placement import UPPER_ARM_MAT

MESHES = Path(__file__).resolve().parents[2] / "meshes"
NOISE, STEP = 100.0, 100.0
"""Standard deviation of a cell's noise, and its step [Pa]."""


@cache
def reached(along: float, radius: float, columns: int) -> np.ndarray:
    """Pressure of the mat's cells (16 * 8, ALONG * columns) by that of each cell of an armrest [-].

    Parameters
    ----------
    along, radius
        Length and radius of the armrest [m].
    columns
        Of its cells around, over the half circle under the arm.
    """
    points, weights = UPPER_ARM_MAT.cell_points()
    lateral, up, down = 1e-3 * np.moveaxis(points, -1, 0)  # x, y and z of the segment
    row = np.floor((0.5 - up / along) * ALONG).astype(int)
    angle = np.arctan2(-down, -lateral)  # from medial towards raising, as the truth's cells
    column = np.floor((np.mod(angle, 2.0 * np.pi) - np.pi) / np.pi * columns).astype(int)
    on = (row >= 0) & (row < ALONG) & (column >= 0) & (column < columns)
    share = np.where(on, weights * radius / np.hypot(lateral, down), 0.0)
    found = np.zeros((points.shape[0] * points.shape[1], ALONG * columns))
    cell = np.broadcast_to(np.arange(len(found)).reshape(points.shape[:2])[..., None], on.shape)
    np.add.at(found, (cell[on], (row * columns + column)[on]), share[on])
    return found


def readings(device: Device, cells: np.ndarray) -> np.ndarray:
    """Pressures of the mat's cells (t, 16, 8) [Pa] under those of the armrest (t, ALONG, columns) [Pa]: exact means."""
    spread = reached(device["cuff_length"], device["cuff_radius"], cells.shape[2])
    found = cells.reshape(len(cells), -1) @ spread.T
    return found.reshape(-1, UPPER_ARM_MAT.rows, UPPER_ARM_MAT.columns)


def with_noise(pressure: np.ndarray, seed: int) -> np.ndarray:
    """The same with noise, in steps; cells without load read a little above and below zero."""
    noise = np.random.default_rng(seed).normal(0.0, NOISE, pressure.shape)
    return np.asarray(np.round((pressure + noise) / STEP) * STEP)


def write_mat(folder: Path, time: np.ndarray, pressure: np.ndarray) -> None:
    """mat.csv [kPa] and layout.toml, as the mat exports them."""
    names = [f"r{i}c{j} [kPa]" for i in range(pressure.shape[1]) for j in range(pressure.shape[2])]
    table = pd.DataFrame(1e-3 * pressure.reshape(len(pressure), -1), columns=names)
    table.insert(0, "time [s]", time)
    table.round(4).to_csv(folder / "mat.csv", index=False)
    lines = (MESHES / UPPER_ARM_MAT.name / "layout.toml").read_text(encoding="utf-8").splitlines()
    kept = [line for line in lines if not line.startswith("rate_Hz")]  # mat.csv has the time
    (folder / "layout.toml").write_text("\n".join(kept) + "\n", encoding="utf-8")


def lifting_force(folder: Path) -> tuple[np.ndarray, np.ndarray]:
    """Times [s] and force that raises the arm [N], of the resultant of `geocontact mat`."""
    found = gc.mat(
        folder / "mat.csv",
        surface=MESHES / "upper_arm.stl",
        unit="mm",
        landmarks=MESHES / UPPER_ARM_MAT.name / "landmarks.csv",
        layout=folder / "layout.toml",
    )
    wrench = found.table("wrench")
    return wrench["time [s]"].to_numpy(), -wrench["fz [N]"].to_numpy()
