"""A ball that is pressed into a plate: sphere_r20 over plate_80x80x12, 21 frames in 1 s, 0.2 to 0.9 mm deep."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from meshes.motion_files import poses_text


def ball_press() -> str:
    """Poses of the ball in the plate, whose top is y = 0."""
    time = np.linspace(0.0, 1.0, 21)
    place = np.zeros((21, 3))
    place[:, 1] = 20.0 - (0.2 + 0.7 * time)
    return poses_text(time, place, Rotation.identity(21))
