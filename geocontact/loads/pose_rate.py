"""Velocities of a body's points from its recorded poses."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.interpolate import make_interp_spline
from scipy.spatial.transform import RigidTransform

CUBIC = 3


def pose_rate(time: Float[np.ndarray, " t"], poses: RigidTransform) -> Float[np.ndarray, "t 4 4"]:
    """Time derivative of the pose matrices: the velocity of a point p of the body is (dX/dt p) [m/s].

    The derivative of the cubic spline (not-a-knot) through the matrices' entries, which gives each point of the body
    the velocity of the spline through its own recorded positions: the same in every frame, the error of third order in
    the time step. Linear with two or three frames, zero with one. Nothing is smoothed: filter noisy motion beforehand.
    """
    if len(time) == 1:
        return np.zeros((1, 4, 4))
    spline = make_interp_spline(time, poses.as_matrix(), k=CUBIC if len(time) > CUBIC else 1)
    return np.asarray(spline.derivative()(time))
