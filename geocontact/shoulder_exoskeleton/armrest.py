"""What a pressure mat under the arm shows of a simulated point in its cuff: the lower half of the ring of springs."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.shoulder_exoskeleton.simulate import ArmSimulation

PLACES = 180
"""Of springs around the cuff."""


def armrest_force(s: ArmSimulation, pressed: Float[np.ndarray, " t"] | None = None) -> Float[np.ndarray, " t"]:
    """Force with which the armrest alone presses the arm up [N], without friction and damping.

    Above it a strap presses down (`contact.sphere_in_tube`): that part of the force on the arm no mat below sees.

    Parameters
    ----------
    pressed
        As the simulation was given it [N].
    """
    k, strap = s.device["k"], s.device["strap"]
    radial = s.told["place"][:, 1:].copy()
    if pressed is not None:
        radial[:, 1] -= pressed / k
    angle = -np.pi * (np.arange(PLACES // 2) + 0.5) / (PLACES // 2)  # from medial downwards
    depth = radial @ np.array([np.cos(angle), np.sin(angle)]) + strap
    each = 2.0 * k / np.pi * np.maximum(depth, 0.0) * -np.sin(angle)
    return np.asarray(each.sum(axis=1) * 2.0 * np.pi / PLACES)
