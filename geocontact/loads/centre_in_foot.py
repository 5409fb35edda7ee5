"""Where a force plate's centre of pressure lies under a foot, in the sagittal plane."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float


def centre_in_foot(
    centre: Float[np.ndarray, " t"],
    x: Float[np.ndarray, " t"],
    y: Float[np.ndarray, " t"],
    pitch: Float[np.ndarray, " t"],
) -> Float[np.ndarray, " t"]:
    """Place along the foot's x axis of a point of the ground [m].

    The foot's frame lies at (x, y) in the ground's frame and is turned by pitch, positive where the toe is up; a point
    (centre, 0) of level ground has (centre - x) cos(pitch) - y sin(pitch) there. It is what the foot on spheres
    predicts as px - radius sin(pitch) of a sphere that touches the ground (`systems.foot.spheres`).

    Parameters
    ----------
    centre
        Centre of pressure in the ground's frame [m]; NaN where there is none, and so is what comes out.
    x, y
        Origin of the foot's frame [m], y above the ground.
    pitch
        [rad].
    """
    return np.asarray((centre - x) * np.cos(pitch) - y * np.sin(pitch))
