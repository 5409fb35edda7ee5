"""Many forces at points as one force and one moment."""

from __future__ import annotations

import numpy as np
from jaxtyping import Float

from geocontact.data.wrench import Wrench


def resultant(
    force: Float[np.ndarray, "*t n 3"],
    point: Float[np.ndarray, "*t n 3"],
    frame: str,
    origin: Float[np.ndarray, " 3"] | None = None,
) -> Wrench:
    """Sum of the forces [N] that act at `point` [m], about `origin` (that of the frame without).

    A point at which no force acts may be NaN.
    """
    about = np.zeros(3) if origin is None else origin
    acts = (force != 0.0).any(axis=-1, keepdims=True)
    arm = np.where(acts, point - about, 0.0)
    total = force.sum(axis=-2)
    return Wrench(total, np.cross(arm, force).sum(axis=-2), np.broadcast_to(about, total.shape), frame)
