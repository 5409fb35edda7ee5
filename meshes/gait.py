"""A synthetic gait cycle of the sample knee: prescribed angles and rollback, vertical position settled by contact.

Poses are those of the femoral component (frame F, moving) in the tibial insert (frame T, fixed):
R_TF = Ry(rotation) Rx(adduction) Rz(flexion), the joint coordinate system of Grood and Suntay (1983) with flexion about
the femoral and rotation about the tibial axis. Nothing here was measured.
"""

from __future__ import annotations

from dataclasses import dataclass

import igl
import numpy as np
from scipy.spatial.transform import Rotation

from meshes.femoral_component import DISTAL, POSTERIOR, TURNS, direction

FRAMES, DURATION = 101, 1.0
"""Frames of the cycle and its duration [s]."""
DEPTH = 0.02
"""Penetration of the deepest vertex after settling on the medium pair [mm]."""


@dataclass(frozen=True)
class Gait:
    """Time [s], angles (t, 3) = flexion, adduction, rotation [deg] and translations (t, 3) of F in T [mm]."""

    time: np.ndarray
    angles: np.ndarray
    translation: np.ndarray

    def rotation(self) -> Rotation:
        """R_TF for every frame."""
        return Rotation.from_euler("YXZ", self.angles[:, [2, 1, 0]], degrees=True)

    def mirrored(self) -> Gait:
        """The same motion of the left pair: z, adduction and rotation change sign."""
        return Gait(self.time, self.angles * [1, -1, -1], self.translation * [1, 1, -1])


def bump(phase: np.ndarray, centre: float, width: float) -> np.ndarray:
    """A smooth periodic hill of height 1 at `centre`; phase, centre and width in parts of the cycle."""
    away = np.abs((phase - centre + 0.5) % 1.0 - 0.5)
    return np.exp(-((away / width) ** 2))


def prescribed_angles(phase: np.ndarray) -> np.ndarray:
    """Flexion, adduction and rotation (t, 3) [deg]: 18 deg at loading response, 60 deg in swing."""
    loading, swing = bump(phase, 0.14, 0.09), bump(phase, 0.73, 0.14)
    flexion = 4.0 + 14.0 * loading + 56.0 * swing
    adduction = -0.6 * bump(phase, 0.22, 0.16) + 1.6 * bump(phase, 0.76, 0.13)
    rotation = -2.0 + 3.0 * loading + 7.0 * bump(phase, 0.70, 0.16) - 3.0 * bump(phase, 0.45, 0.12)
    return np.round(np.column_stack([flexion, adduction, rotation]), 6)


def contact_position(flexion: np.ndarray) -> np.ndarray:
    """Where the lowest point of the condyles stands on the insert, x [mm]: rollback coupled with flexion."""
    return 2.0 - 8.0 * np.sin(np.radians(1.5 * flexion)) ** 2


def horizontal_position(angles: np.ndarray, phase: np.ndarray) -> np.ndarray:
    """tx and tz (t, 2) [mm] that bring the lowest point to `contact_position`, with a little medio-lateral shift."""
    flexion = angles[:, 0]
    centre = (POSTERIOR - DISTAL) * direction(TURNS[2])
    turn = np.radians(flexion)
    forward = centre[0] * np.cos(turn) - centre[1] * np.sin(turn)
    on_distal_arc = -90.0 - flexion >= np.degrees(TURNS[2])
    tx = contact_position(flexion) - np.where(on_distal_arc, forward, 0.0)
    tz = 0.6 * bump(phase, 0.15, 0.10) - 0.8 * bump(phase, 0.72, 0.14)
    return np.round(np.column_stack([tx, tz]), 4)


def vertex_distances(points: np.ndarray, surface: tuple) -> np.ndarray:
    """Signed distance [mm] of points to a closed surface, negative inside; all in one frame."""
    if not len(points):
        return np.array([np.inf])
    kind = igl.SignedDistanceType.SIGNED_DISTANCE_TYPE_PSEUDONORMAL
    return igl.signed_distance(points, *surface, kind)[0]


def settled_height(insert: tuple, femoral: tuple, rotation: Rotation, tx: float, tz: float, start: float) -> float:
    """ty [mm] at which the deepest vertex of either body lies DEPTH inside the other, found to 1e-6 mm.

    Moving down by the distance itself never oversteps, for a distance falls by no more than the way gone. After the
    first query only vertices within 1 mm of the smallest distance are asked again: others cannot overtake them.
    """
    turned, height, move = rotation.apply(femoral[0]), start, np.inf
    below, above = insert[0], turned
    while abs(move) > 1e-6:
        shift = np.array([tx, height, tz])
        of_insert = vertex_distances(below - shift, (turned, femoral[1]))
        of_femoral = vertex_distances(above + shift, insert)
        smallest = min(of_insert.min(), of_femoral.min())
        if np.isinf(move):
            below, above = below[of_insert < smallest + 1.0], above[of_femoral < smallest + 1.0]
        move = smallest + DEPTH
        height -= move
        if abs(height - start) > 0.5:
            return settled_height(insert, femoral, rotation, tx, tz, height)
    return round(float(height), 4)


def synthetic_gait(insert: tuple, femoral: tuple) -> Gait:
    """The cycle, settled on this pair of closed surfaces (vertices [mm], faces)."""
    phase = np.arange(FRAMES) / (FRAMES - 1)
    angles = prescribed_angles(phase)
    tx, tz = horizontal_position(angles, phase).T
    rotation = Gait(phase, angles, np.zeros((FRAMES, 3))).rotation()
    heights = [30.0]
    for k in range(FRAMES):
        heights.append(settled_height(insert, femoral, rotation[k], tx[k], tz[k], heights[-1]))
    return Gait(np.round(phase * DURATION, 6), angles, np.column_stack([tx, heights[1:], tz]))
