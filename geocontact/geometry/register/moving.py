"""Poses of a segment between the recorded times."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Slerp


def poses_at(time: Float[np.ndarray, " t"], poses: RigidTransform, at: Float[np.ndarray, " s"]) -> RigidTransform:
    """Poses X_GB at other times within those recorded [s].

    Rotations turn at constant rate about one axis between neighbours (slerp: Shoemake 1985), the origin of B goes
    straight: exact at the recorded times, the error of second order in the time step between them.
    """
    if len(time) < 2:
        raise ValueError("one pose is no motion")
    if len(at) and (at.min() < time[0] or at.max() > time[-1]):
        raise ValueError(f"poses are known from {time[0]:g} to {time[-1]:g} s only")
    origin = np.column_stack([np.interp(at, time, poses.translation[:, k]) for k in range(3)])
    return RigidTransform.from_components(origin, Slerp(time, poses.rotation)(at))
