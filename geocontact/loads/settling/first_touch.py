"""Where a component that comes down on another one begins to press."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float
from scipy.spatial.transform import RigidTransform, Rotation

from geocontact.geometry.separation import settle
from geocontact.geometry.surface import Surface
from geocontact.loads.settling.coordinates import AXIAL, placed_at
from geocontact.loads.settling.potential import Bed

DOWN = (0.0, -1.0, 0.0)
STEP = 0.02e-3
"""m; how far it is pushed on at a time after the first touch."""
FARTHEST = 3e-3
"""m; beyond this it is not the layer that is touched."""


def pressing(bed: Bed, values: Float[np.ndarray, " 6"], fixed: Surface) -> Float[np.ndarray, " 6"] | None:
    """`values` with the axial one at which the layer begins to be pressed; None where the bodies miss each other."""
    at = placed_at(values, bed.point)
    pose = RigidTransform.from_components(at.translation, Rotation.from_matrix(at.rotation))
    try:
        touching = settle(bed.moving, fixed, pose, DOWN)
    except ValueError:
        return None
    lowered = values.copy()
    lowered[AXIAL] += float(touching.translation[1] - at.translation[1])
    for _ in range(round(FARTHEST / STEP)):
        lowered[AXIAL] -= STEP
        if bed.state(placed_at(lowered, bed.point)).energy > 0.0:
            return lowered
    return None
