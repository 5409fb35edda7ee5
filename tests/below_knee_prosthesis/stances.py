"""Stances made up without a simulation: any force over time, on a foot that stands flat."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.below_knee_prosthesis.keel.vsf import vsf_foot
from geocontact.below_knee_prosthesis.leg_tree import LegMotion
from geocontact.below_knee_prosthesis.simulate import Push, Stance
from geocontact.contact.bushing import SOCKET
from geocontact.dynamics.simulate import SimulatedMotion
from geocontact.loads.sphere_set import SphereLoads
from tests.below_knee_prosthesis.model.legs import a_leg, a_motion

FULCRUM = 0.1174
NAMES = ("pelvis_x", "pelvis_y", *(f"socket_{k}" for k in range(6)), *(f"keel_{k}" for k in range(1, 9)))


def a_stance(
    time: Float[np.ndarray, " t"],
    force: Float[np.ndarray, "t 3"] | None = None,
    *,
    motion: LegMotion | None = None,
) -> Stance:
    """With that force [N] on the middle of the sole; socket and keel do not give."""
    count, spheres = len(time), len(vsf_foot().sole.spheres)
    total = np.zeros((count, 3)) if force is None else force
    each = np.repeat(total[:, None] / spheres, spheres, axis=1)
    point = np.zeros((count, spheres, 3)) + np.array([0.1, 0.0, 0.0])
    normal = np.zeros((count, spheres, 3)) + np.array([0.0, 1.0, 0.0])
    loads = SphereLoads(each[:, :, 1], each, point, point, normal, np.zeros((count, spheres)))
    none = np.zeros((count, len(NAMES)))
    found = SimulatedMotion(
        time, NAMES, none, none, np.zeros((count, 0)), time[1:], 0, np.zeros(len(NAMES)), np.zeros((count, 0, 0))
    )
    still = RigidTransform.from_components(np.zeros((count, 3)), Rotation.identity(count))
    motion = a_motion(a_leg()) if motion is None else motion
    push = Push(time, np.zeros((count, 3)))
    return Stance(motion, vsf_foot(), FULCRUM, SOCKET, push, time, found, still, loads, np.zeros((count, 6)))
