"""Loads of a mat in the frame that its segment moves in."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform

from geocontact.data.wrench import Wrench
from geocontact.loads.mat.load import MatLoad


def load_in(load: MatLoad, X_GB: RigidTransform, point: Float[np.ndarray, " 3"], frame: str) -> MatLoad:
    """The load of a segment B in the frame G that B has the poses X_GB in, one for each frame of the mat.

    F_G = R F, M_G = R M + (X o - point) x F_G, with o the origin of the moment in B. The centre goes with the segment.
    What has no direction stays, and so does `normal`, which is one vector of the segment.

    Parameters
    ----------
    point
        Of G, that the moment refers to [m].
    frame
        Name of G.
    """
    wrench = load.wrench
    turn = X_GB.rotation
    force = turn.apply(wrench.force)
    there = X_GB.apply(wrench.origin)
    moment = turn.apply(wrench.moment) + np.cross(there - point, force)
    origin = np.broadcast_to(np.asarray(point, float), force.shape)
    return replace(load, wrench=Wrench(force, moment, origin, frame), centre=X_GB.apply(load.centre))


def covariance_in(
    covariance: Float[np.ndarray, "t six six"],
    origin: Float[np.ndarray, " 3"],
    X_GB: RigidTransform,
    point: Float[np.ndarray, " 3"],
) -> Float[np.ndarray, "t six six"]:
    """Covariance of force and moment about `origin` of B [m] as one about `point` of G: T C T^t, the poses exact."""
    turn = X_GB.rotation.as_matrix()
    arm = X_GB.apply(origin) - point
    x, y, z = arm.T
    nothing = np.zeros_like(x)
    crossing = np.stack([nothing, -z, y, z, nothing, -x, -y, x, nothing], axis=1).reshape(-1, 3, 3)
    change = np.zeros((len(turn), 6, 6))
    change[:, :3, :3] = change[:, 3:, 3:] = turn
    change[:, 3:, :3] = crossing @ turn
    return np.asarray(change @ covariance @ change.transpose(0, 2, 1))
