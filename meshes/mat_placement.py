"""Where a mat lies on a body segment: geodesic (Fermi) coordinates about the mat's middle line.

The middle line runs along the rows' direction u as a geodesic through the mat's centre; from each of its points a
geodesic leaves at a right angle along the columns' direction v. Distances along the line and along these ribs are
those on the flat mat; only between the ribs does the skin's Gaussian curvature K tell, by 1 - K v^2/2 + ... (do Carmo,
Differential Geometry of Curves and Surfaces, 1976, sec. 4-6). Positions (u, v) count cells: (0, 0) is the outer corner
of cell (0, 0). Seen from outside, rows counted downwards, columns run to the right: u x v is the outward normal.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np

from meshes.geodesics import STEP, along, heading, velocity
from meshes.segments import SHANK, THIGH, TORSO, UPPER_ARM, Segment


@dataclass(frozen=True)
class Mat:
    """A mat of `rows` x `columns` square cells of `pitch` [mm], its centre at (theta [rad], y [mm]) of the segment.

    `turn` [rad] goes from straight down (-y along the skin) to the rows' direction, counter-clockwise from outside.
    """

    name: str
    segment: Segment
    rows: int
    columns: int
    theta: float
    y: float
    turn: float
    pitch: float = 200.0**0.5

    def start(self) -> np.ndarray:
        """State (4,) of the middle line in the mat's centre."""
        at = np.array([self.theta, self.y])
        down = -self.segment.tangents(at)[1]
        down /= np.linalg.norm(down)
        right = np.cross(self.segment.normals(at), down)
        direction = np.cos(self.turn) * down + np.sin(self.turn) * right
        return np.concatenate([at, velocity(self.segment, at, direction)])

    def parameters(self, u: np.ndarray, v: np.ndarray, step: float = STEP) -> np.ndarray:
        """(theta, y) of the positions u (m,) times v (n,) [cells], both increasing: (m, n, 2)."""
        line = along(self.segment, self.start(), (u - self.rows / 2) * self.pitch, step)
        at = line[..., :2]
        right = np.cross(self.segment.normals(at), heading(self.segment, line))
        ribs = np.concatenate([at, velocity(self.segment, at, right)], axis=-1)
        states = along(self.segment, ribs, (v - self.columns / 2) * self.pitch, step)
        return np.swapaxes(states, 0, 1)[..., :2]

    @property
    def landmarks(self) -> np.ndarray:
        """Marked positions (l, 2) [cells]: corners, middles of the sides and the centre."""
        rows, columns = (0.0, self.rows / 2, self.rows), (0.0, self.columns / 2, self.columns)
        return np.array([(u, v) for u in rows for v in columns])

    @cache  # noqa: B019 - four mats, made once
    def landmark_points(self) -> np.ndarray:
        """The skin under the landmarks (l, 3) [mm]."""
        u, v = (np.unique(c) for c in self.landmarks.T)
        return self.segment.points(self.parameters(u, v)).reshape(-1, 3)

    @cache  # noqa: B019
    def cell_points(self, nodes: int = 8) -> tuple[np.ndarray, np.ndarray]:
        """Skin under Gauss' nodes of every cell (rows, columns, nodes^2, 3) [mm], and their weights, of sum 1."""
        x, w = np.polynomial.legendre.leggauss(nodes)
        inside = (x + 1) / 2
        u = (np.arange(self.rows)[:, None] + inside).ravel()
        v = (np.arange(self.columns)[:, None] + inside).ravel()
        points = self.segment.points(self.parameters(u, v))
        split = points.reshape(self.rows, nodes, self.columns, nodes, 3).swapaxes(1, 2)
        return split.reshape(self.rows, self.columns, nodes**2, 3), np.outer(w, w).ravel() / 4


THIGH_MAT = Mat("mat_thigh_16x8", THIGH, 16, 8, theta=0.0, y=20.0, turn=0.0)
TORSO_MAT = Mat("mat_torso_32x8", TORSO, 32, 8, theta=0.0, y=-40.0, turn=np.radians(86.0))
"""On the front of the thigh, down its mirror plane; around the front of the waist, 4 deg off level."""
SHANK_MAT = Mat("mat_shank_16x8", SHANK, 16, 8, theta=0.0, y=0.0, turn=0.0)
UPPER_ARM_MAT = Mat("mat_upper_arm_16x8", UPPER_ARM, 16, 8, theta=np.pi / 2, y=0.0, turn=np.radians(3.0))
"""Down the shin; down the outer side of the upper arm, 3 deg off its axis."""
