"""The pairs that are measured: two surfaces in metres and the poses of the moving one."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import Rotation

from geocontact.data.motion import Motion
from geocontact.geometry.surface import Surface
from geocontact.io.mesh.meshes import read_mesh
from geocontact.io.motion.poses import motion_from_csv, motion_from_map
from geocontact.io.text.tables import read_table
from meshes.simple_shapes import cup, sphere
from meshes.total_knee import RESOLUTIONS, total_knee

ROOT = Path(__file__).resolve().parents[1]
THRESHOLD = 4e-3
"""Largest distance that counts as contact [m]."""
FINE_FACES = 5e4
"""Faces of the knee bodies at the resolution `fine`."""
COORDINATES = "rx=knee_flex_r,ry=knee_add_r,rz=knee_rot_r,tx=knee_ant_r,ty=knee_sup_r,tz=knee_lat_r"


@dataclass(frozen=True, eq=False)
class Pair:
    """A moves, B is fixed: x_B = rotation[k] x_A + translation[k] [m]."""

    name: str
    moving: Surface
    fixed: Surface
    rotation: Float[np.ndarray, "t 3 3"]
    translation: Float[np.ndarray, "t 3"]

    def moved(self, k: int) -> Float[np.ndarray, "n 3"]:
        """A's vertices in frame k, about the centre of B [m]: float32 peers lose nothing there."""
        return np.asarray(self.moving.vertices @ self.rotation[k].T + (self.translation[k] - self.fixed.centre))


def knee(faces: int, frames: int) -> Pair:
    """The synthetic total knee through its gait cycle, insert fixed."""
    insert, femoral = total_knee(RESOLUTIONS["fine"] * (faces / FINE_FACES) ** 0.5)
    motion = motion_from_csv(ROOT / "meshes" / "gait.csv")
    return _pair("knee", _millimetres(*femoral, "femoral"), _millimetres(*insert, "insert"), *_poses(motion, frames))


def sphere_cup(faces: int, frames: int) -> Pair:
    """A ball of 23 mm that rolls about in a cup of 24 mm, 0.9 mm off its centre."""
    ball = sphere(23.0, max(2, round((faces / 20) ** 0.5)))
    socket = cup(24.0, 5.0, max(2, round((faces / 13.5) ** 0.5)))
    phase = np.linspace(0.0, 2.0 * np.pi, frames)
    turn = Rotation.from_euler("ZX", np.column_stack([0.5 * np.sin(phase), 0.3 * np.cos(phase)])).as_matrix()
    shift = 0.9e-3 * np.column_stack([0.3 * np.sin(phase), -np.ones(frames), 0.3 * np.cos(phase)]) / np.hypot(1.0, 0.3)
    return _pair("sphere-cup", _millimetres(*ball, "ball"), _millimetres(*socket, "cup"), turn, shift)


def dm(faces: int, frames: int) -> Pair:
    """The real implants of the sixth Grand Challenge (subject DM) over recorded gait; the files set the faces."""
    folder = Path(os.environ.get("GEOCONTACT_DATA", ROOT.parent / "shared" / "data")) / "gc6_dm_knee"
    if not folder.is_dir():
        raise FileNotFoundError(f"no folder {folder.name} in $GEOCONTACT_DATA: the pair dm cannot be measured")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        femoral, insert = (
            Surface.of(read_mesh(folder / "stl" / f"{body} decimated.stl", "m"))
            for body in ("Femoral Component", "Tibial Insert")
        )
        table = read_table(folder / "fluoroscopy" / "Fluoroscopic Gait Data.sto")
        motion = motion_from_map(table, COORDINATES, angles="rad")
    return _pair("dm", femoral, insert, *_poses(motion, frames))


PAIRS = {"knee": knee, "sphere-cup": sphere_cup, "dm": dm}


def _millimetres(vertices: np.ndarray, faces: np.ndarray, name: str) -> Surface:
    return Surface(1e-3 * vertices, np.ascontiguousarray(faces, np.int64), name)


def _pair(name: str, moving: Surface, fixed: Surface, rotation: np.ndarray, translation: np.ndarray) -> Pair:
    return Pair(name, moving, fixed, np.ascontiguousarray(rotation), np.ascontiguousarray(translation))


def _poses(motion: Motion, frames: int) -> tuple[np.ndarray, np.ndarray]:
    """`frames` poses spread evenly over the motion."""
    chosen = np.unique(np.linspace(0, len(motion) - 1, min(frames, len(motion))).round().astype(int))
    rotation = motion.poses.rotation.as_matrix().reshape(-1, 3, 3)
    return rotation[chosen], np.asarray(motion.poses.translation).reshape(-1, 3)[chosen]
