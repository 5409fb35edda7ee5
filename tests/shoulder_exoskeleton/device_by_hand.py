"""Weight and inertia of Lucy's arm from its angles, by hand: masses and links written down, momenta differenced."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from geocontact.shoulder_exoskeleton.simulate import ArmSimulation

AXES = np.array([[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]])
LINKS = np.array([[-0.07, -0.02, 0.0], [0.0, -0.10, 0.04]])
MASSES = np.array([0.20, 0.30, 0.60, 0.20])
"""Two slender links, the arm link, the cylinder as a point: Lucy's numbers."""
CENTRES = np.array([*(0.5 * LINKS), [0.0, 0.0, -0.11], [0.0, 0.0, -0.06]])
GYRATION, THIN = 0.08, 0.02


MIRRORED = np.array([-1.0, 1.0, 1.0])


def weight_and_inertia_by_hand(s: ArmSimulation) -> tuple[np.ndarray, np.ndarray]:
    """Force m (g - a) [N] and its moment about the first joint [N m]: by differences of momenta."""
    time, left = s.motion.time, s.motion.side == "left"
    linear, angular, weighed = _momenta(s)
    gravity = s.motion.gravity_at_frames() * (MIRRORED if left else 1.0)
    force = MASSES.sum() * gravity - np.gradient(linear, time, axis=0)
    moment = weighed - np.gradient(angular, time, axis=0)
    return (force * MIRRORED, -moment * MIRRORED) if left else (force, moment)


def _momenta(s: ArmSimulation) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Momentum, angular momentum about the first joint, moment of the weight about it: of a right arm's angles."""
    gravity = s.motion.gravity_at_frames() * (MIRRORED if s.motion.side == "left" else 1.0)
    step = s.motion.time[1] - s.motion.time[0]
    turn, place = Rotation.identity(len(s.angles)), np.zeros((len(s.angles), 3))
    linear, angular, weighed = np.zeros((3, len(s.angles), 3))
    bodies = [(0,), (1,), (2, 3)]
    for k, axis in enumerate(AXES):
        turn = turn * Rotation.from_rotvec(s.angles[:, k, None] * axis)
        m = turn.as_matrix()
        rate = np.gradient(m, step, axis=0, edge_order=2) @ m.swapaxes(1, 2)
        spin = np.column_stack([rate[:, 2, 1], rate[:, 0, 2], rate[:, 1, 0]])
        for part in bodies[k]:
            centre = place + turn.apply(CENTRES[part])
            push = MASSES[part] * np.gradient(centre, step, axis=0, edge_order=2)
            linear += push
            angular += np.cross(centre, push)
            weighed += np.cross(centre, MASSES[part] * gravity)
        own = np.zeros((3, 3))
        if k < 2:
            own = MASSES[k] / 12.0 * (LINKS[k] @ LINKS[k] * np.eye(3) - np.outer(LINKS[k], LINKS[k]))
            place = place + turn.apply(LINKS[k])
        else:
            own = MASSES[2] * np.diag([GYRATION**2, GYRATION**2, THIN**2])
        angular += np.einsum("tij,tj->ti", m @ own @ m.swapaxes(1, 2), spin)
    return linear, angular, weighed
